// The page of `robosc view`: a robot and the moments of its run, from a server or from a file in the same folder.

import { CommandsView } from "./commands";
import type { Description, Explanation, Exported, Moment, Value } from "./data";
import { byId, html } from "./elements";
import { begin } from "./layout";
import { RobotView } from "./robot";
import { MOST, Run } from "./run";
import { stands, TextView } from "./text";
import { TimelineView } from "./timeline";

declare global {
  // The data that `robosc view --export` writes.
  var robosc: Exported | undefined;
}

const ALL_BUTTONS: [string, Record<string, unknown>][] = [
  ["Undo", { action: "undo" }],
  ["Redo", { action: "redo" }],
  ["Random", { action: "random", number: 1 }],
  ["20 random", { action: "random", number: 20 }],
  ["Wait 1 s", { action: "wait", seconds: 1 }],
  ["Start again", { action: "restart" }],
];

/** Milliseconds between drawings. More than 30 a second are unreadable and take time from a robot on the same machine. */
const DRAWING = 32;

/** The number of the shown robot on the server. */
const ROBOT = new URLSearchParams(location.search).get("robot") ?? "0";

function asked(what: string, given: Record<string, string> = {}): string {
  return `${what}?${new URLSearchParams({ robot: ROBOT, ...given })}`;
}

class Page {
  private readonly run: Run;
  private readonly robot: RobotView;
  private readonly text: TextView;
  private readonly commands: CommandsView;
  private readonly timeline: TimelineView;
  private readonly status = byId("status", HTMLElement);
  private readonly follow = byId("follow", HTMLButtonElement);
  private readonly onward = html("button", { type: "button", onclick: () => this.goOn() }, "Go on from here");
  private readonly acts: boolean;
  private shown = 0;
  private following = true;
  private ofSource = "";
  private drawing = false;
  private drawn = -Infinity;

