// The time line: lanes for the states of each component, the verdicts of each command, and refused commands; the list of
// events; plots of numbers and times.

import type { Description, Moment, Value } from "./data";
import { byId, html } from "./elements";
import { type Run, verdictOf, type Whole } from "./run";

/** Number of drawn moments: those up to the shown one and some after it. */
const WINDOW = 400;
const LANE = 16;
const NAMES = 150;
/** Number of listed events on each side of the shown one. */
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
      for (const { key, numeric } of automaton.variables) {
        const known = ({ state }: Whole): string => String(state.get(key) ?? "unknown");
        if (numeric === true) numbers.append(this.plot(key, key, ({ state }) => number(state.get(key)), known));
        else numbers.append(this.plot(key, key, known, known));
      }
    for (const [name, event] of Object.entries(description.events))
      if (event.timer === true)
        numbers.append(
          this.plot(name, event.words, ({ timers }) => timers.get(name) ?? NaN, ({ timers }) => {
            const left = timers.get(name);
            return left === undefined ? "not running" : `${left / 1000} s left`;
          }),
        );
    byId("numbers-section", HTMLElement).hidden = this.plots.length === 0;
  }

  private plot(key: string, title: string, value: Plot["value"], said: Plot["said"]): HTMLElement {
    const [canvas, now, range] = [html("canvas", { "aria-hidden": "true" }), html("strong"), html("span", { class: "range" })];
    this.plots.push({ value, said, canvas, now, range });
    return html("li", { "data-key": key }, html("span", {}, title, ": ", now, " ", range), canvas);
  }

  /** Chooses the moment under the pointer, among the moments drawn when the pointer was pressed. */
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
      const violates = number === this.description.violation;
      const text = violates ? `${told(moment)}: violates the property` : told(moment);
      const button = html("button", { type: "button", class: "link", onclick: () => this.choose(number) }, text);
      if (number === shown) button.setAttribute("aria-current", "true");
      items.push(html("li", { value: number, class: moment.by === undefined && !violates ? "" : "refused" }, button));
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
    const columns: { states: string[]; values: (number | string)[]; refused: boolean }[] = [];
    for (let number = first; number <= last; number++) {
      const whole = this.run.at(number);
      columns.push({
        states: [
          ...automata.map((automaton) => String(whole.state.get(automaton.key) ?? "")),
          ...commands.map((command) => verdictOf(whole.commands.get(command) ?? null)),
        ],
        values: this.plots.map((plot) => plot.value(whole)),
        refused: this.run.moment(number).by !== undefined,
      });
    }
    const colours = getComputedStyle(document.documentElement);
    const colour = (name: string): string => colours.getPropertyValue(name);
    const lanes = [
      ...automata.map((automaton) => ({
        name: automaton.name,
        colour: (state: string) => `--lane-${Math.max(0, automaton.states.findIndex(({ name }) => name === state)) % 6}`,
      })),
      ...commands.map((command) => ({ name: events[command]!.words, colour: (verdict: string) => `--${VERDICTS[verdict]}` })),
    ];
    const context = prepared(this.canvas, (lanes.length + 1) * LANE + 4);
    const step = (this.canvas.clientWidth - NAMES) / columns.length;
    lanes.forEach(({ name, colour: of }, lane) => {
      const top = lane * LANE + 2;
      context.fillStyle = colour("--text");
      context.fillText(name, 2, top + 11, NAMES - 8);
      const isVerdict = lane >= automata.length;
      const states = columns.map((column) => column.states[lane]!);
      drawLane(context, states, (state) => colour(of(state)), { left: NAMES, top, step, text: isVerdict ? null : colour("--on-lane") });
    });
    const bottom = lanes.length * LANE + 2;
    context.fillStyle = colour("--text");
    context.fillText(this.description.violation === null ? "refused" : "refused, violated", 2, bottom + 11, NAMES - 8);
    context.fillStyle = colour("--forbidden");
    columns.forEach((column, index) => {
      if (column.refused) context.fillRect(NAMES + index * step, bottom, Math.max(2, step - 1), LANE - 3);
    });
    const { violation } = this.description;
    if (violation !== null && first <= violation && violation <= last) {
      context.fillStyle = colour("--forbidden");
      context.fillRect(NAMES + (violation - first) * step, bottom, Math.max(2, step - 1), LANE - 3);
    }
    context.fillStyle = colour("--shown");
    context.fillRect(NAMES + (shown - first + 0.5) * step - 1, 0, 2, bottom + LANE);
    const now = this.run.at(shown);
    this.plots.forEach((plot, index) => {
      const values = columns.map((column) => column.values[index]!);
      plot.now.textContent = plot.said(now);
      const numbers = values.filter((value) => typeof value === "number");
      if (numbers.length === values.length) {
        plot.range.textContent = drawPlot(plot.canvas, numbers, shown - first, colour("--accent"), colour("--shown"));
        return;
      }
      const lane = prepared(plot.canvas, LANE + 2);
      const width = plot.canvas.clientWidth / values.length;
      const texts = values.map(String);
      drawLane(lane, texts, (text) => colour(`--lane-${hash(text) % 6}`), { left: 0, top: 2, step: width, text: colour("--on-lane") });
      lane.fillStyle = colour("--shown");
      lane.fillRect((shown - first + 0.5) * width - 1, 0, 2, LANE + 2);
    });
  }
}

