/** One loaded scenario in the wasm core, as the plain data of the protocol. Runs in the worker. */

import { terrainFile } from './catalogue.ts';
import {
  type Activity,
  type Brush,
  COLUMN_KINDS,
  type Frame,
  type FrameBuffers,
  type Ground,
  type GroundPatch,
  type Heading,
  type Outcome,
  type Place,
  type Preset,
  REFUSALS,
  type Segment,
  type SessionInfo,
  type Subgoal,
  TERMS,
  VERDICTS,
} from './protocol.ts';
import type { CoreModule, CoreSession } from './wasm.ts';

/** Order of the scalars in `CoreSession.scene`. */
export const SCENE = [
  'start_x',
  'start_y',
  'start_heading_rad',
  'goal_x',
  'goal_y',
  'roll_limit_rad',
  'pitch_limit_rad',
  'occupancy_radius_m',
  'sensor_height_m',
  'image_columns',
  'image_rows',
] as const;

/** Order of the scalars in `CoreSession.status`. */
export const STATUS = [
  'tick',
  'time_s',
  'x',
  'y',
  'z',
  'roll',
  'pitch',
  'yaw',
  'v_m_s',
  'omega_rad_s',
  'command_v_m_s',
  'command_omega_rad_s',
  'threshold',
  'distance_m',
  'max_abs_roll_rad',
  'max_abs_pitch_rad',
  'mean_vibration_rad_s',
  'mean_elevation_rate_cm_s',
  'curvature_change_rad_m',
] as const;

const SEGMENT_STRIDE = 6;
const SUBGOAL_STRIDE = 7;
/** All beams of a full scan: 16 rings × 1800 azimuths. */
const MAX_RETURNS = 28_800;

export class Session {
  readonly #core: CoreSession;
  readonly #scenario: string;
  readonly #preset: Preset;
  readonly #pool: FrameBuffers[] = [];
  #info: SessionInfo;
  #planner_ms = 0;

  private constructor(core: CoreSession, scenario: string, preset: Preset) {
    this.#core = core;
    this.#scenario = scenario;
    this.#preset = preset;
    this.#info = this.#readInfo();
  }

  static async open(core: CoreModule, scenario: string, preset: Preset, seed: number | undefined): Promise<Session> {
    const file = `scenarios/${scenario}.toml`;
    const toml = await terrainFile(file);
    const path = core.terrain_of(file, toml);
    const terrain = new TextEncoder().encode(await terrainFile(`scenarios/${path}`));
    const whole = seed === undefined ? undefined : BigInt(seed);
    return new Session(new core.Session(file, toml, path, terrain, preset, whole), scenario, preset);
  }

  free(): void {
    this.#core.free();
  }

  get info(): SessionInfo {
    return this.#info;
  }

