/** The process's parameters as sliders: what is dragged shows at once, what is let go holds. */

import { html } from '../base/dom.ts';
import { degrees, fixed } from '../base/format.ts';
import type { Hyperparameters } from '../experiment/hyperparameters.ts';
import { type Scale, Slider } from './slider.ts';

interface Knob extends Scale {
  readonly of: keyof Hyperparameters;
  readonly name: string;
  readonly title: string;
}

/** Ends of the threshold: beyond them all is free, or nothing. */
export const THRESHOLD = { lowest: 0.05, highest: 0.98 };
const STEPS = 200;

const squareMetres = (value: number) => `${value < 0.1 ? fixed(value, 3) : fixed(value, 2)} m²`;

const KNOBS: readonly Knob[] = [
  {
    of: 'threshold',
    name: 'V_th',
    title: 'Share of the prior variance above which space counts as free',
    ...THRESHOLD,
    steps: STEPS,
    words: (value) => fixed(value, 2),
  },
  {
    of: 'azimuth_rad',
    name: 'ℓ azimuth',
    title: 'Length-scale over azimuth: how far around a return counts',
    lowest: 0.01,
    highest: 1,
    steps: STEPS,
    logarithmic: true,
    words: (value) => degrees(value, 1),
  },
  {
    of: 'elevation_rad',
    name: 'ℓ elevation',
    title: 'Length-scale over elevation: how far up and down a return counts; rings are 2° apart',
    lowest: 0.01,
    highest: 1,
    steps: STEPS,
    logarithmic: true,
    words: (value) => degrees(value, 1),
  },
  {
    of: 'noise_m2',
    name: 'noise σₙ²',
    title: 'How little one return is trusted',
    lowest: 0.001,
    highest: 20,
    steps: STEPS,
    logarithmic: true,
    words: squareMetres,
  },
  {
    of: 'alpha',
    name: 'α',
    title: 'Mixture of length-scales: small is many at once',
    lowest: 0.1,
    highest: 100,
    steps: STEPS,
    logarithmic: true,
    words: (value) => fixed(value, 1),
  },
];

export class Knobs {
  readonly element = html('div', 'knobs');
  readonly #sliders: readonly (readonly [keyof Hyperparameters, Slider])[];

  /** `move` is called while a slider is dragged, `set` when it is let go. */
  constructor(move: (value: Partial<Hyperparameters>) => void, set: (value: Partial<Hyperparameters>) => void) {
    this.#sliders = KNOBS.map((knob) => {
      const { of, name, title } = knob;
      const slider = new Slider(
        name,
        knob,
        (value) => move({ [of]: value }),
        (value) => set({ [of]: value }),
      );
      slider.row.title = title;
      this.element.append(slider.row);
      return [of, slider] as const;
    });
  }

  /** Shows what holds; with `busy`, a slider in hand stays where it is. */
  show(values: Hyperparameters, busy: boolean): void {
    for (const [of, slider] of this.#sliders) if (!busy || !slider.isInHand) slider.value = values[of];
  }
}
