/** The five quantities that the paper's metrics sum up, tick by tick. */

import type { RowName, RunRecord } from '../run/record.ts';

/** Below this speed the curvature |ω / v| has no meaning, as in the metric. */
const LEAST_SPEED_M_S = 0.05;
const DEGREES = 180 / Math.PI;

export interface Series {
  readonly key: 'roll' | 'pitch' | 'elevation_rate' | 'vibration' | 'curvature';
  readonly name: string;
  readonly unit: string;
  readonly decimals: number;
  /** Less than this is little: the plot's height is not filled with it. */
  readonly little: number;
  /** In `unit`; NaN where the tick has none. */
  value(record: RunRecord, row: number): number;
}

export const SERIES: readonly Series[] = [
  angle('roll', 'Roll'),
  angle('pitch', 'Pitch'),
  {
    key: 'elevation_rate',
    name: 'Elevation rate',
    unit: 'cm/s',
    decimals: 1,
    little: 1,
    value: (record, row) => duringTick(record, row, 'mean_elevation_rate_cm_s'),
  },
  {
    key: 'vibration',
    name: 'Vibration',
    unit: 'rad/s',
    decimals: 3,
    little: 0.01,
    value: (record, row) => duringTick(record, row, 'mean_vibration_rad_s'),
  },
  {
    key: 'curvature',
    name: 'Curvature',
    unit: 'rad/m',
    decimals: 2,
    little: 0.1,
    value(record, row) {
      const speed_m_s = Math.abs(record.get(row, 'v_m_s'));
      return speed_m_s < LEAST_SPEED_M_S ? Number.NaN : Math.abs(record.get(row, 'omega_rad_s')) / speed_m_s;
    },
  },
];

function angle(key: 'roll' | 'pitch', name: string): Series {
  return { key, name, unit: '°', decimals: 1, little: 5, value: (record, row) => DEGREES * record.get(row, key) };
}

/** Mean over the tick that ends here, from the means since the start. */
function duringTick(record: RunRecord, row: number, mean: RowName): number {
  if (row === 0) return Number.NaN;
  const total = (at: number) => record.get(at, mean) * record.get(at, 'time_s');
  const duration_s = record.get(row, 'time_s') - record.get(row - 1, 'time_s');
  // Rounding leaves a little less than nothing where the robot stands.
  return Math.max((total(row) - total(row - 1)) / duration_s, 0);
}

export interface Sampled {
  /** Times and values in turn; a NaN value breaks the line. */
  readonly points: number[];
  readonly lowest: number;
  readonly highest: number;
}

/** The rows from `begin` to before `end`, thinned to the extremes of each of `columns` stretches: no peak is lost. */
export function sample(record: RunRecord, series: Series, begin: number, end: number, columns: number): Sampled {
  const points: number[] = [];
  let [lowest, highest] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
  const stretch = Math.max((end - begin) / columns, 1);
  for (let from = begin; from < end; from += stretch) {
    const to = Math.min(Math.ceil(from + stretch), end);
    let least = -1;
    let most = -1;
    let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
    for (let row = Math.ceil(from); row < to; row += 1) {
      const value = series.value(record, row);
      if (value < low) [low, least] = [value, row];
      if (value > high) [high, most] = [value, row];
    }
    if (least < 0) {
      if (Math.ceil(from) < to) points.push(record.get(Math.ceil(from), 'time_s'), Number.NaN);
      continue;
    }
    for (const row of least < most ? [least, most] : least > most ? [most, least] : [least]) {
      points.push(record.get(row, 'time_s'), row === least ? low : high);
    }
    lowest = Math.min(lowest, low);
    highest = Math.max(highest, high);
  }
  return { points, lowest, highest };
}
