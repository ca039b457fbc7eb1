// The time line: a lane for each component with its states, for each command with its verdicts, and for what was refused;
// what happened; numbers and times over time.

import type { Description, Moment } from "./data";
import { byId, html } from "./elements";
import { type Run, verdictOf, type Whole } from "./run";

/** So many moments are drawn, those up to the shown one and some after it. */
const WINDOW = 400;
const LANE = 16;
const NAMES = 150;
/** So many events are listed on each side of the shown one. */
const AROUND = 8;

export class TimelineView {
  private readonly slider = byId("moment", HTMLInputElement);
  private readonly number = byId("moment-number", HTMLOutputElement);
  private readonly canvas = byId("lanes", HTMLCanvasElement);
  private dragged: [number, number] = [0, 0];
  private readonly list = byId("happened", HTMLOListElement);
  private readonly plots: Plot[] = [];

  constructor(
    private readonly description: Description,
    private readonly run: Run,
    private readonly choose: (number: number) => void,
  ) {
    this.slider.addEventListener("input", () => choose(Number(this.slider.value)));
    this.canvas.addEventListener("pointerdown", (event) => {
      this.dragged = this.window(Number(this.slider.value));
      if (event.offsetX < NAMES) return;
      this.canvas.setPointerCapture(event.pointerId);
      this.drag(event);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (this.canvas.hasPointerCapture(event.pointerId)) this.drag(event);
    });
    const numbers = byId("numbers", HTMLUListElement);
    for (const automaton of description.automata)
      for (const variable of automaton.variables.filter((one) => one.numeric))
        numbers.append(this.plot(variable.key, variable.key, ({ state }) => Number(state.get(variable.key)), String));
    for (const [name, event] of Object.entries(description.events))
      if (event.timer === true)
        numbers.append(
          this.plot(name, event.words, ({ timers }) => timers.get(name) ?? NaN, (left) =>
            Number.isNaN(left) ? "not running" : `${left / 1000} s left`,
          ),
        );
    byId("numbers-section", HTMLElement).hidden = this.plots.length === 0;
  }

  private plot(key: string, title: string, value: (whole: Whole) => number, said: (value: number) => string): HTMLElement {
    const [canvas, now] = [html("canvas", { "aria-hidden": "true" }), html("strong")];
    this.plots.push({ value, said, canvas, now });
    return html("li", { "data-key": key }, html("span", {}, title, ": ", now), canvas);
  }

  /** Chooses the moment under the pointer; what is drawn is still that of when it was pressed. */
  private drag(event: PointerEvent): void {
    const [first, last] = this.dragged;
    const along = (event.offsetX - NAMES) / (this.canvas.clientWidth - NAMES);
    this.choose(Math.min(last, Math.max(first, first + Math.floor(along * (last - first + 1)))));
  }

  show(shown: number): void {
    const last = this.run.end;
    this.slider.min = String(this.run.first);
    this.slider.max = String(last);
    this.slider.value = String(shown);
    const moment = this.run.moment(shown);
    const said = `${shown} of ${last}, at ${moment.time} s`;
    this.number.textContent = said;
    this.slider.setAttribute("aria-valuetext", `${said}: ${told(moment)}`);
    this.listAround(shown, last);
    this.draw(shown);
  }

  private listAround(shown: number, last: number): void {
    const first = Math.max(this.run.first, Math.min(shown - AROUND, last - 2 * AROUND));
    const items = [];
    for (let number = first; number <= Math.min(last, first + 2 * AROUND); number++) {
      const moment = this.run.moment(number);
      const button = html("button", { type: "button", class: "link", onclick: () => this.choose(number) }, told(moment));
      if (number === shown) button.setAttribute("aria-current", "true");
      items.push(html("li", { value: number, class: moment.by === undefined ? "" : "refused" }, button));
    }
    this.list.replaceChildren(...items);
    const here = items[shown - first];
    if (here !== undefined) this.list.scrollTop = here.offsetTop - this.list.offsetTop - this.list.clientHeight / 2;
  }

  private window(shown: number): [number, number] {
    const last = this.run.end;
    const first = Math.max(this.run.first, Math.min(shown - WINDOW / 2, last - WINDOW + 1));
    return [first, Math.min(last, first + WINDOW - 1)];
  }

