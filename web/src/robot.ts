// The robot: a card for each automaton with its picture, the current state highlighted, the last transition traced.

import type { Automaton, Description, Endpoint, Moment, Place } from "./data";
import { byId, html, pressed, svg } from "./elements";
import { type Box, columns, type Drawing, layout, type Line, LINE, path } from "./layout";
import type { Whole } from "./run";
import { stands } from "./text";

/** Greatest number of lines on a transition. A transition with more shows their number. */
const MOST_LINES = 3;
const EVERYWHERE = "in every state";

interface Card {
  element: HTMLDetailsElement;
  texts: string;
}

interface Picture {
  automaton: Automaton;
  now: HTMLElement;
  variables: Map<string, HTMLElement>;
  states: SVGGElement[];
  /** The drawn element of each transition, by number. */
  transitions: Map<number, SVGGElement>;
  lit: number;
  traced: SVGGElement[];
}

export class RobotView {
  private cards: Card[] = [];
  private pictures: Picture[] = [];
  private ends = new Map<string, SVGGElement>();
  private lastEnds: SVGGElement[] = [];
  private zoom = 1;
  private readonly holder = byId("cards", HTMLElement);

  constructor(
    private readonly description: Description,
    private readonly goTo: (place: Place | null) => void,
  ) {
    byId("search", HTMLInputElement).addEventListener("input", (event) =>
      this.choose((event.target as HTMLInputElement).value),
    );
    byId("fold", HTMLButtonElement).addEventListener("click", () => this.fold());
    byId("zoom-in", HTMLButtonElement).addEventListener("click", () => this.scale(1.25));
    byId("zoom-out", HTMLButtonElement).addEventListener("click", () => this.scale(0.8));
  }

  /** Lays out and draws all cards; resolves when they are complete. */
  async draw(): Promise<void> {
    const jobs = this.description.automata.map((automaton) => this.card(automaton));
    if (this.description.communication.length > 0) this.graph(this.description.communication);
    await Promise.all(jobs);
  }

  show(whole: Whole, moment: Moment): void {
    for (const picture of this.pictures) {
      const { automaton } = picture;
      const state = whole.state.get(automaton.key);
      const lit = automaton.states.findIndex(({ name }) => name === state);
      if (lit !== picture.lit) {
        this.light(picture, picture.lit, false);
        this.light(picture, lit, true);
        picture.lit = lit;
        picture.now.textContent = String(state ?? "");
      }
      for (const [key, shown] of picture.variables) {
        const value = String(whole.state.get(key) ?? "unknown");
        if (shown.textContent !== value) shown.textContent = value;
      }
      for (const group of picture.traced) group.classList.remove("taken");
      picture.traced = [];
    }
    for (const [number, transition] of moment.transitions ?? []) {
      const group = this.pictures[number]?.transitions.get(transition);
      if (group === undefined) continue;
      group.classList.add("taken");
      this.pictures[number]!.traced.push(group);
    }
    for (const end of this.lastEnds) end.classList.remove("taken");
    const owner = moment.event === undefined ? undefined : this.description.events[moment.event]?.owner;
    const end = owner === undefined ? undefined : this.ends.get(owner);
    this.lastEnds = end === undefined ? [] : [end];
    end?.classList.add("taken");
  }

  private light(picture: Picture, number: number, on: boolean): void {
    const group = picture.states[number];
    if (group === undefined) return;
    group.classList.toggle("current", on);
    const name = picture.automaton.states[number]!.name;
    group.querySelector("[role]")?.setAttribute("aria-label", on ? `${name}, the present state` : name);
  }

