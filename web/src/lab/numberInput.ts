/** Number fields of the drawer. */

import { html } from '../base/dom.ts';

/** `owner` keeps the fields of several tabs apart. */
export function numberInput(owner: string, name: string, min: number, max: number, value: number): HTMLInputElement {
  const input = html('input');
  input.type = 'number';
  input.id = `${owner}-${name.toLowerCase().replaceAll(' ', '-')}`;
  input.required = true;
  input.step = '1';
  [input.min, input.max, input.value] = [String(min), String(max), String(value)];
  input.setAttribute('aria-label', name);
  return input;
}

export function labelled<T extends HTMLElement>(input: T): [HTMLElement, T] {
  const label = html('label', '', [input.getAttribute('aria-label') ?? '']);
  label.htmlFor = input.id;
  return [label, input];
}
