// Commands with their verdicts, other enabled events, findings and requirements.

import type { Beside, Description, Event, Explanation, Input, Place, Value } from "./data";
import { byId, html, worded } from "./elements";
import { verdictOf, type Whole } from "./run";

/** Requests of the page to the server. `perform` is null if the server accepts no actions. */
export interface Asking {
  perform: ((event: string, inputs: Record<string, Value>, kept: [string[], Value][]) => void) | null;
  explain(event: string): Promise<Explanation>;
}

interface Shown {
  item: HTMLLIElement;
  verdict: HTMLElement;
  reason: HTMLElement;
  links: HTMLElement;
  why: HTMLElement;
  perform: HTMLButtonElement | null;
  told: string;
}

export class CommandsView {
  private commands = new Map<string, Shown>();
  private events = new Map<string, HTMLLIElement>();

  constructor(
    private readonly description: Description,
    private readonly goTo: (place: Place | null) => void,
    private readonly asking: Asking | null,
  ) {
    const list = byId("commands", HTMLUListElement);
    for (const name of description.commands) list.append(this.command(name));
    for (const kind of ["requirements", "properties"] as const) {
      const statements = byId(kind, HTMLUListElement);
      for (const { name, text, place } of description[kind]) {
        const title = name === "" ? "" : html("strong", {}, `${name} `);
        const link = html("button", { type: "button", class: "link", onclick: () => goTo(place) }, title, text);
        statements.append(html("li", {}, link));
      }
      byId(`${kind}-section`, HTMLElement).hidden = description[kind].length === 0;
    }
    const findings = byId("findings", HTMLUListElement);
    for (const finding of description.findings) {
      const link = html("button", { type: "button", class: "link", onclick: () => goTo(finding.place) }, ...worded(finding.message));
      findings.append(html("li", { class: finding.follows ? "follows" : "" }, link, html("p", { class: "reason" }, ...worded(finding.hint))));
    }
    byId("findings-section", HTMLElement).hidden = description.findings.length === 0;
    const events = byId("events", HTMLUListElement);
    for (const [name, event] of Object.entries(description.events)) {
      if (description.commands.includes(name)) continue;
      const item = html("li", {}, asking?.perform ? this.performer(name, event) : this.link(event));
      this.events.set(name, item);
      events.append(item);
    }
    byId("events-section", HTMLElement).hidden = asking === null;
  }

  /** `isLast`: whether this is the last moment, the only one in which events can be performed. */
  show(whole: Whole, isLast: boolean): void {
    for (const [name, shown] of this.commands) {
      const verdict = whole.commands.get(name) ?? null;
      const told = verdict === null ? "" : `${verdict.by} ${verdict.reason}`;
      if (shown.perform !== null) shown.perform.disabled = !isLast || verdict !== null;
      if (told === shown.told) continue;
      shown.told = told;
      shown.item.className = `${verdictOf(verdict)}${shown.item.classList.contains("found") ? " found" : ""}`;
      shown.verdict.textContent = { allowed: "allowed", forbidden: "forbidden", unready: "not possible" }[verdictOf(verdict)];
      shown.reason.textContent = verdict?.reason.replace(/^forbidden /, "") ?? "";
      shown.why.replaceChildren();
      shown.links.hidden = verdict === null;
    }
    for (const [name, item] of this.events) {
      item.hidden = !whole.enabled.has(name);
      for (const button of item.querySelectorAll<HTMLButtonElement>("button[data-event]")) button.disabled = !isLast;
    }
  }

  /** Scrolls to a command and marks it. */
  find(event: string): void {
    for (const [name, { item }] of this.commands) {
      item.classList.toggle("found", name === event);
      if (name === event) item.scrollIntoView({ block: "nearest" });
    }
  }