  ground(): Ground {
    const columns = this.#core.columns();
    const rows = this.#core.rows();
    return { columns, rows, cell_m: this.#core.cell_m(), heights_m: own(this.#core.heights(0, 0, columns, rows)) };
  }

  restart(): void {
    this.#core.restart();
    this.#planner_ms = 0;
  }

  setGoal(goal: Place): void {
    this.#core.set_goal(goal.x, goal.y);
    this.#info = this.#readInfo();
  }

  setStart(start: Heading): void {
    this.#core.set_start(start.x, start.y, start.heading_rad);
    this.#info = this.#readInfo();
    this.#planner_ms = 0;
  }

  /** One dab; returns the new heights of the rectangle that changed, if any. */
  sculpt(brush: Brush): GroundPatch | undefined {
    const { x, y, radius_m, strength_m, kind } = brush;
    const changed = this.#core.sculpt(x, y, radius_m, strength_m, kind);
    if (!changed) return undefined;
    // The next decision sees the new ground anyway; while paused, the scan shows it at once.
    this.#core.look();
    const [column = 0, row = 0, columns = 0, rows = 0] = changed;
    return { column, row, columns, rows, heights_m: own(this.#core.heights(column, row, columns, rows)) };
  }

  tick(): void {
    this.#core.look();
    const began_ms = performance.now();
    this.#core.plan();
    this.#planner_ms = performance.now() - began_ms;
    this.#core.act();
  }

  /** The named scalars of the present state. */
  status() {
    return named(STATUS, this.#core.status());
  }

  get outcome(): Outcome {
    return this.#core.outcome() as Outcome;
  }

  recycle(buffers: FrameBuffers): void {
    const { columns, rows } = this.#info.image;
    if (buffers.variance.length === columns * rows) this.#pool.push(buffers);
  }

  frame(path: Float32Array<ArrayBuffer>): Frame {
    const core = this.#core;
    const status = this.status();
    const buffers = this.#pool.pop() ?? this.#newBuffers();
    const returns = core.points(buffers.points);
    const decided = status.tick > 0;
    if (decided) {
      core.variance(buffers.variance);
      core.profile(buffers.profile);
      core.kinds(buffers.kinds);
    } else {
      buffers.variance.fill(1);
      buffers.profile.fill(Number.NaN);
      buffers.kinds.fill(0);
    }
    const { x, y, z, roll, pitch, yaw } = status;
    return {
      tick: status.tick,
      time_s: status.time_s,
      outcome: this.outcome,
      activity: core.activity() as Activity,
      stopReason: core.stop_reason(),
      pose: { x, y, z, roll, pitch, yaw },
      v_m_s: status.v_m_s,
      omega_rad_s: status.omega_rad_s,
      command: { v_m_s: status.command_v_m_s, omega_rad_s: status.command_omega_rad_s },
      returns,
      threshold: status.threshold,
      segments: decided ? decodeSegments(core.segments()) : [],
      subgoals: decided ? decodeSubgoals(core.subgoals()) : [],
      metrics: {
        distance_m: status.distance_m,
        max_abs_roll_rad: status.max_abs_roll_rad,
        max_abs_pitch_rad: status.max_abs_pitch_rad,
        mean_vibration_rad_s: status.mean_vibration_rad_s,
        mean_elevation_rate_cm_s: status.mean_elevation_rate_cm_s,
        curvature_change_rad_m: status.curvature_change_rad_m,
      },
      planner_ms: this.#planner_ms,
      digest: core.digest(),
      buffers,
      path,
    };
  }

  #readInfo(): SessionInfo {
    const scene = named(SCENE, this.#core.scene());
    return {
      scenario: this.#scenario,
      preset: this.#preset,
      seed: Number(this.#core.seed()),
      start: { x: scene.start_x, y: scene.start_y, heading_rad: scene.start_heading_rad },
      goal: { x: scene.goal_x, y: scene.goal_y },
      limits: { roll_rad: scene.roll_limit_rad, pitch_rad: scene.pitch_limit_rad },
      occupancy_radius_m: scene.occupancy_radius_m,
      sensor_height_m: scene.sensor_height_m,
      image: { columns: scene.image_columns, rows: scene.image_rows },
    };
  }

  #newBuffers(): FrameBuffers {
    const { columns, rows } = this.#info.image;
    return {
      points: new Float32Array(3 * MAX_RETURNS),
      variance: new Float32Array(columns * rows),
      profile: new Float32Array(columns),
      kinds: new Uint8Array(columns),
    };
  }
}

/** Gives the core's scalars their names. */
export function named<Name extends string>(names: readonly Name[], values: Float64Array): Record<Name, number> {
  if (values.length !== names.length) {
    throw new Error(`The core sent ${values.length} numbers; the page expects ${names.length}: ${names.join(', ')}.`);
  }
  return Object.fromEntries(names.map((name, index) => [name, values[index]])) as Record<Name, number>;
}

export function decodeSegments(values: Float64Array): Segment[] {
  return chunks(values, SEGMENT_STRIDE).map(([begin_rad, end_rad, elevation_rad, height_m, width_m, verdict]) => ({
    begin_rad: begin_rad ?? 0,
    end_rad: end_rad ?? 0,
    elevation_rad: elevation_rad ?? 0,
    height_m: height_m ?? 0,
    width_m: width_m ?? 0,
    verdict: at(VERDICTS, verdict),
  }));
}

export function decodeSubgoals(values: Float64Array): Subgoal[] {
  return chunks(values, SUBGOAL_STRIDE + TERMS.length).map((chunk) => {
    const [azimuth_rad = 0, elevation_rad = 0, x = 0, y = 0, z = 0, chosen = 0, refusal = 0] = chunk;
    const terms = chunk.slice(SUBGOAL_STRIDE);
    const total = terms.reduce((sum, term) => sum + term, 0);
    return {
      azimuth_rad,
      elevation_rad,
      x,
      y,
      z,
      chosen: chosen === 1,
      refusal: at(REFUSALS, refusal),
      terms: Number.isNaN(total) ? undefined : terms,
      total,
    };
  });
}

export function kindOf(code: number | undefined): (typeof COLUMN_KINDS)[number] {
  return at(COLUMN_KINDS, code);
}

function at<T>(names: readonly T[], code: number | undefined): T {
  const name = names[code ?? -1];
  if (name === undefined)
    throw new Error(`The core sent the unknown code ${code}; one of ${names.join(', ')} was expected.`);
  return name;
}

function chunks(values: Float64Array, stride: number): number[][] {
  if (values.length % stride !== 0) {
    throw new Error(`The core sent ${values.length} values in groups of ${stride}.`);
  }
  return Array.from({ length: values.length / stride }, (_, index) =>
    Array.from(values.subarray(index * stride, (index + 1) * stride)),
  );
}

/** A copy that the page may keep: what the core returns is already outside its memory. */
function own(values: Float32Array): Float32Array<ArrayBuffer> {
  return values as Float32Array<ArrayBuffer>;
}
