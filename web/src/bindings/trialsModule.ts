/** The face of the wasm module with all planners and generated tasks (`crate/wasm-baselines`). Loaded in a worker, when it is wanted. */

export interface WasmGround {
  free(): void;
  [Symbol.dispose](): void;
}

export interface WasmRunner {
  free(): void;
  /** One tick; whether the trial goes on. */
  tick(): boolean;
  outcome(): string;
  /** Tick, time, pose, metrics: see `ROW` in protocol.ts. */
  status(): Float64Array;
  digest(): string;
}

export interface TrialsModule {
  Ground: new (columns: number, rows: number, cell_m: number, heights_m: Float32Array) => WasmGround;
  Runner: new (
    ground: WasmGround,
    scenario_file: string,
    scenario_toml: string,
    parameters: string,
    planner: string,
    seed: bigint,
  ) => WasmRunner;
  /** The scenario file of a generated task, and the recipe that it names `terrain.toml`. */
  generated_task(name: string): string[];
  wilson(successes: number, trials: number): Float64Array;
  mean_and_deviation(values: Float64Array): Float64Array;
}

export async function loadTrials(): Promise<TrialsModule> {
  const module = await import('../wasm/mapless_wasm_baselines.js');
  await module.default();
  return module;
}