  private command(name: string): HTMLLIElement {
    const event = this.description.events[name]!;
    const verdict = html("span", { class: "verdict" });
    const reason = html("p", { class: "reason" });
    const why = html("div", { class: "why" });
    const links = html("p", { class: "links" });
    for (const requirement of this.description.requirements.filter((stated) => stated.event === name))
      links.append(
        html(
          "button",
          { type: "button", class: "link", onclick: () => this.goTo(requirement.place) },
          requirement.name || `requirement${requirement.place === null ? "" : ` in line ${requirement.place.line}`}`,
        ),
        " ",
      );
    if (this.asking !== null)
      links.append(html("button", { type: "button", onclick: () => void this.explain(name, why) }, "What would help?"));
    const title = this.link(event);
    const performer = this.asking?.perform ? this.performer(name, event) : null;
    const item = html(
      "li",
      { "data-event": name },
      html("p", { class: "command" }, title, " ", verdict, " ", performer ?? ""),
      reason,
      links,
      why,
    );
    const perform = performer?.querySelector("button") ?? null;
    this.commands.set(name, { item, verdict, reason, links, why, perform, told: "?" });
    return item;
  }

  private link(event: Event): HTMLElement {
    return html("button", { type: "button", class: "link", onclick: () => this.goTo(event.place) }, event.words);
  }

  /** A button that performs an event, with a field for each of its inputs. */
  private performer(name: string, event: Event): HTMLElement {
    const fields = event.inputs.map((input) => [input, field(input)] as const);
    const others = event.kept.map((kept) => [kept, free(kept)] as const);
    const label = this.description.commands.includes(name) ? "send" : event.words;
    const button = html("button", { type: "button", "data-event": name, "aria-label": label === "send" ? `send ${event.words}` : label }, label);
    button.addEventListener("click", () =>
      this.asking?.perform?.(
        name,
        Object.fromEntries(fields.map(([input, shown]) => [input.name, value(input, shown)])),
        others.map(([kept, shown]) => [kept.path, typed(kept, shown)]),
      ),
    );
    return html(
      "span",
      { class: "performer" },
      button,
      ...[...fields, ...others].map(([one, shown]) => html("label", {}, ` ${one.label} `, shown)),
    );
  }

  private async explain(name: string, why: HTMLElement): Promise<void> {
    why.replaceChildren(html("p", {}, "…"));
    try {
      const told = await this.asking!.explain(name);
      const list = (title: string, texts: string[]): Node[] =>
        texts.length === 0 ? [] : [html("p", {}, title), html("ul", {}, ...texts.map((text) => html("li", {}, ...worded(text))))];
      why.replaceChildren(
        ...list(told.allowed ? "It is allowed." : "Because:", told.notes),
        ...list("Otherwise:", told.otherwise === "" ? [] : [told.otherwise]),
        ...list("It would be allowed with:", told.changes),
        ...list("The shortest way there:", told.way === "" ? [] : [told.way]),
      );
    } catch (error) {
      why.replaceChildren(html("p", { class: "fault" }, String(error instanceof Error ? error.message : error)));
    }
  }
}

function field(input: Input): HTMLSelectElement | HTMLInputElement {
  if (input.values !== undefined)
    return html("select", {}, ...input.values.map((literal, number) => html("option", { value: number }, String(literal))));
  const { minimum = 0, maximum = 0 } = input;
  return html("input", { type: "number", min: minimum, max: maximum, value: Math.min(Math.max(0, minimum), maximum) });
}

function value(input: Input, shown: HTMLSelectElement | HTMLInputElement): Value {
  return input.values === undefined ? Math.trunc(Number(shown.value)) : input.values[Number(shown.value)]!;
}

function free({ kind }: Beside): HTMLInputElement {
  if (kind === "checkbox" || kind === "text") return html("input", { type: kind });
  return html("input", { type: "number", step: kind === "whole" ? 1 : "any", value: 0 });
}

function typed({ kind }: Beside, shown: HTMLInputElement): Value {
  if (kind === "checkbox") return shown.checked;
  if (kind === "text") return shown.value;
  return kind === "whole" ? Math.trunc(Number(shown.value)) : Number(shown.value);
}
