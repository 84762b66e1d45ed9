/** Trials on one course, as plain data. Runs in the worker. */

import type { TrialsModule } from '../bindings/trialsModule.ts';
import { withOverride } from '../experiment/overrides.ts';
import { scenarioFile } from '../experiment/scenarioFiles.ts';
import type { Metrics } from '../protocol/simulationProtocol.ts';
import { METRICS } from '../run/columns.ts';
import type { Runner as CoreRunner, Ground, GuestRunner } from '../wasm/mapless_wasm_baselines.js';
import { type Course, type Rider, rowOf, type Summary, type TrialResult } from './trialsProtocol.ts';

export class Runner {
  readonly #name: string;
  readonly #seed: number;
  readonly #core: CoreRunner;
  running = true;

  constructor(core: CoreRunner, name: string, seed: number) {
    [this.#core, this.#name, this.#seed] = [core, name, seed];
  }

  tick(): void {
    this.running = this.#core.tick();
  }

  /** The values of `ROW`, now. */
  get row(): number[] {
    return rowOf(this.#core.status());
  }

  get result(): TrialResult {
    const { tick, time_s, metrics, outcome } = this.#core.status();
    return { planner: this.#name, seed: this.#seed, outcome, tick, time_s, metrics, digest: this.#core.digest() };
  }

  free(): void {
    this.#core.free();
  }
}

/** Makes runners on a course. */
export class RunnerFactory {
  readonly #module: TrialsModule;
  readonly #ground: Ground;
  readonly #scenario: string;
  readonly #course: Course;

  constructor(module: TrialsModule, course: Course) {
    const { columns, rows, cell_m, heights_m } = course.ground;
    this.#module = module;
    this.#ground = new module.Ground(columns, rows, cell_m, heights_m);
    // Planner, seed and ground are given apart from the file.
    this.#scenario = scenarioFile({ ...course, seed: 0, preset: 'default', overrides: {} }, 'terrain.toml');
    this.#course = course;
  }

  runner({ name, planner, learning, overrides }: Rider, seed: number): Runner {
    const options = {
      scenario: this.#scenario,
      overrides: withOverride(overrides, 'planner.perception.learning', 'mode', learning),
      planner,
      seed,
    };
    return new Runner(new this.#module.Runner(this.#ground, options), name, seed);
  }

  /** A trial for a planner that is asked. */
  guest(seed: number): GuestRunner {
    const { overrides } = this.#course;
    return new this.#module.GuestRunner(this.#ground, { scenario: this.#scenario, overrides, seed });
  }
}

/** What many trials show together. The formulas are those of the reports (`mapless_trials::statistics`). */
export function summary(module: TrialsModule, results: readonly TrialResult[]): Summary {
  const reached = results.filter(({ outcome }) => outcome === 'reached');
  const over = (key: keyof Metrics) =>
    module.mean_and_deviation(new Float64Array(reached.map(({ metrics }) => metrics[key])));
  return {
    reached: reached.length,
    trials: results.length,
    ...module.wilson(reached.length, results.length),
    metrics: Object.fromEntries(METRICS.map((key) => [key, over(key)])) as unknown as Summary['metrics'],
  };
}
