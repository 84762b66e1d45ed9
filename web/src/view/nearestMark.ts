/** Which subgoal or segment is under the pointer. */

import { type Camera, Vector3 } from 'three';
import type { Vector } from '../ground/heightField.ts';
import type { Frame } from '../protocol/simulationProtocol.ts';
import { segmentArc } from '../scene/segmentArc.ts';
import { subgoalTarget, type Target } from '../scene/selection.ts';

interface Shown {
  readonly subgoals: boolean;
  readonly segments: boolean;
  readonly radius_m: number;
  height(x: number, y: number): number;
}

/** Where places of the world are in the window; nothing for those behind the camera. */
export function projector(box: DOMRect, camera: Camera): (place: Vector) => { x: number; y: number } | undefined {
  const at = new Vector3();
  return ({ x, y, z }) => {
    at.set(x, y, z).project(camera);
    if (at.z > 1) return undefined;
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  };
}

/** The nearest of what is shown, subgoals before segments, by a distance in pixels. */
export function nearestMark(
  frame: Frame,
  { subgoals, segments, radius_m, height }: Shown,
  within_px: number,
  away_px: (place: Vector) => number,
): Target | undefined {
  let nearest_px = within_px;
  let best: Target | undefined;
  const consider = (place: Vector, target: Target | undefined) => {
    const px = away_px(place);
    if (px < nearest_px) [best, nearest_px] = [target, px];
  };
  if (subgoals) {
    frame.subgoals.forEach(({ x, y, z }, index) => {
      consider({ x, y, z: Math.max(z, height(x, y) + 0.17) }, subgoalTarget(frame, index));
    });
  }
  if (best || !segments) return best;
  frame.segments.forEach((one, segment) => {
    const arc = segmentArc(one, frame.sensor, radius_m);
    for (let at = 0; at < arc.length; at += 3) {
      const [x = 0, y = 0, z = 0] = arc.slice(at, at + 3);
      consider({ x, y, z }, { subgoal: undefined, segment });
    }
  });
  return best;
}
