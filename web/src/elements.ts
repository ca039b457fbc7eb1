// Only this module creates elements, and never from markup, so that the contents of a model remain text.

type Attributes = Record<string, string | number | boolean | ((event: never) => void)>;

/** An HTML element with attributes, listeners (`onclick: …`) and children. */
export function html<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Name] {
  return filled(document.createElement(name), attributes, children);
}

/** An SVG element with attributes, listeners and children. */
export function svg<Name extends keyof SVGElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): SVGElementTagNameMap[Name] {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
}

/** A text as the children of an element. Backticks enclose parts from the model. */
export function worded(text: string): (Node | string)[] {
  return text.split("`").map((part, number) => (number % 2 === 1 ? html("code", {}, part) : part));
}

/** The element of the page with this identifier. */
export function byId<Kind extends HTMLElement>(id: string, kind: new () => Kind): Kind {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${id}`);
  return found;
}

function filled<Kind extends Element>(element: Kind, attributes: Attributes, children: (Node | string)[]): Kind {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value as EventListener);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false) element.setAttribute(name, String(value));
  }
  element.append(...children);
  return element;
}

/** Calls a function on a click and on the keys Enter and Space. */
export function pressed(element: Element, act: () => void): void {
  element.addEventListener("click", (event) => {
    event.stopPropagation();
    act();
  });
  element.addEventListener("keydown", (event) => {
    const { key } = event as KeyboardEvent;
    if (key === "Enter" || key === " ") {
      event.preventDefault();
      act();
    }
  });
}
