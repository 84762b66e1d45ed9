/**
 * The record of a run: one row for each tick, for the plots, the scrubber and the files. A row is the state of the robot
 * when the scan was taken and what the planner decided on it. It grows with the run and is bounded.
 */

import type { Activity, Metrics } from '../protocol/simulationProtocol.ts';
import type { Tick } from '../wasm/mapless_wasm.js';
import { METRICS, MOTION, POSE } from './columns.ts';

/** What a row holds, in its order. */
export const ROW = [
  'tick',
  'time_s',
  ...MOTION,
  'subgoal_x',
  'subgoal_y',
  'activity',
  ...METRICS,
  'scan_ms',
  'planner_ms',
  'motion_ms',
] as const;

export type RowName = (typeof ROW)[number];

/** What `activity` says, by its number. */
export const ACTIVITIES: readonly Activity[] = ['driving', 'arrived', 'searching', 'stopped', 'backtracking'];

/** What is kept of a tick. */
export function rowOf(tick: Tick): number[] {
  return [
    tick.tick,
    tick.time_s,
    ...POSE.map((name) => tick.pose[name]),
    tick.v_m_s,
    tick.omega_rad_s,
    tick.command.v_m_s,
    tick.command.omega_rad_s,
    tick.subgoal?.x ?? Number.NaN,
    tick.subgoal?.y ?? Number.NaN,
    ACTIVITIES.indexOf(tick.activity),
    ...METRICS.map((name) => tick.metrics[name]),
    tick.scan_ms,
    tick.planner_ms,
    tick.motion_ms,
  ];
}

/** An hour of simulated time: 7 MB. */
export const MAX_ROWS = 36_000;
const FIRST_ROWS = 1024;
const STRIDE = ROW.length;
const OFFSET = Object.fromEntries(ROW.map((name, index) => [name, index])) as Record<RowName, number>;

export class RunRecord {
  #values = new Float64Array(FIRST_ROWS * STRIDE);
  #rows = 0;
  #dropped = false;

  get length(): number {
    return this.#rows;
  }

  /** Whether the run was longer than the record: then its beginning is gone. */
  get cut(): boolean {
    return this.#dropped;
  }

  /** The record as it is now. */
  copy(): RunRecord {
    const copy = new RunRecord();
    copy.#values = this.#values.slice();
    copy.#rows = this.#rows;
    copy.#dropped = this.#dropped;
    return copy;
  }

  /** Takes whole rows. A tick that the record already has was run again, which gives the same values. */
  add(rows: Float64Array): void {
    if (rows.length % STRIDE !== 0) throw new Error(`A record of ${rows.length} values was sent in rows of ${STRIDE}.`);
    for (let at = 0; at < rows.length; at += STRIDE) {
      const tick = rows[at] ?? 0;
      const first = this.#rows > 0 ? this.get(0, 'tick') : tick;
      // The beginning of a long run is gone.
      if (tick < first) continue;
      if (tick > first + this.#rows) throw new Error(`Tick ${tick} does not follow the record.`);
      const again = tick < first + this.#rows;
      if (!again) this.#makeRoom();
      this.#values.set(rows.subarray(at, at + STRIDE), (again ? tick - first : this.#rows) * STRIDE);
      if (!again) this.#rows += 1;
    }
  }

  /** Forgets `tick` and all after it: the run goes on otherwise from there. */
  end(tick: number): void {
    this.#rows = this.before(tick);
    if (this.#rows === 0) this.#dropped = false;
  }

  /** How many rows come before `tick`. */
  before(tick: number): number {
    const first = this.#rows > 0 ? this.get(0, 'tick') : 0;
    return Math.min(Math.max(tick - first, 0), this.#rows);
  }

  get(row: number, name: RowName): number {
    return this.#values[row * STRIDE + OFFSET[name]] ?? Number.NaN;
  }

  /** The metrics from the start to this tick; nothing where the record does not have it. */
  metricsAt(tick: number): Metrics | undefined {
    const row = this.#rows > 0 ? tick - this.get(0, 'tick') : -1;
    if (row < 0 || row >= this.#rows) return undefined;
    return Object.fromEntries(METRICS.map((name) => [name, this.get(row, name)])) as unknown as Metrics;
  }

  /** x, y, z of each tick up to this one, and from it on. */
  trailTo(tick: number): { trail: Float32Array<ArrayBuffer>; ahead: Float32Array<ArrayBuffer> } {
    const places = (from: number, to: number) =>
      Float32Array.from({ length: 3 * Math.max(to - from, 0) }, (_, at) =>
        this.get(from + Math.floor(at / 3), POSE[at % 3] ?? 'x'),
      );
    const rows = this.before(tick);
    return { trail: places(0, rows), ahead: places(Math.max(rows - 1, 0), this.#rows) };
  }

  /** The row whose time is nearest to this one; -1 in an empty record. */
  at(time_s: number): number {
    let [low, high] = [0, this.#rows - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.get(middle, 'time_s') < time_s) low = middle + 1;
      else high = middle;
    }
    const earlier = high > 0 && time_s - this.get(high - 1, 'time_s') < this.get(high, 'time_s') - time_s;
    return earlier ? high - 1 : high;
  }

  #makeRoom(): void {
    if (this.#rows * STRIDE < this.#values.length) return;
    if (this.#rows >= MAX_ROWS) {
      // A quarter at a time, so that a long run moves its record seldom.
      const gone = MAX_ROWS / 4;
      this.#values.copyWithin(0, gone * STRIDE, this.#rows * STRIDE);
      this.#rows -= gone;
      this.#dropped = true;
      return;
    }
    const larger = new Float64Array(Math.min(2 * this.#rows, MAX_ROWS) * STRIDE);
    larger.set(this.#values);
    this.#values = larger;
  }
}