  private async card(automaton: Automaton): Promise<void> {
    const now = html("span", { class: "now" });
    const variables = new Map<string, HTMLElement>();
    const values = html("dl", { class: "variables" });
    for (const variable of automaton.variables) {
      const shown = html("dd");
      variables.set(variable.key, shown);
      values.append(html("dt", {}, variable.name), shown);
    }
    const picture: Picture = {
      automaton,
      now,
      variables,
      states: [],
      transitions: new Map(),
      lit: -1,
      traced: [],
    };
    this.pictures.push(picture);
    const drawn = html("div", { class: "drawn" });
    const kind = automaton.kind === "requirement" ? html("span", { class: "kind" }, "requirement") : "";
    const element = html(
      "details",
      { class: "card", open: true },
      html("summary", {}, html("span", { class: "name" }, automaton.name), " ", kind, " ", now),
      ...(automaton.variables.length > 0 ? [values] : []),
      drawn,
    );
    const words = [automaton.name, ...automaton.states.map((state) => state.name), ...automaton.transitions.map((t) => t.whole)];
    this.cards.push({ element, texts: words.join("\n").toLowerCase() });
    this.holder.append(element);

    const { boxes, lines, rows } = contents(automaton);
    const drawing = await layout(boxes, lines);
    const image = canvas(drawing, `${automaton.name}: states and transitions`);
    for (const line of lines) {
      const group = this.line(drawing, line);
      for (const number of line.transitions) picture.transitions.set(number, group);
      const first = automaton.transitions[line.transitions[0]!]!;
      group.append(svg("title", {}, line.transitions.map((number) => automaton.transitions[number]!.whole).join("\n")));
      this.leads(group, line.texts.join(", "), first.place);
      image.append(group);
    }
    automaton.states.forEach((state, number) => {
      const box = drawing.boxes.get(String(number))!;
      const named = svg("g", { tabindex: 0, role: "button", "aria-label": state.name });
      const group = svg("g", { class: "state" }, svg("rect", { ...plain(box), rx: 9, class: "box" }), named);
      if (state.marked) {
        const [x, y] = [box.x + 3, box.y + 3];
        group.append(svg("rect", { x, y, width: box.width - 6, height: box.height - 6, rx: 6, class: "inner" }));
      }
      if (state.initial) {
        const y = box.y + box.height / 2;
        group.append(svg("path", { d: `M${box.x - 16} ${y}H${box.x - 2}`, class: "line", "marker-end": "url(#tip)" }));
      }
      named.append(svg("text", { x: box.x + 12, y: box.y + LINE + 2, class: "title" }, state.name));
      (rows.get(number) ?? []).forEach((row, index) => group.append(this.row(picture, row, box, index + 2)));
      pressed(named, () => this.goTo(state.place));
      group.addEventListener("click", () => this.goTo(state.place));
      picture.states.push(group);
      image.append(group);
    });
    const everywhere = drawing.boxes.get("every");
    if (everywhere !== undefined) {
      const group = svg("g", { class: "every" }, svg("rect", { ...plain(everywhere), rx: 2, class: "box" }));
      group.append(svg("text", { x: everywhere.x + 12, y: everywhere.y + LINE + 2, class: "row" }, EVERYWHERE));
      (rows.get(-1) ?? []).forEach((row, index) => group.append(this.row(picture, row, everywhere, index + 2)));
      image.prepend(group);
    }
    drawn.append(image);
    if (picture.lit >= 0) this.light(picture, picture.lit, true);
  }

  /** A transition without a change of state, as a line of text in a box. */
  private row(picture: Picture, row: Row, box: { x: number; y: number }, line: number): SVGGElement {
    const text = svg("text", { x: box.x + 12, y: box.y + line * LINE + 2, class: "row" }, row.text);
    const group = svg("g", { class: "transition" }, text);
    for (const number of row.transitions) picture.transitions.set(number, group);
    this.leads(group, row.text, picture.automaton.transitions[row.transitions[0]!]!.place);
    return group;
  }

  /** Links a drawn element to a place in the text. */
  private leads(element: SVGGElement, name: string, place: Place | null): void {
    for (const [attribute, value] of [["tabindex", "0"], ["role", "button"], ["aria-label", name]] as const)
      element.setAttribute(attribute, value);
    pressed(element, () => this.goTo(place));
  }

  private line(drawing: Drawing, line: Line): SVGGElement {
    const drawn = drawing.lines.get(line.id)!;
    const group = svg(
      "g",
      { class: "transition" },
      svg("path", { d: path(drawn.points), class: "line", "marker-end": "url(#tip)" }),
    );
    // A space separates the texts for screen readers and for comparisons of the name with the visible text.
    line.texts.forEach((text, index) =>
      group.append(svg("text", { x: drawn.label.x + 3, y: drawn.label.y + (index + 1) * LINE - 3, class: "label" }, text), " "),
    );
    return group;
  }

  private graph(ends: Endpoint[]): void {
    const drawn = html("div", { class: "drawn" });
    const element = html(
      "details",
      { class: "card graph", open: true },
      html("summary", {}, html("span", { class: "name" }, "Communication")),
      drawn,
    );
    this.cards.push({ element, texts: ends.map((end) => [end.name, ...end.types, ...end.uses].join(" ")).join("\n").toLowerCase() });
    this.holder.append(element);
    const controller: Box = { id: "controller", texts: [`${this.description.robot}: controller`] };
    const boxes: Box[] = ends.map((end, number) => ({ id: String(number), texts: [end.name, ...end.types] }));
    const isIn = (box: Box): boolean => ends[Number(box.id)]!.direction === "in";
    const drawing = columns(controller, boxes.filter(isIn), boxes.filter((box) => !isIn(box)));
    const image = canvas(drawing, "The controller, with its topics, services and actions");
    ends.forEach(({ direction }, number) => {
      const { points } = drawing.lines.get(String(number))!;
      const both = direction === "both" ? { "marker-start": "url(#tip)" } : {};
      const d = path(direction === "in" ? [...points].reverse() : points);
      image.append(svg("path", { d, class: "line", "marker-end": "url(#tip)", ...both }));
    });
    for (const box of [controller, ...boxes]) {
      const place = drawing.boxes.get(box.id)!;
      const end = ends[Number(box.id)];
      const group = svg("g", { class: `end ${end?.kind ?? "controller"}` }, svg("rect", { ...plain(place), rx: 4, class: "box" }));
      box.texts.forEach((text, index) =>
        group.append(
          svg("text", { x: place.x + 12, y: place.y + (index + 1) * LINE + 2, class: index ? "row" : "title" }, text),
        ),
      );
      for (const use of end?.uses ?? []) this.ends.set(use, group);
      image.append(group);
    }
    drawn.append(image);
  }

