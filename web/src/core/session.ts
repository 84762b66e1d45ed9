/** One loaded scenario in the wasm core, as the plain data of the protocol. Runs in the worker. */

import { decodeSegments, decodeSubgoals, named, SCENE, STATUS } from './decode.ts';
import type { Experiment, Stroke } from './experiment.ts';
import { filesOf } from './opening.ts';
import type {
  Activity,
  Frame,
  FrameBuffers,
  Ground,
  GroundPatch,
  Heading,
  Outcome,
  Place,
  SessionInfo,
  Setting,
} from './protocol.ts';
import { strokeKeys } from './toml.ts';
import type { CoreModule, CoreSession } from './wasm.ts';

/** All beams of a full scan: 16 rings × 1800 azimuths. */
const MAX_RETURNS = 28_800;

export class Session {
  readonly #core: CoreSession;
  readonly #name: string;
  readonly #setting: Setting;
  readonly #pool: FrameBuffers[] = [];
  #info: SessionInfo;
  #planner_ms = 0;
  /** Whether the ground has changed since the last scan. */
  #groundChanged = false;

  private constructor(core: CoreSession, { name, preset, learning }: Experiment) {
    this.#core = core;
    this.#name = name;
    this.#setting = { preset, learning };
    this.#info = this.#readInfo();
  }

  static async open(core: CoreModule, experiment: Experiment): Promise<Session> {
    const { preset, learning } = experiment;
    const [scenario, terrain, imported] = await filesOf(core, experiment);
    const text = new TextDecoder().decode(scenario.bytes);
    const grid = imported?.bytes ?? new Uint8Array();
    const session = new core.Session(scenario.name, text, terrain.name, terrain.bytes, grid, preset, learning);
    return new Session(session, experiment);
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

  /** Applies a stroke; returns the new heights of the rectangle that changed, if any. */
  sculpt(stroke: Stroke): GroundPatch | undefined {
    const changed = this.#core.sculpt(strokeKeys(stroke));
    if (!changed) return undefined;
    this.#groundChanged = true;
    const [column = 0, row = 0, columns = 0, rows = 0] = changed;
    return { column, row, columns, rows, heights_m: own(this.#core.heights(column, row, columns, rows)) };
  }

  replaceGround(patch: GroundPatch): void {
    this.#core.replace_ground(patch.column, patch.row, patch.columns, patch.heights_m);
    this.#groundChanged = true;
  }

  /** Looks at new ground while nothing moves. Before the first tick the trial begins anew on it: the run is then that of the document. */
  #lookAgain(): void {
    if (!this.#groundChanged) return;
    this.#groundChanged = false;
    if (this.status().tick === 0) this.#core.restart();
    else this.#core.look();
  }

  tick(): void {
    this.#lookAgain();
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
    this.#lookAgain();
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
      scenario: this.#name,
      ...this.#setting,
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

/** A copy that the page may keep: what the core returns is already outside its memory. */
function own(values: Float32Array): Float32Array<ArrayBuffer> {
  return values as Float32Array<ArrayBuffer>;
}
