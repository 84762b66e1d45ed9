/** Parameters that differ from the defaults, by the names and tables of scenario files. Plain data, never changed in place. */

import type { Overrides, OverrideValue } from '../wasm/mapless_wasm.js';

export type { Overrides, OverrideValue };

/** The value of `name` in a table such as `planner.forecast`, if it is overridden. */
export function override(overrides: Overrides, table: string, name: string): OverrideValue | undefined {
  let inner: Overrides | undefined = overrides;
  for (const key of table.split('.')) inner = inner && isTable(inner[key]) ? inner[key] : undefined;
  const value = inner?.[name];
  return isTable(value) ? undefined : value;
}

/** The same with another value, or with none; tables that become empty go. */
export function withOverride(
  overrides: Overrides,
  table: string,
  name: string,
  value: OverrideValue | undefined,
): Overrides {
  return changed(overrides, table.split('.'), name, value);
}

function changed(table: Overrides, path: string[], name: string, value: OverrideValue | undefined): Overrides {
  const [key = name, ...rest] = path;
  const { [key]: old, ...others } = table;
  if (path.length === 0) return value === undefined ? others : { ...others, [name]: value };
  const inner = changed(isTable(old) ? old : {}, rest, name, value);
  return Object.keys(inner).length === 0 ? others : { ...others, [key]: inner };
}

/** How many values are overridden. */
export function countOverrides(overrides: Overrides): number {
  const counts: number[] = Object.values(overrides).map((value) => (isTable(value) ? countOverrides(value) : 1));
  return counts.reduce((sum, count) => sum + count, 0);
}

/** Each value that is overridden, with its whole name: `sensor.range_noise_m = 0.1`. */
export function assignmentsOf(overrides: Overrides, path = ''): readonly string[] {
  return Object.entries(overrides).flatMap(([key, value]) =>
    isTable(value) ? assignmentsOf(value, `${path}${key}.`) : [`${path}${key} = ${literal(value)}`],
  );
}

/** The sections of a scenario file that say the same. */
export function sectionsOf(overrides: Overrides): string {
  return Object.entries(overrides)
    .flatMap(([name, value]) => (isTable(value) ? lines(name, value) : []))
    .join('\n')
    .trimStart();
}

/** A table with its inner tables after its values, as TOML wants it. */
function lines(path: string, table: Overrides): string[] {
  const entries = Object.entries(table);
  const values = entries.filter(([, value]) => !isTable(value)).map(([key, value]) => `${key} = ${literal(value)}`);
  const inner = entries.flatMap(([key, value]) => (isTable(value) ? lines(`${path}.${key}`, value) : []));
  return [...(values.length > 0 ? ['', `[${path}]`, ...values] : []), ...inner];
}

/** A value as TOML writes it. */
export function literal(value: OverrideValue | Overrides): string {
  if (Array.isArray(value)) return `[${value.map(literal).join(', ')}]`;
  if (!isTable(value)) return JSON.stringify(value);
  const entries = Object.entries(value).map(([key, one]) => `${key} = ${literal(one)}`);
  return `{ ${entries.join(', ')} }`;
}

function isTable(value: OverrideValue | Overrides | undefined): value is Overrides {
  return typeof value === 'object' && !Array.isArray(value);
}