  /** Scrolls to the element in a line of the text and marks it: a state, a transition, or else a whole card. */
  find(file: number, line: number): void {
    for (const element of this.holder.querySelectorAll(".found")) element.classList.remove("found");
    let [found, length]: [Element | null, number] = [null, Infinity];
    const offer = (place: Place | null, element: Element | undefined): void => {
      if (place === null || element === undefined || !stands(place, file, line)) return;
      if (place.endLine - place.line < length) [found, length] = [element, place.endLine - place.line];
    };
    this.pictures.forEach(({ automaton, states, transitions }, number) => {
      for (const [transition, group] of transitions) offer(automaton.transitions[transition]!.place, group);
      automaton.states.forEach((state, at) => offer(state.place, states[at]));
      offer(automaton.place, this.cards[number]?.element);
    });
    const element = found as Element | null;
    if (element === null) return;
    const card = element.closest<HTMLDetailsElement>(".card")!;
    card.hidden = false;
    card.open = true;
    element.classList.add("found");
    (element === card ? card : element).scrollIntoView({ block: "nearest", inline: "nearest" });
  }

  private choose(text: string): void {
    for (const card of this.cards) card.element.hidden = !card.texts.includes(text.toLowerCase());
  }

  private fold(): void {
    const open = !this.cards.some((card) => card.element.open);
    for (const card of this.cards) card.element.open = open;
    byId("fold", HTMLButtonElement).textContent = open ? "Fold all" : "Unfold all";
  }

  /** Zooms around the center of the view. */
  private scale(factor: number): void {
    const { scrollTop, scrollLeft, clientHeight, clientWidth } = this.holder;
    this.zoom = Math.min(3, Math.max(0.3, this.zoom * factor));
    const before = this.holder.scrollHeight;
    for (const image of this.holder.querySelectorAll("svg")) {
      image.setAttribute("width", String(Number(image.dataset["width"]) * this.zoom));
      image.setAttribute("height", String(Number(image.dataset["height"]) * this.zoom));
    }
    const grown = this.holder.scrollHeight / before;
    this.holder.scrollTo(
      (scrollLeft + clientWidth / 2) * grown - clientWidth / 2,
      (scrollTop + clientHeight / 2) * grown - clientHeight / 2,
    );
  }
}

function plain(box: { x: number; y: number; width: number; height: number }): Record<string, number> {
  return { x: box.x, y: box.y, width: box.width, height: box.height };
}

function canvas(drawing: Drawing, label: string): SVGSVGElement {
  const { width, height } = drawing;
  const image = svg("svg", {
    viewBox: `0 0 ${width} ${height}`,
    width,
    height,
    "data-width": width,
    "data-height": height,
    role: "group",
    "aria-label": label,
  });
  const tip = svg("marker", {
    id: "tip",
    viewBox: "0 0 8 8",
    refX: 7,
    refY: 4,
    markerWidth: 7,
    markerHeight: 7,
    orient: "auto-start-reverse",
    markerUnits: "userSpaceOnUse",
  });
  tip.append(svg("path", { d: "M0 0L8 4L0 8z", class: "tip" }));
  image.append(svg("defs", {}, tip));
  return image;
}

interface Row {
  text: string;
  transitions: number[];
}

interface Joined extends Line {
  transitions: number[];
}

/** Boxes, lines and rows of an automaton. Self-loops are rows of their state; all transitions between two states share one line. */
function contents(automaton: Automaton): { boxes: Box[]; lines: Joined[]; rows: Map<number, Row[]> } {
  const rows = new Map<number, Row[]>();
  const between = new Map<string, Joined>();
  automaton.transitions.forEach((transition, number) => {
    const source = transition.source ?? -1;
    if (transition.target === null || transition.target === source) {
      const known = rows.get(source) ?? [];
      const same = known.find((row) => row.text === transition.label);
      if (same === undefined) known.push({ text: transition.label, transitions: [number] });
      else same.transitions.push(number);
      rows.set(source, known);
      return;
    }
    const [from, to] = [source < 0 ? "every" : String(source), String(transition.target)];
    const line: Joined = between.get(`${from}-${to}`) ?? {
      id: `line-${from}-${to}`,
      source: from,
      target: to,
      texts: [],
      transitions: [],
    };
    if (!line.texts.includes(transition.label)) line.texts.push(transition.label);
    line.transitions.push(number);
    between.set(`${from}-${to}`, line);
  });
  const boxes: Box[] = automaton.states.map((state, number) => ({
    id: String(number),
    texts: [state.name, ...(rows.get(number) ?? []).map((row) => row.text)],
  }));
  const lines = [...between.values()];
  for (const line of lines) {
    const more = line.texts.length - MOST_LINES;
    if (more > 0) line.texts.splice(MOST_LINES, more, `… ${more} more`);
  }
  if (rows.has(-1) || lines.some((line) => line.source === "every"))
    boxes.push({ id: "every", texts: [EVERYWHERE, ...(rows.get(-1) ?? []).map((row) => row.text)] });
  return { boxes, lines, rows };
}