  private draw(shown: number): void {
    const [first, last] = this.window(shown);
    const { automata, commands, events } = this.description;
    const columns: { states: string[]; numbers: number[]; refused: boolean }[] = [];
    for (let number = first; number <= last; number++) {
      const whole = this.run.at(number);
      columns.push({
        states: [
          ...automata.map((automaton) => String(whole.state.get(automaton.key) ?? "")),
          ...commands.map((command) => verdictOf(whole.commands.get(command) ?? null)),
        ],
        numbers: this.plots.map((plot) => plot.value(whole)),
        refused: this.run.moment(number).by !== undefined,
      });
    }
    const colours = getComputedStyle(document.documentElement);
    const colour = (name: string): string => colours.getPropertyValue(name);
    const lanes = [
      ...automata.map((automaton) => ({
        name: automaton.name,
        colour: (state: string) => `--lane-${Math.max(0, automaton.states.findIndex((one) => one.name === state)) % 6}`,
      })),
      ...commands.map((command) => ({ name: events[command]!.words, colour: (verdict: string) => `--${VERDICTS[verdict]}` })),
    ];
    const context = prepared(this.canvas, (lanes.length + 1) * LANE + 4);
    const step = (this.canvas.clientWidth - NAMES) / columns.length;
    context.font = "11px system-ui, sans-serif";
    lanes.forEach(({ name, colour: of }, lane) => {
      const top = lane * LANE + 2;
      context.fillStyle = colour("--text");
      context.fillText(name, 2, top + 11, NAMES - 8);
      for (let begin = 0; begin < columns.length; ) {
        const state = columns[begin]!.states[lane]!;
        let end = begin + 1;
        while (end < columns.length && columns[end]!.states[lane] === state) end++;
        context.fillStyle = colour(of(state));
        const inset = lane < automata.length ? 0 : 3;
        context.fillRect(NAMES + begin * step, top + inset, (end - begin) * step - (step > 3 ? 1 : 0), LANE - 3 - 2 * inset);
        if (inset === 0 && (end - begin) * step > 24) {
          context.fillStyle = colour("--on-lane");
          context.fillText(state, NAMES + begin * step + 4, top + 10, (end - begin) * step - 6);
        }
        begin = end;
      }
    });
    const bottom = lanes.length * LANE + 2;
    context.fillStyle = colour("--text");
    context.fillText("refused", 2, bottom + 11, NAMES - 8);
    context.fillStyle = colour("--forbidden");
    columns.forEach((column, index) => {
      if (column.refused) context.fillRect(NAMES + index * step, bottom, Math.max(2, step - 1), LANE - 3);
    });
    context.fillStyle = colour("--shown");
    context.fillRect(NAMES + (shown - first + 0.5) * step - 1, 0, 2, bottom + LANE);
    this.plots.forEach((plot, index) => {
      const values = columns.map((column) => column.numbers[index]!);
      plot.now.textContent = plot.said(values[shown - first]!);
      drawPlot(plot.canvas, values, shown - first, colour("--accent"), colour("--shown"));
    });
  }
}

interface Plot {
  /** NaN: there is none. */
  value: (whole: Whole) => number;
  said: (value: number) => string;
  canvas: HTMLCanvasElement;
  now: HTMLElement;
}

/** The colours of what becomes of a command. */
const VERDICTS: Record<string, string> = { allowed: "allowed-lane", forbidden: "forbidden-lane", unready: "unready-lane" };

function drawPlot(canvas: HTMLCanvasElement, values: number[], shown: number, line: string, here: string): void {
  const context = prepared(canvas, 40);
  const known = values.filter((value) => !Number.isNaN(value));
  const [least, most] = [Math.min(...known), Math.max(...known)];
  const step = canvas.clientWidth / values.length;
  const height = (value: number): number => 36 - (most === least ? 0.5 : (value - least) / (most - least)) * 32;
  context.strokeStyle = line;
  context.beginPath();
  values.forEach((value, index) => {
    if (Number.isNaN(value)) return;
    const begins = index === 0 || Number.isNaN(values[index - 1]);
    if (begins) context.moveTo(index * step, height(value));
    else context.lineTo(index * step, height(value));
    context.lineTo((index + 1) * step, height(value));
  });
  context.stroke();
  context.fillStyle = here;
  context.fillRect((shown + 0.5) * step - 1, 0, 2, 40);
}

function prepared(canvas: HTMLCanvasElement, height: number): CanvasRenderingContext2D {
  const scale = window.devicePixelRatio;
  canvas.style.height = `${height}px`;
  canvas.width = canvas.clientWidth * scale;
  canvas.height = height * scale;
  const context = canvas.getContext("2d")!;
  context.scale(scale, scale);
  context.clearRect(0, 0, canvas.clientWidth, height);
  return context;
}

function told(moment: Moment): string {
  if (moment.event === undefined) return moment.words ?? "start";
  const data = moment.data === undefined || Object.keys(moment.data).length === 0 ? "" : ` ${JSON.stringify(moment.data)}`;
  return `${moment.words ?? moment.event}${data}${moment.reason === undefined ? "" : `: ${moment.reason}`}`;
}
