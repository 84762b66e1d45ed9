/** Where the LiDAR is on the robot. */

import type { Vector } from '../ground/heightField.ts';
import type { Pose } from '../protocol/simulationProtocol.ts';

/** The sensor in the world, `height_m` above the ground contact along the body's z axis. */
export function sensorAt(pose: Pose, height_m: number): Vector {
  const [sr, cr, sp, cp] = [Math.sin(pose.roll), Math.cos(pose.roll), Math.sin(pose.pitch), Math.cos(pose.pitch)];
  const [sy, cy] = [Math.sin(pose.yaw), Math.cos(pose.yaw)];
  // The body's z axis in the world: nose-up pitch tips it backwards, left-up roll tips it to the right.
  const [forward, left] = [-sp * cr, -sr];
  return {
    x: pose.x + height_m * (forward * cy - left * sy),
    y: pose.y + height_m * (forward * sy + left * cy),
    z: pose.z + height_m * cp * cr,
  };
}
