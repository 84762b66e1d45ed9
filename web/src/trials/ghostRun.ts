/** What is known of one ghost: its poses by tick and how it stands. */

import type { Pose } from '../core/protocol.ts';
import { POSE_STRIDE, type TrialResult } from './protocol.ts';

const FIRST_TICKS = 512;

export class GhostRun {
  result: TrialResult;
  #poses = new Float32Array(POSE_STRIDE * FIRST_TICKS);
  #ticks = 0;

  constructor(poses: Float32Array, result: TrialResult) {
    this.result = result;
    this.extend(poses, result);
  }

  /** The newest tick; 0 is the start. */
  get lastTick(): number {
    return this.#ticks - 1;
  }

  extend(poses: Float32Array, result: TrialResult): void {
    const needed = POSE_STRIDE * this.#ticks + poses.length;
    if (needed > this.#poses.length) {
      const larger = new Float32Array(Math.max(needed, 2 * this.#poses.length));
      larger.set(this.#poses);
      this.#poses = larger;
    }
    this.#poses.set(poses, POSE_STRIDE * this.#ticks);
    this.#ticks += poses.length / POSE_STRIDE;
    this.result = result;
  }

  pose(tick: number): Pose | undefined {
    if (tick < 0 || tick > this.lastTick) return undefined;
    const [x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0] = this.#poses.subarray(
      POSE_STRIDE * tick,
      POSE_STRIDE * (tick + 1),
    );
    return { x, y, z, roll, pitch, yaw };
  }
}
