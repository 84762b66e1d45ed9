/** Finding and making elements, with their types. */

/** The element with this id; a page without it was built wrongly. */
export function byId<T extends Element>(id: string, type: new () => T): T {
  const found = document.getElementById(id);
  if (!(found instanceof type)) throw new Error(`The page has no ${type.name} with the id '${id}'.`);
  return found;
}

const SVG = 'http://www.w3.org/2000/svg';

/** A new SVG element with attributes. */
export function svg<K extends keyof SVGElementTagNameMap>(
  name: K,
  attributes: Record<string, string | number> = {},
  children: readonly (Node | string)[] = [],
): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  element.append(...children);
  return element;
}

/** A new HTML element with a class and content. */
export function html<K extends keyof HTMLElementTagNameMap>(
  name: K,
  className = '',
  content: readonly (Node | string)[] = [],
): HTMLElementTagNameMap[K] {
  const element = document.createElement(name);
  if (className) element.className = className;
  element.append(...content);
  return element;
}

/** A new button that acts when it is pressed. */
export function button(look: string, words: string, act: () => void): HTMLButtonElement {
  const made = html('button', look, [words]);
  made.type = 'button';
  made.addEventListener('click', act);
  return made;
}

/** Sets text only when it changes, so that layout and screen readers are left in peace. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}
