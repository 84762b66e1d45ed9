/** One loaded scenario in the wasm core, as the plain data of the protocol. Runs in the worker. */

import { terrainFile } from './catalogue.ts';
import {
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
  type Segment,
  type SessionInfo,
  type Subgoal,
  VERDICTS,
} from './protocol.ts';
import type { CoreModule, CoreSession } from './wasm.ts';

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
  'prior_variance',
  'distance_m',
  'max_abs_roll_rad',
  'max_abs_pitch_rad',
  'mean_vibration_rad_s',
  'mean_elevation_rate_cm_s',
  'curvature_change_rad_m',
  'planner_ms',
] as const;
type Status = Record<(typeof STATUS)[number], number>;

const SEGMENT_STRIDE = 6;
const SUBGOAL_STRIDE = 7;
/** All beams of a full scan: 16 rings × 1800 azimuths. */
const MAX_RETURNS = 28_800;

export class Session {
  readonly #core: CoreSession;
  readonly #pool: FrameBuffers[] = [];
  #info: SessionInfo;

  private constructor(core: CoreSession, scenario: string, preset: Preset) {
    this.#core = core;
    this.#info = { ...JSON.parse(core.info()), scenario, preset };
  }

  static async open(core: CoreModule, scenario: string, preset: Preset, seed: number | undefined): Promise<Session> {
    const toml = await terrainFile(`scenarios/${scenario}.toml`);
    const path = core.terrain_of(toml);
    const terrain = new TextEncoder().encode(await terrainFile(`scenarios/${path}`));
    return new Session(new core.Session(toml, path, terrain, preset, seed), scenario, preset);
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
  }

  setGoal(goal: Place): void {
    this.#core.set_goal(goal.x, goal.y);
    this.#info = { ...this.#info, goal };
  }

  setStart(start: Heading): void {
    this.#core.set_start(start.x, start.y, start.heading_rad);
    this.#info = { ...this.#info, start };
  }

  sculpt(brush: Brush): GroundPatch {
    const [column = 0, row = 0, columns = 0, rows = 0] = this.#core.sculpt(
      brush.x,
      brush.y,
      brush.radius_m,
      brush.strength_m,
      brush.kind,
    );
    return { column, row, columns, rows, heights_m: own(this.#core.heights(column, row, columns, rows)) };
  }

  tick(): boolean {
    return this.#core.tick();
  }

  status(): Status {
    return decodeStatus(this.#core.status());
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
    core.variance(buffers.variance);
    core.profile(buffers.profile);
    core.kinds(buffers.kinds);
    const { x, y, z, roll, pitch, yaw } = status;
    return {
      tick: status.tick,
      time_s: status.time_s,
      outcome: this.outcome,
      reason: core.reason(),
      pose: { x, y, z, roll, pitch, yaw },
      v_m_s: status.v_m_s,
      omega_rad_s: status.omega_rad_s,
      command: { v_m_s: status.command_v_m_s, omega_rad_s: status.command_omega_rad_s },
      returns,
      threshold: status.threshold,
      prior_variance: status.prior_variance,
      segments: decodeSegments(core.segments()),
      subgoals: decodeSubgoals(core.subgoals(), this.#info.terms.length, (index) => core.refusal(index)),
      metrics: {
        distance_m: status.distance_m,
        max_abs_roll_rad: status.max_abs_roll_rad,
        max_abs_pitch_rad: status.max_abs_pitch_rad,
        mean_vibration_rad_s: status.mean_vibration_rad_s,
        mean_elevation_rate_cm_s: status.mean_elevation_rate_cm_s,
        curvature_change_rad_m: status.curvature_change_rad_m,
      },
      planner_ms: status.planner_ms,
      digest: core.digest(),
      buffers,
      path,
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

export function decodeStatus(values: Float64Array): Status {
  if (values.length !== STATUS.length) {
    throw new Error(`The core sent ${values.length} status values; the page expects ${STATUS.length}.`);
  }
  return Object.fromEntries(STATUS.map((name, index) => [name, values[index]])) as Status;
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

export function decodeSubgoals(values: Float64Array, terms: number, refusal: (index: number) => string): Subgoal[] {
  return chunks(values, SUBGOAL_STRIDE + terms).map((chunk, index) => {
    const [azimuth_rad = 0, elevation_rad = 0, x = 0, y = 0, z = 0, total = 0, chosen = 0] = chunk;
    return {
      azimuth_rad,
      elevation_rad,
      x,
      y,
      z,
      total,
      chosen: chosen === 1,
      terms: chunk.slice(SUBGOAL_STRIDE),
      refused: refusal(index),
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
