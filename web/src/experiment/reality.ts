/** The section `reality` of the parameters: what the world does to sensing, knowing and doing. */

import { type Overrides, type OverrideValue, override } from './overrides.ts';
import type { Parameter, ParameterGroup } from './parameters.ts';

const TABLE = 'reality';
const IDEAL = 'ideal';

/** The names of the presets, as the core has them. */
export function realityPresets(groups: readonly ParameterGroup[]): readonly string[] {
  const preset = groups.find(({ table }) => table === TABLE)?.parameters.find(({ name }) => name === 'preset');
  return preset?.choices ?? [];
}

/** Whether a group describes effects of reality. */
export function isEffects({ table }: Pick<ParameterGroup, 'table'>): boolean {
  return table.startsWith(`${TABLE}.`);
}

/** A preset in place of all that is set in `reality`; whatever else is overridden stays. */
export function withReality(overrides: Overrides, preset: string): Overrides {
  const { [TABLE]: _before, ...others } = overrides;
  return preset === IDEAL ? others : { ...others, [TABLE]: { preset } };
}

/** The preset that is set. */
export function realityOf(overrides: Overrides): OverrideValue {
  return override(overrides, TABLE, 'preset') ?? IDEAL;
}

/** The same where nothing goes wrong. */
export function inIdealWorld(overrides: Overrides): Overrides {
  return withReality(overrides, IDEAL);
}

/** Whether an effect is there: its value is not that of the ideal world. */
export function isOn({ presets }: Pick<Parameter, 'presets'>, value: OverrideValue): boolean {
  const ideal = presets.find(({ preset }) => preset === IDEAL);
  return ideal !== undefined && JSON.stringify(ideal.value) !== JSON.stringify(value);
}
