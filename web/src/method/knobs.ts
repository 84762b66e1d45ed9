/** The process's parameters as sliders: what is dragged shows at once, what is let go holds. */

import { html } from '../base/dom.ts';
import { degrees, fixed } from '../base/format.ts';
import { type Overrides, type OverrideValue, override, withOverride } from '../experiment/overrides.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import { type Scale, Slider } from './slider.ts';

const PERCEPTION = 'planner.perception';
const KERNEL = 'planner.perception.kernel';

/** The values that the sliders move. */
export interface Hyperparameters {
  readonly threshold: number;
  readonly azimuth_rad: number;
  readonly elevation_rad: number;
  readonly noise_m2: number;
  readonly alpha: number;
  readonly variance_m2: number;
}

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

/** What holds at present. */
export function hyperparametersOf(info: SessionInfo): Hyperparameters {
  const value = (table: string, name: string): OverrideValue | undefined =>
    override(info.overrides, table, name) ??
    info.parameters.find((group) => group.table === table)?.parameters.find((one) => one.name === name)?.value;
  const number = (table: string, name: string) => Number(value(table, name));
  const scales = value(KERNEL, 'length_scales_rad');
  const [azimuth, elevation] = Array.isArray(scales) ? scales : [];
  return {
    threshold: number(PERCEPTION, 'variance_threshold'),
    azimuth_rad: Number(azimuth),
    elevation_rad: Number(elevation),
    noise_m2: number(PERCEPTION, 'noise_variance_m2'),
    alpha: number(KERNEL, 'alpha'),
    variance_m2: number(KERNEL, 'variance'),
  };
}

/** The overrides with these values in place of those there were. */
export function withHyperparameters(
  overrides: Overrides,
  values: Partial<Hyperparameters>,
  info: SessionInfo,
): Overrides {
  const all = { ...hyperparametersOf(info), ...values };
  let changed = overrides;
  const set = (table: string, name: string, value: OverrideValue) => {
    changed = withOverride(changed, table, name, value);
  };
  if (values.threshold !== undefined) set(PERCEPTION, 'variance_threshold', values.threshold);
  if (values.noise_m2 !== undefined) set(PERCEPTION, 'noise_variance_m2', values.noise_m2);
  if (values.alpha !== undefined) set(KERNEL, 'alpha', values.alpha);
  if (values.variance_m2 !== undefined) set(KERNEL, 'variance', values.variance_m2);
  if (values.azimuth_rad !== undefined || values.elevation_rad !== undefined)
    set(KERNEL, 'length_scales_rad', [all.azimuth_rad, all.elevation_rad]);
  return changed;
}

/** The overrides without any of the process. */
export function withoutHyperparameters(overrides: Overrides): Overrides {
  const names: [string, string][] = [
    [PERCEPTION, 'variance_threshold'],
    [PERCEPTION, 'noise_variance_m2'],
    [PERCEPTION, 'inducing_inputs'],
    [PERCEPTION, 'inducing_spacing_length_scales'],
    [KERNEL, 'alpha'],
    [KERNEL, 'variance'],
    [KERNEL, 'length_scales_rad'],
  ];
  return names.reduce((all, [table, name]) => withOverride(all, table, name, undefined), overrides);
}

/** The paper's values of the process alone, whatever planner drives. */
export function withPaperProcess(overrides: Overrides): Overrides {
  const values: [string, string, OverrideValue][] = [
    [PERCEPTION, 'variance_threshold', 0.7],
    [PERCEPTION, 'noise_variance_m2', 0.01],
    [PERCEPTION, 'inducing_inputs', 'farthest_points'],
    [PERCEPTION, 'inducing_spacing_length_scales', 0.85],
    [KERNEL, 'length_scales_rad', [0.035, 0.035]],
  ];
  return values.reduce(
    (all, [table, name, value]) => withOverride(all, table, name, value),
    withoutHyperparameters(overrides),
  );
}
