/** Numbers as people read them. */

const MINUS = '\u2212';

/** Fixed decimals, with a real minus sign; a dash for what is not a number. */
export function fixed(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return '–';
  const text = Math.abs(value).toFixed(decimals);
  const zero = Number(text) === 0;
  return value < 0 && !zero ? MINUS + text : text;
}

export function degrees(angle_rad: number, decimals = 0): string {
  return `${fixed((angle_rad * 180) / Math.PI, decimals)}°`;
}

/** A round length as it is, another one to two figures. */
export function metres(length_m: number): string {
  return `${Number(length_m.toPrecision(2))} m`;
}

/** As in a field: from 0 to 359. */
export function wholeDegrees(angle_rad: number): number {
  return ((Math.round((angle_rad * 180) / Math.PI) % 360) + 360) % 360;
}

export function radians(angle_deg: number): number {
  return (angle_deg * Math.PI) / 180;
}

/** Minutes and seconds: `1:07.3`. */
export function clock(time_s: number): string {
  const tenths = Math.round(time_s * 10);
  const minutes = Math.floor(tenths / 600);
  const seconds = ((tenths % 600) / 10).toFixed(1).padStart(4, '0');
  return `${minutes}:${seconds}`;
}

/** The angle in [-π, π). */
export function wrap(angle_rad: number): number {
  const turn = 2 * Math.PI;
  return angle_rad - turn * Math.floor((angle_rad + Math.PI) / turn);
}

/** A whole number with commas at the thousands. The browser's own formatting is slow to begin. */
export function grouped(count: number): string {
  return String(count).replace(/\B(?=(\d{3})+$)/g, ',');
}
