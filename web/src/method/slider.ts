/** A slider in a row, between its name and what it stands at. */

import { html, setText } from '../base/dom.ts';

export interface Scale {
  readonly lowest: number;
  readonly highest: number;
  readonly steps: number;
  /** Equal steps are equal shares of the value, in place of equal differences. */
  readonly logarithmic?: boolean;
  readonly words: (value: number) => string;
}

export class Slider {
  readonly row: HTMLElement;
  readonly #scale: Scale;
  readonly #input = html('input');
  readonly #output = html('output');

  /** `move` is called while it is dragged, `set` when it is let go. */
  constructor(name: string, scale: Scale, move: (value: number) => void, set?: (value: number) => void) {
    this.#scale = scale;
    const [min, max] = [this.#at(scale.lowest), this.#at(scale.highest)];
    const step = (max - min) / scale.steps;
    Object.assign(this.#input, { type: 'range', min: String(min), max: String(max), step: String(step) });
    this.#input.addEventListener('input', () => {
      this.#say(this.value);
      move(this.value);
    });
    if (set) this.#input.addEventListener('change', () => set(this.value));
    this.row = html('label', 'knob', [html('span', '', [name]), this.#input, this.#output]);
  }

  get value(): number {
    const { lowest, highest, steps, logarithmic } = this.#scale;
    const at = Number(this.#input.value);
    return Number((logarithmic ? lowest * (highest / lowest) ** (at / steps) : at).toPrecision(3));
  }

  /** A value beyond the ends stands at the end, in its own words. */
  set value(value: number) {
    this.#input.value = String(this.#at(value));
    this.#say(value);
  }

  get isInHand(): boolean {
    return this.#input === document.activeElement;
  }

  /** What screen readers say in place of its name. */
  set label(label: string) {
    this.#input.setAttribute('aria-label', label);
  }

  /** Where a value is in the slider's own numbers: its steps from the lowest where those are shares. */
  #at(value: number): number {
    const { lowest, highest, steps, logarithmic } = this.#scale;
    return logarithmic ? (steps * Math.log(Math.max(value, lowest) / lowest)) / Math.log(highest / lowest) : value;
  }

  #say(value: number): void {
    const words = this.#scale.words(value);
    setText(this.#output, words);
    this.#input.setAttribute('aria-valuetext', words);
  }
}
