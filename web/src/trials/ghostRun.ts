/** What is known of one ghost: its rows by tick and how it stands. */

import type { Metrics, Pose } from '../protocol/simulationProtocol.ts';
import { METRICS, POSE } from '../run/columns.ts';
import { ROW, type TrialResult } from './trialsProtocol.ts';

const STRIDE = ROW.length;
const FIRST_TICKS = 512;

export class GhostRun {
  #result: TrialResult;
  #rows = new Float64Array(STRIDE * FIRST_TICKS);
  #ticks = 0;

  constructor(rows: Float64Array, result: TrialResult) {
    this.#result = result;
    this.extend(rows, result);
  }

  /** The newest tick; 0 is the start. */
  get lastTick(): number {
    return this.#ticks - 1;
  }

  extend(rows: Float64Array, result: TrialResult): void {
    const needed = STRIDE * this.#ticks + rows.length;
    if (needed > this.#rows.length) {
      const larger = new Float64Array(Math.max(needed, 2 * this.#rows.length));
      larger.set(this.#rows);
      this.#rows = larger;
    }
    this.#rows.set(rows, STRIDE * this.#ticks);
    this.#ticks += rows.length / STRIDE;
    this.#result = result;
  }

  pose(tick: number): Pose | undefined {
    if (tick < 0 || tick > this.lastTick) return undefined;
    return Object.fromEntries(POSE.map((name) => [name, this.#get(tick, name)])) as unknown as Pose;
  }

  /** How it stood at a tick, or stands now where that is later. */
  at(tick: number): TrialResult {
    if (tick >= this.lastTick) return this.#result;
    const metrics = Object.fromEntries(METRICS.map((name) => [name, this.#get(tick, name)])) as unknown as Metrics;
    return { ...this.#result, outcome: 'running', tick, time_s: this.#get(tick, 'time_s'), metrics };
  }

  #get(tick: number, name: (typeof ROW)[number]): number {
    return this.#rows[STRIDE * tick + ROW.indexOf(name)] ?? Number.NaN;
  }
}
