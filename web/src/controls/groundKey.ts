/** By what the ground is coloured, and what the colours mean. */

import { byId, html, setText } from '../base/dom.ts';
import { degrees, fixed } from '../base/format.ts';
import type { HeightField } from '../ground/heightField.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import { COLOURINGS, type Colouring, STEEPEST_SHOWN_RAD } from '../scene/layers.ts';

export class GroundKey {
  readonly #select = byId('ground-colours', HTMLSelectElement);
  readonly #legend = byId('ground-legend', HTMLElement);
  readonly #low = html('span');
  readonly #high = html('span');
  readonly #stand = [html('li', 'stand-0'), html('li', 'stand-1'), html('li', 'stand-2')];
  #lowest_m = 0;
  #highest_m = 0;
  #limits = { roll_rad: 0, pitch_rad: 0 };

  constructor(chosen: (colouring: Colouring) => void) {
    this.#select.addEventListener('change', () => {
      this.#arrange();
      chosen(this.#colouring);
    });
    this.#arrange();
  }

  session({ limits }: SessionInfo): void {
    this.#limits = limits;
    this.#label();
  }

  ground({ min_m, max_m }: HeightField): void {
    this.#lowest_m = min_m;
    this.#highest_m = max_m;
    this.#label();
  }

  get #colouring(): Colouring {
    return COLOURINGS.find((one) => one === this.#select.value) ?? 'elevation';
  }

  #arrange(): void {
    const bar = html('i', `ground-bar ${this.#colouring}-bar`);
    const classes = this.#colouring === 'stand';
    this.#legend.replaceChildren(...(classes ? [html('ul', '', this.#stand)] : [this.#low, bar, this.#high]));
    this.#label();
  }

  #label(): void {
    const { roll_rad, pitch_rad } = this.#limits;
    const slope = this.#colouring === 'slope';
    setText(this.#low, slope ? '0°' : `${fixed(this.#lowest_m, 1)} m`);
    setText(this.#high, slope ? `${degrees(STEEPEST_SHOWN_RAD)} and more` : `${fixed(this.#highest_m, 1)} m`);
    // On a slope the robot rolls most when it stands across it, and pitches most when it faces up or down.
    const [least_rad, most_rad] = [Math.min(roll_rad, pitch_rad), Math.max(roll_rad, pitch_rad)];
    const some = pitch_rad >= roll_rad ? 'facing up or down' : 'across the slope';
    const words = [
      `any heading, to ${degrees(least_rad)}`,
      `only ${some}, to ${degrees(most_rad)}`,
      'too steep to stand',
    ];
    for (const [index, item] of this.#stand.entries()) setText(item, words[index] ?? '');
  }
}
