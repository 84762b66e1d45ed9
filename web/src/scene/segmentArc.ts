/** Segments of the skyline as arcs in the world. */

import type { Segment } from '../protocol/simulationProtocol.ts';

const ARC_STEP_RAD = Math.PI / 90;

/** Points of a segment in the world; nothing where its elevation is unknown. */
export function segmentArc(segment: Segment, world_from_sensor: Float64Array, radius_m: number): number[] {
  const { begin_rad, end_rad, elevation_rad } = segment;
  if (Number.isNaN(elevation_rad)) return [];
  const steps = Math.max(1, Math.ceil((end_rad - begin_rad) / ARC_STEP_RAD));
  const flat_m = radius_m * Math.cos(elevation_rad);
  const up_m = radius_m * Math.sin(elevation_rad);
  const arc: number[] = [];
  for (let step = 0; step <= steps; step += 1) {
    const azimuth = begin_rad + ((end_rad - begin_rad) * step) / steps;
    const [ahead_m, left_m] = [flat_m * Math.cos(azimuth), flat_m * Math.sin(azimuth)];
    for (let axis = 0; axis < 3; axis += 1) {
      const part = (index: number) => world_from_sensor[index + axis] ?? 0;
      arc.push(part(0) + ahead_m * part(3) + left_m * part(6) + up_m * part(9));
    }
  }
  return arc;
}
