/** How far a skyline is from the true one. */

import { degrees, metres } from '../base/format.ts';

export interface SkylineError {
  readonly mean_rad: number;
  readonly columns: number;
}

/** Mean distance over the columns in which both have a skyline; nothing where there is none. */
export function skylineError(profile: Float32Array, truth: Float32Array): SkylineError | undefined {
  let [sum, columns] = [0, 0];
  profile.forEach((elevation_rad, column) => {
    const off_rad = Math.abs(elevation_rad - (truth[column] ?? Number.NaN));
    if (Number.isNaN(off_rad)) return;
    sum += off_rad;
    columns += 1;
  });
  return columns > 0 ? { mean_rad: sum / columns, columns } : undefined;
}

/** In degrees, and in centimetres at the edge of the occupancy surface, which lies `radius_m` away. */
export function errorWords({ mean_rad }: SkylineError, radius_m: number): string {
  return `${degrees(mean_rad, 2)} (${Math.round(100 * radius_m * mean_rad)} cm at ${metres(radius_m)})`;
}
