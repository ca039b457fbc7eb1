// The text of the model with syntax colors. Places in it and elements of other panels link to each other.

import type { Description, Place } from "./data";
import { byId, html } from "./elements";

/** Whether a place contains a line. */
export function stands(place: Place, file: number, line: number): boolean {
  return place.file === file && place.line <= line && line <= place.endLine;
}

export class TextView {
  private readonly lines = byId("lines", HTMLElement);
  private readonly chosen = byId("file", HTMLSelectElement);
  private shown = -1;
  private marked: Element[] = [];
  /** The line that the arrow keys selected, counted from 1. */
  private line = 1;

  /** `show`: shows the element in a line of a file. */
  constructor(
    private readonly description: Description,
    private readonly show: (file: number, line: number) => void,
  ) {
    description.files.forEach((file, number) => this.chosen.append(html("option", { value: number }, file.name)));
    this.chosen.addEventListener("change", () => this.open(Number(this.chosen.value)));
    this.lines.addEventListener("click", (event) => {
      const at = [...this.lines.children].indexOf((event.target as Element).closest(".line")!);
      if (at >= 0) this.choose(at + 1);
    });
    this.lines.addEventListener("keydown", (event) => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (step !== undefined) {
        this.line = Math.min(this.lines.children.length, Math.max(1, this.line + step));
        this.mark(this.line, this.line);
      } else if (event.key === "Enter") this.choose(this.line);
      else return;
      event.preventDefault();
    });
    if (description.files.length > 0) this.open(0);
    else byId("text", HTMLElement).hidden = true;
  }

  /** Shows a place and marks its lines. */
  goTo(place: Place | null): void {
    if (place === null) return;
    this.open(place.file);
    this.line = place.line;
    this.mark(place.line, Math.min(place.endLine, place.line + 30));
  }

  private choose(line: number): void {
    this.line = line;
    this.mark(line, line);
    this.show(this.shown, line);
  }

  private mark(from: number, to: number): void {
    for (const line of this.marked) line.classList.remove("here");
    this.marked = [...this.lines.children].slice(from - 1, to);
    for (const line of this.marked) line.classList.add("here");
    const first = this.marked[0] as HTMLElement | undefined;
    if (first === undefined) return;
    const [top, height] = [first.offsetTop - this.lines.offsetTop, this.lines.clientHeight];
    const isSeen = top >= this.lines.scrollTop && top + first.clientHeight <= this.lines.scrollTop + height;
    if (!isSeen) this.lines.scrollTop = top - height / 3;
  }

  /** Marks the lines of the last event. */
  happened(places: (Place | null)[]): void {
    for (const line of this.lines.querySelectorAll(".last")) line.classList.remove("last");
    for (const place of places) {
      if (place === null || place.file !== this.shown) continue;
      for (let line = place.line; line <= place.endLine; line++) this.lines.children[line - 1]?.classList.add("last");
    }
  }

  private open(file: number): void {
    if (file === this.shown) return;
    this.shown = file;
    this.chosen.value = String(file);
    this.line = 1;
    const lines = this.description.files[file]!.lines.map((line) =>
      html("div", { class: "line" }, ...line.map(([kind, text]) => (kind === "" ? text : html("span", { class: kind }, text)))),
    );
    this.lines.replaceChildren(...lines);
  }
}
