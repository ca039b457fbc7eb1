// The text of the model: coloured, with places in it that other panels point to, and that point back.

import type { Description, Place } from "./data";
import { byId, html } from "./elements";

export class TextView {
  private readonly lines = byId("lines", HTMLElement);
  private readonly chosen = byId("file", HTMLSelectElement);
  private shown = -1;
  private marked: Element[] = [];

  constructor(private readonly description: Description) {
    description.files.forEach((file, number) => this.chosen.append(html("option", { value: number }, file.name)));
    this.chosen.addEventListener("change", () => this.open(Number(this.chosen.value)));
    if (description.files.length > 0) this.open(0);
    else byId("text", HTMLElement).hidden = true;
  }

  /** Shows a place and marks its lines. */
  goTo(place: Place | null): void {
    if (place === null) return;
    this.open(place.file);
    for (const line of this.marked) line.classList.remove("here");
    const last = Math.min(place.endLine, place.line + 30);
    this.marked = [...this.lines.children].slice(place.line - 1, last);
    for (const line of this.marked) line.classList.add("here");
    const first = this.marked[0] as HTMLElement | undefined;
    if (first !== undefined) this.lines.scrollTop = first.offsetTop - this.lines.offsetTop - this.lines.clientHeight / 3;
  }

  /** Marks the lines of what has just happened. */
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
    const lines = this.description.files[file]!.lines.map((line) =>
      html("div", { class: "line" }, ...line.map(([kind, text]) => (kind === "" ? text : html("span", { class: kind }, text)))),
    );
    this.lines.replaceChildren(...lines);
  }
}
