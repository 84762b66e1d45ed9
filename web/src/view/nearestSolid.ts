/** Which object is under the pointer. */

import type { Vector } from '../ground/heightField.ts';
import type { Solid } from '../protocol/simulationProtocol.ts';

/** The object that a ray meets first, with `room` metres around each shape for each metre of its distance. */
export function nearestSolid(
  solids: readonly Solid[],
  origin: Vector,
  direction: Vector,
  room: number,
): number | undefined {
  let nearest_m = Number.POSITIVE_INFINITY;
  let best: number | undefined;
  // What is met without the room comes before all that is met within it.
  for (const share of [0, room]) {
    if (best !== undefined) break;
    for (const solid of solids) {
      const along_m = meets(solid, origin, direction, share);
      if (along_m < nearest_m) [best, nearest_m] = [solid.object, along_m];
    }
  }
  return best;
}

/** Where on the ground plane shapes are on average. */
export function middle(solids: readonly Solid[]): Vector | undefined {
  if (solids.length === 0) return undefined;
  const mean = (axis: 0 | 1 | 2) => solids.reduce((sum, { centre_m }) => sum + centre_m[axis], 0) / solids.length;
  return { x: mean(0), y: mean(1), z: mean(2) };
}

/** How far along the ray its box begins; infinity where the ray passes it. */
function meets(solid: Solid, origin: Vector, direction: Vector, room: number): number {
  const { centre_m, size_m, sin_cos_yaw } = solid;
  const [sin, cos] = sin_cos_yaw;
  const own = (x: number, y: number): [number, number] => [x * cos + y * sin, y * cos - x * sin];
  const from = [origin.x - centre_m[0], origin.y - centre_m[1], origin.z - centre_m[2]] as const;
  const more_m = room * Math.hypot(...from);
  const start = [...own(from[0], from[1]), from[2]];
  const along = [...own(direction.x, direction.y), direction.z];
  let [enter, leave] = [0, Number.POSITIVE_INFINITY];
  for (const axis of [0, 1, 2] as const) {
    const half_m = size_m[axis] / 2 + more_m;
    const [at, step] = [start[axis] ?? 0, along[axis] ?? 0];
    if (Math.abs(step) < 1e-12) {
      if (Math.abs(at) > half_m) return Number.POSITIVE_INFINITY;
      continue;
    }
    const [a, b] = [(-half_m - at) / step, (half_m - at) / step];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave ? enter : Number.POSITIVE_INFINITY;
}
