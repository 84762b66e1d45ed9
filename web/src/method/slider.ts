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
    Object.assign(this.#input, { type: 'range', min: '0', max: String(scale.steps), step: '1' });
    this.#input.addEventListener('input', () => {
      this.#say(this.value);
      move(this.value);
    });
    if (set) this.#input.addEventListener('change', () => set(this.value));
    this.row = html('label', 'knob', [html('span', '', [name]), this.#input, this.#output]);
  }

  get value(): number {
    const { lowest, highest, steps, logarithmic } = this.#scale;
    const share = Number(this.#input.value) / steps;
    const value = logarithmic ? lowest * (highest / lowest) ** share : lowest + (highest - lowest) * share;
    return Number(value.toPrecision(3));
  }

  /** A value beyond the ends stands at the end, in its own words. */
  set value(value: number) {
    const { lowest, highest, steps, logarithmic } = this.#scale;
    const share = logarithmic
      ? Math.log(value / lowest) / Math.log(highest / lowest)
      : (value - lowest) / (highest - lowest);
    this.#input.value = String(Math.round(steps * share));
    this.#say(value);
  }

  get isInHand(): boolean {
    return this.#input === document.activeElement;
  }

  /** What screen readers say in place of its name. */
  set label(label: string) {
    this.#input.setAttribute('aria-label', label);
  }

  #say(value: number): void {
    const words = this.#scale.words(value);
    setText(this.#output, words);
    this.#input.setAttribute('aria-valuetext', words);
  }
}
