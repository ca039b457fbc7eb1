// The time line: a lane for each component with its states, what happened and what was refused; numbers over time.

import type { Description, Moment } from "./data";
import { byId, html } from "./elements";
import type { Run } from "./run";

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
  private readonly list = byId("happened", HTMLOListElement);
  private readonly plots: { key: string; canvas: HTMLCanvasElement; now: HTMLElement }[] = [];

  constructor(
    private readonly description: Description,
    private readonly run: Run,
    private readonly choose: (number: number) => void,
  ) {
    this.slider.addEventListener("input", () => choose(Number(this.slider.value)));
    this.canvas.addEventListener("click", (event) => {
      const [first, last] = this.window(Number(this.slider.value));
      const along = (event.offsetX - NAMES) / (this.canvas.clientWidth - NAMES);
      if (along >= 0) choose(Math.min(last, Math.max(first, first + Math.floor(along * (last - first + 1)))));
    });
    const numbers = byId("numbers", HTMLUListElement);
    for (const automaton of description.automata)
      for (const variable of automaton.variables.filter((one) => one.numeric)) {
        const [canvas, now] = [html("canvas", { "aria-hidden": "true" }), html("strong")];
        this.plots.push({ key: variable.key, canvas, now });
        numbers.append(html("li", {}, `${variable.key}: `, now, canvas));
      }
    byId("numbers-section", HTMLElement).hidden = this.plots.length === 0;
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
    const { automata } = this.description;
    const columns: { state: (string | undefined)[]; numbers: number[]; refused: boolean }[] = [];
    for (let number = first; number <= last; number++) {
      const { state } = this.run.at(number);
      columns.push({
        state: automata.map((automaton) => state.get(automaton.key) as string | undefined),
        numbers: this.plots.map((plot) => Number(state.get(plot.key))),
        refused: this.run.moment(number).by !== undefined,
      });
    }
    const colours = getComputedStyle(document.documentElement);
    const colour = (name: string): string => colours.getPropertyValue(name);
    const context = prepared(this.canvas, (automata.length + 1) * LANE + 4);
    const step = (this.canvas.clientWidth - NAMES) / columns.length;
    context.font = "11px sans-serif";
    automata.forEach((automaton, lane) => {
      const top = lane * LANE + 2;
      context.fillStyle = colour("--text");
      context.fillText(automaton.name, 2, top + 11, NAMES - 8);
      for (let begin = 0; begin < columns.length; ) {
        const state = columns[begin]!.state[lane];
        let end = begin + 1;
        while (end < columns.length && columns[end]!.state[lane] === state) end++;
        const number = automaton.states.findIndex((one) => one.name === state);
        context.fillStyle = colour(`--lane-${Math.max(0, number) % 6}`);
        context.fillRect(NAMES + begin * step, top, (end - begin) * step - (step > 3 ? 1 : 0), LANE - 3);
        if ((end - begin) * step > 24) {
          context.fillStyle = colour("--on-lane");
          context.fillText(state ?? "", NAMES + begin * step + 3, top + 10, (end - begin) * step - 6);
        }
        begin = end;
      }
    });
    const bottom = automata.length * LANE + 2;
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
      plot.now.textContent = String(values[shown - first]);
      drawPlot(plot.canvas, values, shown - first, colour("--accent"), colour("--shown"));
    });
  }
}

function drawPlot(canvas: HTMLCanvasElement, values: number[], shown: number, line: string, here: string): void {
  const context = prepared(canvas, 40);
  const [least, most] = [Math.min(...values), Math.max(...values)];
  const step = canvas.clientWidth / values.length;
  const height = (value: number): number => 36 - (most === least ? 0.5 : (value - least) / (most - least)) * 32;
  context.strokeStyle = line;
  context.beginPath();
  values.forEach((value, index) => {
    context.lineTo(index * step, height(value));
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
