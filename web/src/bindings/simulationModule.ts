/**
 * The face of the wasm core (`crate/wasm`). wasm-bindgen generates the module, and this is the part that the page
 * relies on: `load` fails to compile when the two disagree.
 */

export interface CoreSession {
  free(): void;
  seed(): bigint;
  /** Scalars in the order of `SCENE` in decode.ts, then x and y of each waypoint. */
  scene(): Float64Array;
  columns(): number;
  rows(): number;
  cell_m(): number;
  /** A rectangle of the height field, row by row from the south-west. */
  heights(column: number, row: number, columns: number, rows: number): Float32Array;
  restart(): void;
  set_start(x: number, y: number, heading_rad: number): void;
  /** The goal, with x and y of each waypoint before it. */
  set_route(waypoints: Float64Array, x: number, y: number): void;
  /** Begins anew with the sections `[planner]`, `[sensor]` and `[robot]` of a scenario file, and another seed if given. */
  set_parameters(sections: string, seed?: bigint | null): void;
  /** JSON: a list of `ParameterGroup`. */
  parameters(): string;
  /** Goes back to this tick, or to a little before it. */
  go_back(tick: bigint): void;
  /** First and last tick that can be gone to, then those at which the route was changed. */
  timeline(): Float64Array;
  /** Applies the keys of a `[[stroke]]`; column, row, columns and rows of the rectangle that changed. */
  sculpt(stroke: string): Uint32Array | undefined;
  /** Puts heights, row by row from the south-west, in place of those in a rectangle of so many columns. */
  replace_ground(column: number, row: number, columns: number, heights_m: Float32Array): void;
  /** A tick is `look`, `plan`, `act`; the last returns whether the trial goes on. */
  look(): void;
  plan(): void;
  act(): boolean;
  /** The present tick as a row of the record, without the durations; between `plan` and `act`. */
  row(): Float64Array;
  /** Scalars in the order of `STATUS` in decode.ts. */
  status(): Float64Array;
  outcome(): string;
  activity(): string;
  stop_reason(): string | undefined;
  digest(): string;
  /** Fills `out` with world-frame returns and returns how many points it wrote. */
  points(out: Float32Array): number;
  /** Position and axes of the sensor at the last scan, in the world. */
  world_from_sensor(): Float64Array;
  /** Predicts both surfaces of the Gaussian process. */
  surfaces(occupancy_out: Float32Array, variance_out: Float32Array): void;
  observed(out: Float32Array): void;
  profile(out: Float32Array): void;
  kinds(out: Uint8Array): void;
  /** Six numbers for each segment. */
  segments(): Float64Array;
  /** x, y and whether in reverse for each place on the way to the chosen subgoal. */
  way(): Float64Array;
  /** Thirteen numbers and then one for each cost term, for each subgoal. */
  subgoals(): Float64Array;
}

export interface CoreModule {
  Session: new (
    scenario_file: string,
    scenario_toml: string,
    terrain_file: string,
    terrain: Uint8Array,
    imported: Uint8Array,
    preset: string,
    learning?: string | null,
    seed?: bigint | null,
  ) => CoreSession;
  /** A scenario file as plain data: `ScenarioRead` in opening.ts. */
  read_scenario(file: string, text: string): object;
  generated_recipe(difficulty: string, seed: number): string;
  /** x, y, x, y of a start and a goal on level ground. */
  level_places(file: string, terrain: Uint8Array, imported: Uint8Array): Float64Array;
  /** Columns, rows and spacing of a coarse grid, and its heights. */
  terrain_preview(file: string, terrain: Uint8Array, imported: Uint8Array, most: number): Float32Array;
}

/** Compiles and starts the core. */
export async function loadCore(): Promise<CoreModule> {
  try {
    // The wasm is fetched beside the module that starts it, not after it.
    const [core, file] = await Promise.all([
      import('../wasm/mapless_wasm.js'),
      fetch(new URL('../wasm/mapless_wasm_bg.wasm', import.meta.url)),
    ]);
    await core.default({ module_or_path: file });
    return core;
  } catch (cause) {
    const why = cause instanceof Error ? cause.message : String(cause);
    throw new Error(`The simulation could not be loaded; reload the page to try again. (${why})`, { cause });
  }
}

/** What a panic in the core left behind; a trap by itself says nothing. */
export function panicMessage(): string | undefined {
  return (globalThis as { maplessPanic?: string }).maplessPanic;
}
