/** Trials on one course, as plain data. Runs in the worker. */

import { METRICS } from '../bindings/columns.ts';
import { named } from '../bindings/decode.ts';
import type { TrialsModule, WasmGround, WasmRunner } from '../bindings/trialsModule.ts';
import { sectionsOf, withOverride } from '../experiment/overrides.ts';
import { scenarioFile } from '../experiment/scenarioFiles.ts';
import type { Metrics, Outcome } from '../protocol/simulationProtocol.ts';
import { type Course, ROW, type Summary, standing, type TrialResult } from './trialsProtocol.ts';

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

  /** The values of `ROW`, now. */
  get row(): Float64Array {
    return this.#wasm.status();
  }

  get result(): TrialResult {
    return {
      planner: this.planner,
      seed: this.#seed,
      outcome: this.#wasm.outcome() as Outcome,
      ...standing(named(ROW, this.row)),
      digest: this.#wasm.digest(),
    };
  }

  free(): void {
    this.#wasm.free();
  }
}

/** Makes runners on a course. */
export class RunnerFactory {
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
