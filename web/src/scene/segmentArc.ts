/** Segments of the skyline as arcs in the world. */

import type { Segment, SensorPose } from '../protocol/simulationProtocol.ts';

const ARC_STEP_RAD = Math.PI / 90;

/** Points of a segment in the world; nothing where its elevation is unknown. */
export function segmentArc(segment: Segment, sensor: SensorPose, radius_m: number): number[] {
  const { begin_rad, end_rad, elevation_rad } = segment;
  if (elevation_rad === undefined) return [];
  const { position, x_axis, y_axis, z_axis } = sensor;
  const steps = Math.max(1, Math.ceil((end_rad - begin_rad) / ARC_STEP_RAD));
  const flat_m = radius_m * Math.cos(elevation_rad);
  const up_m = radius_m * Math.sin(elevation_rad);
  const arc: number[] = [];
  for (let step = 0; step <= steps; step += 1) {
    const azimuth = begin_rad + ((end_rad - begin_rad) * step) / steps;
    const [ahead_m, left_m] = [flat_m * Math.cos(azimuth), flat_m * Math.sin(azimuth)];
    for (const axis of ['x', 'y', 'z'] as const) {
      arc.push(position[axis] + ahead_m * x_axis[axis] + left_m * y_axis[axis] + up_m * z_axis[axis]);
    }
  }
  return arc;
}
