/** Checks of single values from outside; each fault names the place, the value and what was expected. */

export function fail(place: string, value: unknown, expected: string): never {
  const shown = typeof value === 'number' ? String(value) : (JSON.stringify(value) ?? 'absent');
  const short = shown.length > 60 ? `${shown.slice(0, 57)}…` : shown;
  throw new Error(`${place} = ${short}: expected ${expected}`);
}

export function number(value: unknown, place: string, low: number, high: number): number {
  if (typeof value !== 'number' || !(value >= low && value <= high))
    fail(place, value, `a number from ${low} to ${high}`);
  return value;
}

export function whole(value: unknown, place: string, low: number, high: number): number {
  if (!Number.isInteger(value)) fail(place, value, `a whole number from ${low} to ${high}`);
  return number(value, place, low, high);
}

export function oneOf<T extends string>(value: unknown, place: string, names: readonly T[]): T {
  const found = names.find((name) => name === value);
  return found ?? fail(place, value, names.join(' or '));
}

type Fields = Record<string, unknown>;

/** An object with these keys and no others; those after `optional` may be absent. */
export function fields(
  value: unknown,
  place: string,
  required: readonly string[],
  optional: readonly string[] = [],
): Fields {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) fail(place, value, 'a table');
  const found = value as Fields;
  for (const key of Object.keys(found)) {
    if (!required.includes(key) && !optional.includes(key)) {
      fail(`${place}.${key}`, found[key], `one of the keys ${[...required, ...optional].join(', ')}`);
    }
  }
  for (const key of required) {
    if (found[key] === undefined) fail(`${place}.${key}`, undefined, 'a value');
  }
  return found;
}

/** A list of at most so many entries. */
export function list(value: unknown, place: string, most: number): readonly unknown[] {
  if (!Array.isArray(value)) fail(place, value, 'a list');
  if (value.length > most) fail(place, `${value.length} entries`, `at most ${most}`);
  return value;
}
