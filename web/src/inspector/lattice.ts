/** The lattice of the variance image: columns of azimuth from straight behind over the right, rows of elevation from the lowest up. */

import { wrap } from '../base/format.ts';

/** The highest row; the lowest lies as far below the horizon. */
export const TOP_RAD = (15 * Math.PI) / 180;

export function azimuthOf(column: number, columns: number): number {
  return -Math.PI + (column * 2 * Math.PI) / columns;
}

/** The column nearest to a direction. */
export function columnOf(azimuth_rad: number, columns: number): number {
  return Math.round(((wrap(azimuth_rad) + Math.PI) / (2 * Math.PI)) * columns) % columns;
}

/** How many columns lie between two, around the shorter way. */
export function columnsApart(one: number, other: number, columns: number): number {
  const apart = Math.abs(one - other);
  return Math.min(apart, columns - apart);
}

export function elevationOf(row: number, rows: number): number {
  return TOP_RAD * ((2 * row) / (rows - 1) - 1);
}

/** The row nearest to an elevation, the highest or the lowest for what lies beyond. */
export function rowOf(elevation_rad: number, rows: number): number {
  const share = (elevation_rad / TOP_RAD + 1) / 2;
  return Math.round((rows - 1) * Math.min(Math.max(share, 0), 1));
}
