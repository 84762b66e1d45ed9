/** How far a skyline is from the true one. */

/** Where the occupancy ends: a degree there is this many metres. */
const RADIUS_M = 7;

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

/** In degrees, and in centimetres at the edge of the occupancy surface. */
export function errorWords({ mean_rad }: SkylineError): string {
  return `${((mean_rad * 180) / Math.PI).toFixed(2)}° (${Math.round(100 * RADIUS_M * mean_rad)} cm at 7 m)`;
}
