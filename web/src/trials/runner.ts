/** Trials on one course, as plain data. Runs in the worker. */

import { named } from '../core/decode.ts';
import { sectionsOf, withOverride } from '../core/overrides.ts';
import type { Metrics, Outcome } from '../core/protocol.ts';
import { scenarioFile } from '../core/toml.ts';
import type { Course, Summary, TrialResult } from './protocol.ts';
import type { TrialsModule, WasmGround, WasmRunner } from './wasm.ts';

/** Order of the scalars in `WasmRunner.status`. */
export const RUNNER_STATUS = [
  'tick',
  'time_s',
  'x',
  'y',
  'z',
  'roll',
  'pitch',
  'yaw',
  'distance_m',
  'max_abs_roll_rad',
  'max_abs_pitch_rad',
  'mean_vibration_rad_s',
  'mean_elevation_rate_cm_s',
  'curvature_change_rad_m',
] as const;

const METRICS = RUNNER_STATUS.slice(RUNNER_STATUS.indexOf('distance_m')) as (keyof Metrics)[];

export class Runner {
  readonly planner: string;
  readonly #seed: number;
  readonly #wasm: WasmRunner;
  running = true;

  constructor(wasm: WasmRunner, planner: string, seed: number) {
    this.#wasm = wasm;
    this.planner = planner;
    this.#seed = seed;
  }

  tick(): void {
    this.running = this.#wasm.tick();
  }

  get status() {
    return named(RUNNER_STATUS, this.#wasm.status());
  }

  /** x, y, z, roll, pitch, yaw. */
  get pose(): number[] {
    const { x, y, z, roll, pitch, yaw } = this.status;
    return [x, y, z, roll, pitch, yaw];
  }

  get result(): TrialResult {
    const { status } = this;
    return {
      planner: this.planner,
      seed: this.#seed,
      outcome: this.#wasm.outcome() as Outcome,
      tick: status.tick,
      time_s: status.time_s,
      metrics: Object.fromEntries(METRICS.map((key) => [key, status[key]])) as unknown as Metrics,
      digest: this.#wasm.digest(),
    };
  }

  free(): void {
    this.#wasm.free();
  }
}

/** Makes runners on a course. */
export class Garage {
  readonly #module: TrialsModule;
  readonly #ground: WasmGround;
  readonly #toml: string;
  readonly #sections: string;

  constructor(module: TrialsModule, course: Course) {
    const { columns, rows, cell_m, heights_m } = course.ground;
    this.#module = module;
    this.#ground = new module.Ground(columns, rows, cell_m, heights_m);
    // Planner, seed and ground are given apart from the file.
    this.#toml = scenarioFile({ ...course, seed: 0, preset: 'default', overrides: {} }, 'terrain.toml');
    this.#sections = sectionsOf(withOverride(course.overrides, 'planner.perception.learning', 'mode', course.learning));
  }

  runner(planner: string, seed: number): Runner {
    const [module, file, whole] = [this.#module, 'scenario.toml', BigInt(seed)];
    return new Runner(new module.Runner(this.#ground, file, this.#toml, this.#sections, planner, whole), planner, seed);
  }
}

/** What many trials show together. The formulas are those of the reports (`mapless_trials::statistics`). */
export function summary(module: TrialsModule, results: readonly TrialResult[]): Summary {
  const reached = results.filter(({ outcome }) => outcome === 'reached');
  const [low = 0, high = 1] = module.wilson(reached.length, results.length);
  const over = (key: keyof Metrics): [number, number] => {
    const values = new Float64Array(reached.map(({ metrics }) => metrics[key]));
    const [mean = Number.NaN, deviation = Number.NaN] = module.mean_and_deviation(values);
    return [mean, deviation];
  };
  return {
    reached: reached.length,
    trials: results.length,
    low,
    high,
    metrics: Object.fromEntries(METRICS.map((key) => [key, over(key)])) as unknown as Summary['metrics'],
  };
}
