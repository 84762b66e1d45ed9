/** Size, strength and height of the brush in hand. */

import { byId } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import { BRUSHES, type BrushTool, strength_m } from '../ground/brushes.ts';
import { type BrushSetting, isBrush, type Tool } from '../view/groundTools.ts';

export class BrushPanel {
  readonly #panel = byId('brush', HTMLElement);
  readonly #size = byId('brush-size', HTMLInputElement);
  readonly #sizeShown = byId('brush-value', HTMLOutputElement);
  readonly #strengthField = byId('brush-strength-field', HTMLElement);
  readonly #strength = byId('brush-strength', HTMLInputElement);
  readonly #strengthShown = byId('brush-strength-value', HTMLOutputElement);
  readonly #heightField = byId('brush-height-field', HTMLElement);
  readonly #height = byId('brush-height', HTMLInputElement);
  readonly #changed: (setting: BrushSetting) => void;
  #tool: Tool = 'look';
  #height_m = 0;

  constructor(changed: (setting: BrushSetting) => void) {
    this.#changed = changed;
    for (const input of [this.#size, this.#strength, this.#height]) input.addEventListener('input', () => this.#read());
  }

  tool(tool: Tool): void {
    this.#tool = tool;
    this.#panel.hidden = !isBrush(tool);
    const brush: BrushTool | undefined = isBrush(tool) ? BRUSHES[tool] : undefined;
    // A ramp goes all the way, however strong.
    this.#strengthField.hidden = brush?.kind === 'ramp';
    this.#heightField.hidden = tool !== 'height';
    this.#read();
  }

  /** The middle height of new ground is one to begin with. */
  ground(min_m: number, max_m: number): void {
    this.#height.value = ((min_m + max_m) / 2).toFixed(1);
    this.#read();
  }

  grow(steps: number): void {
    this.#move(this.#size, steps);
  }

  strengthen(steps: number): void {
    this.#move(this.#strength, steps);
  }

  #move(input: HTMLInputElement, steps: number): void {
    if (steps > 0) input.stepUp(steps);
    else input.stepDown(-steps);
    this.#read();
  }

  #read(): void {
    const radius_m = this.#size.valueAsNumber;
    const strength = this.#strength.valueAsNumber;
    const height_m = Math.round(1000 * this.#height.valueAsNumber) / 1000;
    this.#sizeShown.value = `${fixed(radius_m, 1)} m`;
    if (isBrush(this.#tool)) this.#strengthShown.value = `${fixed(strength_m(this.#tool, radius_m, strength), 2)} m`;
    // While a number is being typed, the last whole one stands.
    if (this.#height.validity.valid && Number.isFinite(height_m)) this.#height_m = height_m;
    this.#changed({ radius_m, strength, height_m: this.#height_m });
  }
}
