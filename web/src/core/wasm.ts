/**
 * The face of the wasm core (`crate/wasm`). wasm-bindgen generates the module, and this is the part that the page
 * relies on: `load` fails to compile when the two disagree.
 */

export interface CoreSession {
  free(): void;
  /** What does not change between ticks, as the JSON of a `SessionInfo` without names of files. */
  info(): string;
  columns(): number;
  rows(): number;
  cell_m(): number;
  /** A rectangle of the height field, row by row from the south-west. */
  heights(column: number, row: number, columns: number, rows: number): Float32Array;
  /** Back to the start, with the ground, the start and the goal as they are now. */
  restart(): void;
  set_goal(x: number, y: number): void;
  set_start(x: number, y: number, heading_rad: number): void;
  /** Returns column, row, columns and rows of the rectangle that changed. */
  sculpt(x: number, y: number, radius_m: number, strength_m: number, kind: string): Uint32Array;
  /** One planning tick; returns whether the trial still runs. */
  tick(): boolean;
  /** Scalars in the order of `STATUS` in session.ts. */
  status(): Float64Array;
  outcome(): string;
  reason(): string;
  digest(): string;
  /** Fills `out` with world-frame returns and returns how many points it wrote. */
  points(out: Float32Array): number;
  variance(out: Float32Array): void;
  profile(out: Float32Array): void;
  kinds(out: Uint8Array): void;
  /** `SEGMENT_STRIDE` numbers for each segment. */
  segments(): Float64Array;
  /** `SUBGOAL_STRIDE` numbers and then one for each cost term, for each subgoal. */
  subgoals(): Float64Array;
  /** Why subgoal `index` was refused; empty when it was not. */
  refusal(index: number): string;
}

export interface CoreModule {
  Session: new (
    scenario_toml: string,
    terrain_name: string,
    terrain: Uint8Array,
    preset: string,
    seed: number | undefined,
  ) => CoreSession;
  /** The terrain file that a scenario names, relative to the scenario's own folder. */
  terrain_of(scenario_toml: string): string;
}

/** Compiles and starts the core. */
export async function loadCore(): Promise<CoreModule> {
  const core = await import('../wasm/mapless_wasm.js');
  await core.default();
  return core;
}
