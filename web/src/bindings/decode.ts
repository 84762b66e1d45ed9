/** Names for the flat arrays that the core sends; `crate/wasm` documents their order. */

import {
  COLUMN_KINDS,
  type ColumnKind,
  REACH_ENDS,
  REFUSALS,
  type Segment,
  type Subgoal,
  TERMS,
  VERDICTS,
} from '../protocol/simulationProtocol.ts';
import { METRICS, MOTION } from './columns.ts';

/** Order of the scalars in `CoreSession.scene`. */
export const SCENE = [
  'start_x',
  'start_y',
  'start_heading_rad',
  'goal_x',
  'goal_y',
  'roll_limit_rad',
  'pitch_limit_rad',
  'occupancy_radius_m',
  'sensor_height_m',
  'image_columns',
  'image_rows',
  'image_rings',
  'robot_width_m',
  'safety_margin_m',
  'max_slope_rad',
  'subgoals_on_unknown',
  'period_s',
] as const;

/** Order of the scalars in `CoreSession.status`. */
export const STATUS = ['tick', 'time_s', ...MOTION, 'threshold', ...METRICS, 'waypoints_passed'] as const;

const SEGMENT_STRIDE = 6;
const SUBGOAL_STRIDE = 13;

/** Gives the core's scalars their names. */
export function named<Name extends string>(names: readonly Name[], values: Float64Array): Record<Name, number> {
  if (values.length !== names.length) {
    throw new Error(`The core sent ${values.length} numbers; the page expects ${names.length}: ${names.join(', ')}.`);
  }
  return Object.fromEntries(names.map((name, index) => [name, values[index]])) as Record<Name, number>;
}

/** Those of a row's numbers that have these names. */
export function only<Name extends string>(
  names: readonly Name[],
  row: Readonly<Record<Name, number>>,
): Record<Name, number> {
  return Object.fromEntries(names.map((name) => [name, row[name]])) as Record<Name, number>;
}

export function decodeSegments(values: Float64Array): Segment[] {
  return chunks(values, SEGMENT_STRIDE).map(([begin_rad, end_rad, elevation_rad, height_m, width_m, verdict]) => ({
    begin_rad: begin_rad ?? 0,
    end_rad: end_rad ?? 0,
    elevation_rad: elevation_rad ?? 0,
    height_m: height_m ?? 0,
    width_m: width_m ?? 0,
    verdict: at(VERDICTS, verdict),
  }));
}

export function decodeSubgoals(values: Float64Array): Subgoal[] {
  return chunks(values, SUBGOAL_STRIDE + TERMS.length).map((chunk) => {
    const [azimuth_rad = 0, elevation_rad = 0, x = 0, y = 0, z = 0, chosen = 0, refusal = 0, segment = -1] = chunk;
    const [reach_m = 0, mean_risk = 0, max_roll_rad = 0, max_pitch_rad = 0, end = 0] = chunk.slice(8);
    const terms = chunk.slice(SUBGOAL_STRIDE);
    const total = terms.reduce((sum, term) => sum + term, 0);
    return {
      azimuth_rad,
      elevation_rad,
      x,
      y,
      z,
      chosen: chosen === 1,
      refusal: at(REFUSALS, refusal),
      segment: segment < 0 ? undefined : segment,
      forecast: Number.isNaN(reach_m)
        ? undefined
        : { reach_m, mean_risk, max_roll_rad, max_pitch_rad, end: at(REACH_ENDS, end) },
      terms: Number.isNaN(total) ? undefined : terms,
      total,
    };
  });
}

export function kindOf(code: number | undefined): ColumnKind {
  return at(COLUMN_KINDS, code);
}

function at<T>(names: readonly T[], code: number | undefined): T {
  const name = names[code ?? -1];
  if (name === undefined)
    throw new Error(`The core sent the unknown code ${code}; one of ${names.join(', ')} was expected.`);
  return name;
}

function chunks(values: Float64Array, stride: number): number[][] {
  if (values.length % stride !== 0) {
    throw new Error(`The core sent ${values.length} values in groups of ${stride}.`);
  }
  return Array.from({ length: values.length / stride }, (_, index) =>
    Array.from(values.subarray(index * stride, (index + 1) * stride)),
  );
}
