/** Colour scales that keep their order for colour-blind readers and in print: lightness rises evenly along them. */

export type Rgb = readonly [red: number, green: number, blue: number];

/** Nine samples of matplotlib's plasma, without its darkest end, which vanishes on a dark ground. */
export const PLASMA: readonly Rgb[] = [
  [75, 3, 161],
  [106, 0, 168],
  [143, 13, 164],
  [177, 42, 144],
  [204, 71, 120],
  [225, 100, 98],
  [242, 132, 75],
  [252, 166, 54],
  [252, 206, 37],
];

/** Eight samples of matplotlib's viridis, without its darkest end, for what is measured. */
export const VIRIDIS: readonly Rgb[] = [
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];

/** Linear interpolation along evenly spaced stops; `t` outside 0 to 1 takes the nearest end. */
export function ramp(stops: readonly Rgb[], t: number): Rgb {
  const place = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const index = Math.min(Math.floor(place), stops.length - 2);
  const from = stops[index] ?? [0, 0, 0];
  const to = stops[index + 1] ?? from;
  const part = place - index;
  const mix = (a: number, b: number) => Math.round(a + (b - a) * part);
  return [mix(from[0], to[0]), mix(from[1], to[1]), mix(from[2], to[2])];
}

/**
 * Colours of subgoals by their total cost. As in the paper, warmer means less cost: the cheapest candidate is yellow,
 * the dearest violet.
 */
export function costColour(total: number, lowest: number, highest: number): Rgb {
  const spread = highest - lowest;
  return ramp(PLASMA, spread > 0 ? 1 - (total - lowest) / spread : 1);
}

export function css([red, green, blue]: Rgb): string {
  return `rgb(${red} ${green} ${blue})`;
}

/** Reads `#rgb` or `#rrggbb`. */
export function parseHex(text: string): Rgb {
  const digits = text.trim().replace('#', '');
  const full = digits.length === 3 ? [...digits].map((digit) => digit + digit).join('') : digits;
  if (!/^[0-9a-f]{6}$/i.test(full)) throw new Error(`'${text}' is not a colour of the form #rrggbb.`);
  const value = Number.parseInt(full, 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}

/** Relative luminance as WCAG defines it, 0 to 1. */
export function luminance(colour: Rgb): number {
  const [red, green, blue] = colour.map((channel) => {
    const part = channel / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * (red ?? 0) + 0.7152 * (green ?? 0) + 0.0722 * (blue ?? 0);
}
