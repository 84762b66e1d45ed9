/** What the core tells of each parameter, as people read it. */

import type { OverrideValue, Parameter, ParameterGroup } from '../wasm/mapless_wasm.js';

export type { Parameter, ParameterGroup };

const UNITS = /_(m|m2|m_rad|rad|s|m_s|m_s2|rad_s|rad_s2|ticks|length_scales)$/;

/** A parameter's name as people read it: `max_slope_rad` is “max slope”. */
export function label(name: string): string {
  return name.replace(UNITS, '').replaceAll('_', ' ');
}

/** A value as it is written in a field or a sentence; angles have four decimals at most. */
export function shown(value: OverrideValue, unit = ''): string {
  if (typeof value === 'boolean') return value ? 'on' : 'off';
  if (typeof value === 'string') return value.replaceAll('_', ' ');
  const rounded = (one: unknown) => String(unit === 'rad' && typeof one === 'number' ? Number(one.toFixed(4)) : one);
  return typeof value === 'number' ? rounded(value) : value.map(rounded).join(', ');
}

/** The parameter that a message of the core complains about, as `table.name`. */
export function complaintAbout(message: string, groups: readonly ParameterGroup[]): string | undefined {
  const paths = groups.flatMap(({ table, parameters }) => parameters.map(({ name }) => `${table}.${name}`));
  return paths.find((path) => message.includes(`${path} = `));
}
