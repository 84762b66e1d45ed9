/** The hyperparameters of the Gaussian process, and its threshold, among the parameters of a run. */

import { type Overrides, type OverrideValue, override, withOverride } from './overrides.ts';
import type { ParameterGroup } from './parameters.ts';

const PERCEPTION = 'planner.perception';
const KERNEL = 'planner.perception.kernel';

/** What is known of a run's parameters. */
interface Known {
  readonly overrides: Overrides;
  /** With the values that hold unless they are overridden. */
  readonly parameters: readonly ParameterGroup[];
}

/** The values by hand. */
export interface Hyperparameters {
  readonly threshold: number;
  readonly azimuth_rad: number;
  readonly elevation_rad: number;
  readonly noise_m2: number;
  readonly alpha: number;
  readonly variance_m2: number;
}

/** What holds at present. */
export function hyperparametersOf(info: Known): Hyperparameters {
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
export function withHyperparameters(overrides: Overrides, values: Partial<Hyperparameters>, info: Known): Overrides {
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