  constructor(
    private readonly description: Description,
    isServed: boolean,
  ) {
    this.acts = isServed && description.acts === true;
    this.run = new Run(isServed && !this.acts ? MOST : Infinity);
    document.title = `${description.robot} – RoboSC`;
    byId("robot-name", HTMLElement).textContent = description.robot;
    const source = byId("source", HTMLElement);
    source.textContent = description.source;
    source.classList.toggle("fault", description.violation !== null);
    this.offer(description.robots ?? []);
    this.text = new TextView(description, (file, line) => this.find(file, line));
    this.robot = new RobotView(description, (place) => this.text.goTo(place));
    const perform = (event: string, inputs: Record<string, Value>, kept: [string[], Value][]): void =>
      void this.act({ action: "perform", event, inputs, kept });
    const asking = isServed ? { perform: this.acts ? perform : null, explain: (event: string) => this.explain(event) } : null;
    this.commands = new CommandsView(description, (place) => this.text.goTo(place), asking);
    this.timeline = new TimelineView(description, this.run, (number) => this.choose(number));
    this.follow.addEventListener("click", () => this.choose(this.run.end));
    if (this.acts) {
      const controls = byId("controls", HTMLElement);
      for (const [name, action] of ALL_BUTTONS)
        controls.append(html("button", { type: "button", onclick: () => void this.act(action) }, name));
      controls.append(this.onward);
    }
    window.addEventListener("resize", () => this.schedule());
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.schedule());
  }

  /** Shows a choice of the robots, if there are several. */
  private offer(robots: string[]): void {
    const choice = byId("robots-choice", HTMLSelectElement);
    choice.append(...robots.map((name, number) => html("option", { value: number, selected: String(number) === ROBOT }, name)));
    choice.addEventListener("change", () => location.assign(`?${new URLSearchParams({ robot: choice.value })}`));
    byId("robots", HTMLElement).hidden = robots.length < 2;
  }

  async draw(): Promise<void> {
    await this.robot.draw();
    document.body.dataset["drawn"] = "true";
    this.schedule();
  }

  /** Replaces the moments from a number on. */
  tell(from: number, moments: Moment[]): void {
    this.run.replace(from, moments);
    const { first, end } = this.run;
    if (this.following || this.shown > end) this.shown = Math.max(0, end);
    this.shown = Math.max(first, this.shown);
    this.schedule();
  }

  isConnected(): void {
    this.say(this.ofSource);
  }

  /** Shows a changed status of the source of the moments. */
  saysOfSource(status: string): void {
    if (status === this.ofSource) return;
    this.ofSource = status;
    this.say(status);
  }

  say(text: string, isFault = false): void {
    this.status.textContent = text;
    this.status.classList.toggle("fault", isFault);
  }

  private choose(number: number): void {
    this.shown = number;
    this.drawn = -Infinity;
    this.following = number === this.run.end;
    this.schedule();
  }

  /** Draws in the next frame: new moments at most 30 times a second, a choice of the user always. */
  private schedule(): void {
    if (this.drawing) return;
    this.drawing = true;
    requestAnimationFrame((now) => this.frame(now));
  }

  private frame(now: number): void {
    if (now < this.drawn + DRAWING) {
      requestAnimationFrame((later) => this.frame(later));
      return;
    }
    this.drawing = false;
    this.drawn = now;
    if (this.run.end >= this.run.first) this.show(this.run.moment(this.shown));
  }

  private show(moment: Moment): void {
    const isLast = this.shown === this.run.end;
    this.timeline.show(this.shown);
    const whole = this.run.at(this.shown);
    this.robot.show(whole, moment);
    this.commands.show(whole, isLast && this.acts);
    const taken = (moment.transitions ?? []).map(
      ([automaton, number]) => this.description.automata[automaton]?.transitions[number]?.place ?? null,
    );
    this.text.happened(taken);
    this.follow.setAttribute("aria-pressed", String(this.following));
    this.onward.disabled = isLast;
    document.body.dataset["moment"] = String(this.shown);
  }

  /** Shows the element in a line of the text: the command of a requirement, else a state, a transition or a component. */
  private find(file: number, line: number): void {
    const requirement = this.description.requirements.find(({ place }) => place !== null && stands(place, file, line));
    if (requirement === undefined) this.robot.find(file, line);
    else this.commands.find(requirement.event);
  }

  private goOn(): void {
    void this.act({ action: "continue", moment: this.shown });
  }

  private async act(action: Record<string, unknown>): Promise<void> {
    try {
      const answer = await fetch(asked("do"), {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(action),
      });
      this.following = true;
      this.say(answer.ok ? "" : await answer.text(), !answer.ok);
    } catch {
      this.say("The server does not answer.", true);
    }
  }

  private async explain(event: string): Promise<Explanation> {
    const answer = await fetch(asked("explain", { moment: String(this.shown), event }));
    if (!answer.ok) throw new Error(await answer.text());
    return (await answer.json()) as Explanation;
  }
}

async function start(): Promise<void> {
  begin();
  if (globalThis.robosc !== undefined) {
    const page = new Page(globalThis.robosc.description, false);
    page.tell(0, globalThis.robosc.moments);
    await page.draw();
    return;
  }
  const answer = await fetch(asked("description"));
  const page = new Page((await answer.json()) as Description, true);
  let source: EventSource | null = null;
  // A hidden page closes its stream, because a browser opens at most six connections to one server for all pages.
  const listen = (): void => {
    if (document.hidden) {
      source?.close();
      source = null;
    } else {
      source ??= moments(page);
    }
  };
  document.addEventListener("visibilitychange", listen);
  listen();
  await page.draw();
}

/** Shows the moments from the server, from the first that it stores. */
function moments(page: Page): EventSource {
  const source = new EventSource(asked("moments"));
  source.addEventListener("message", (event) => {
    const told = JSON.parse(event.data as string) as { from: number; moments: Moment[]; status: string };
    page.tell(told.from, told.moments);
    page.saysOfSource(told.status);
  });
  source.addEventListener("error", () => page.say("The server does not answer; the page waits for it.", true));
  source.addEventListener("open", () => page.isConnected());
  return source;
}

void start();
