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