interface Plot {
  /** A number (NaN if there is none), or the text of another value. */
  value: (whole: Whole) => number | string;
  said: (whole: Whole) => string;
  canvas: HTMLCanvasElement;
  now: HTMLElement;
  range: HTMLElement;
}

function number(value: Value | undefined): number {
  return typeof value === "number" ? value : NaN;
}

/** Hash of a text. */
function hash(text: string): number {
  let found = 0;
  for (const letter of text) found = (31 * found + letter.codePointAt(0)!) >>> 0;
  return found;
}

/** Cached widths of texts, because every frame draws the same ones. */
const widths = new Map<string, number>();
const MOST_WIDTHS = 5000;

function widthOf(context: CanvasRenderingContext2D, text: string): number {
  let width = widths.get(text);
  if (width === undefined) {
    if (widths.size === MOST_WIDTHS) widths.clear();
    widths.set(text, (width = context.measureText(text).width));
  }
  return width;
}

/** A text, shortened to a width. */
function shortened(context: CanvasRenderingContext2D, text: string, width: number): string {
  if (widthOf(context, text) <= width) return text;
  let length = Math.min(text.length, Math.floor(width / 4));
  while (length > 0 && widthOf(context, `${text.slice(0, length)}…`) > width) length--;
  return length === 0 ? "" : `${text.slice(0, length)}…`;
}

/** Draws texts over time, equal neighbors as one. `text`: the color of the lettering, or null for bars without text. */
function drawLane(
  context: CanvasRenderingContext2D,
  texts: string[],
  colour: (text: string) => string,
  { left, top, step, text }: { left: number; top: number; step: number; text: string | null },
): void {
  for (let begin = 0; begin < texts.length; ) {
    const here = texts[begin]!;
    let end = begin + 1;
    while (end < texts.length && texts[end] === here) end++;
    context.fillStyle = colour(here);
    const inset = text === null ? (INSETS[here] ?? 3) : 0;
    context.fillRect(left + begin * step, top + inset, (end - begin) * step - (step > 3 ? 1 : 0), LANE - 3 - 2 * inset);
    if (text !== null && (end - begin) * step > 24) {
      context.fillStyle = text;
      context.fillText(shortened(context, here, (end - begin) * step - 6), left + begin * step + 4, top + 10);
    }
    begin = end;
  }
}

/** The color of each verdict on a command. */
const VERDICTS: Record<string, string> = { allowed: "allowed-lane", forbidden: "forbidden-lane", unready: "unready-lane" };

/** The height of the bar of a verdict is a second sign beside its color: the space above and below it. */
const INSETS: Record<string, number> = { allowed: 0, unready: 4, forbidden: 5 };

/** Draws numbers as steps and returns their range as a text. */
function drawPlot(canvas: HTMLCanvasElement, values: number[], shown: number, line: string, here: string): string {
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
  return least < most ? `(${least} to ${most})` : "";
}

function prepared(canvas: HTMLCanvasElement, height: number): CanvasRenderingContext2D {
  const scale = window.devicePixelRatio;
  canvas.style.height = `${height}px`;
  canvas.width = canvas.clientWidth * scale;
  canvas.height = height * scale;
  const context = canvas.getContext("2d")!;
  context.scale(scale, scale);
  context.font = "11px system-ui, sans-serif";
  context.clearRect(0, 0, canvas.clientWidth, height);
  return context;
}

function told(moment: Moment): string {
  if (moment.event === undefined) return moment.words ?? "start";
  const data = moment.data === undefined || Object.keys(moment.data).length === 0 ? "" : ` ${JSON.stringify(moment.data)}`;
  return `${moment.words ?? moment.event}${data}${moment.reason === undefined ? "" : `: ${moment.reason}`}`;
}
