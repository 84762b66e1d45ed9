/** Where the LiDAR is on the robot. */

import type { Vector } from '../ground/heightField.ts';
import type { Mount, Pose } from '../protocol/simulationProtocol.ts';

type Offset = Pick<Mount, 'forward_m' | 'left_m' | 'height_m'>;
const ON_THE_GROUND: Offset = { forward_m: 0, left_m: 0, height_m: 0 };

/** The sensor in the world, at this offset along the body's axes from the ground contact. */
export function sensorAt(pose: Pose, { forward_m, left_m, height_m }: Offset = ON_THE_GROUND): Vector {
  const [sr, cr, sp, cp] = [Math.sin(pose.roll), Math.cos(pose.roll), Math.sin(pose.pitch), Math.cos(pose.pitch)];
  const [sy, cy] = [Math.sin(pose.yaw), Math.cos(pose.yaw)];
  // The offset with roll, pitch, yaw: nose-up pitch tips it backwards, left-up roll tips it to the right.
  const [left, up] = [left_m * cr - height_m * sr, left_m * sr + height_m * cr];
  const forward = forward_m * cp - up * sp;
  return {
    x: pose.x + forward * cy - left * sy,
    y: pose.y + forward * sy + left * cy,
    z: pose.z + forward_m * sp + up * cp,
  };
}
