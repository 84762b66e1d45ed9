/** Moves the drawn robot evenly from tick to tick: ticks come ten times a second, pictures up to sixty. */

import { wrap } from '../base/format.ts';
import type { Pose } from '../protocol/simulationProtocol.ts';

/** A longer move within one tick is no drive but a new start. */
const JUMP_M = 3;

export class Glide {
  #from: Pose | undefined;
  #to: Pose | undefined;
  #began_ms = 0;
  #span_ms = 0;

  /** Heads for a new pose, to be there after `span_ms`. */
  to(pose: Pose, now_ms: number, span_ms: number): void {
    const here = this.at(now_ms);
    const jump = !here || Math.hypot(pose.x - here.x, pose.y - here.y) > JUMP_M;
    this.#from = jump ? pose : here;
    this.#to = pose;
    this.#began_ms = now_ms;
    this.#span_ms = span_ms;
  }

  /** Forgets where it was: the next pose is there at once. */
  reset(): void {
    this.#from = undefined;
    this.#to = undefined;
  }

  at(now_ms: number): Pose | undefined {
    const [from, to] = [this.#from, this.#to];
    if (!from || !to) return undefined;
    const t = this.#span_ms > 0 ? Math.min((now_ms - this.#began_ms) / this.#span_ms, 1) : 1;
    if (t >= 1) return to;
    const mix = (a: number, b: number) => a + (b - a) * t;
    return {
      x: mix(from.x, to.x),
      y: mix(from.y, to.y),
      z: mix(from.z, to.z),
      roll: mix(from.roll, to.roll),
      pitch: mix(from.pitch, to.pitch),
      yaw: from.yaw + wrap(to.yaw - from.yaw) * t,
    };
  }
}
