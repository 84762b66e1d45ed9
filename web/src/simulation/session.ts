/** One loaded scenario in the wasm core, as the plain data of the protocol. Runs in the worker. */

import { METRICS, POSE } from '../bindings/columns.ts';
import { decodeSegments, decodeSubgoals, named, only, SCENE, STATUS } from '../bindings/decode.ts';
import type { CoreModule, CoreSession } from '../bindings/simulationModule.ts';
import type { Experiment, Stroke } from '../experiment/experiment.ts';
import { countOverrides, type Overrides, sectionsOf } from '../experiment/overrides.ts';
import type { ParameterGroup } from '../experiment/parameters.ts';
import type { Heading, Place } from '../experiment/place.ts';
import { strokeKeys } from '../experiment/scenarioFiles.ts';
import type { Setting } from '../experiment/setting.ts';
import type {
  Activity,
  Frame,
  FrameBuffers,
  Ground,
  GroundPatch,
  Outcome,
  SessionInfo,
  Timeline,
} from '../protocol/simulationProtocol.ts';
import { filesOf } from './opening.ts';

/** All beams of a full scan: 16 rings × 1800 azimuths. */
const MAX_RETURNS = 28_800;

export class Session {
  readonly #core: CoreSession;
  readonly #name: string;
  readonly #setting: Setting;
  readonly #pool: FrameBuffers[] = [];
  /** The numbers that the present info was read from. */
  #scene: Float64Array = new Float64Array();
  #overrides: Overrides = {};
  #parameters: readonly ParameterGroup[] = [];
  #info: SessionInfo;
  #planner_ms = 0;
  /** Whether the ground has changed since the last scan. */
  #groundChanged = false;

  private constructor(core: CoreSession, { name, preset, learning }: Experiment) {
    this.#core = core;
    this.#name = name;
    this.#setting = { preset, learning };
    this.#readParameters();
    this.#info = this.#readInfo();
  }

  static open(core: CoreModule, experiment: Experiment): Session {
    const { preset, learning, overrides } = experiment;
    // Without the overrides, so that the core knows the defaults, too.
    const [scenario, terrain, imported] = filesOf(core, { ...experiment, overrides: {} });
    const text = new TextDecoder().decode(scenario.bytes);
    const grid = imported?.bytes ?? new Uint8Array();
    const loaded = new core.Session(scenario.name, text, terrain.name, terrain.bytes, grid, preset, learning);
    const session = new Session(loaded, experiment);
    try {
      if (countOverrides(overrides) > 0) session.setOverrides(overrides);
    } catch (error) {
      session.free();
      throw error;
    }
    return session;
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

  setRoute(waypoints: readonly Place[], goal: Place): void {
    this.#core.set_route(new Float64Array(waypoints.flatMap(({ x, y }) => [x, y])), goal.x, goal.y);
    this.#info = this.#readInfo();
  }

  /** Begins anew with these overrides, and another seed if given; the ground, the start and the route stay. */
  setOverrides(overrides: Overrides, seed?: number): void {
    this.#core.set_parameters(sectionsOf(overrides), seed === undefined ? undefined : BigInt(seed));
    this.#overrides = overrides;
    this.#readParameters();
    this.#info = this.#readInfo();
    this.#planner_ms = 0;
  }

  /** Going back in time may bring another route back; says whether it did. */
  followRoute(): boolean {
    const values = this.#core.scene();
    const same = values.length === this.#scene.length && values.every((value, index) => value === this.#scene[index]);
    if (!same) this.#info = this.#readInfo();
    return !same;
  }

  goBack(tick: number): void {
    this.#core.go_back(BigInt(tick));
  }

  get timeline(): Timeline {
    const [first = 0, end = 0, ...changes] = this.#core.timeline();
    return { first, end, changes };
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

  /** Runs one tick and returns its row of the record. */
  tick(): number[] {
    this.#lookAgain();
    const began_ms = performance.now();
    this.#core.look();
    const scanned_ms = performance.now();
    this.#core.plan();
    const planned_ms = performance.now();
    const row = this.#core.row();
    const recorded_ms = performance.now();
    this.#core.act();
    this.#planner_ms = planned_ms - scanned_ms;
    return [...row, scanned_ms - began_ms, this.#planner_ms, performance.now() - recorded_ms];
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

  /** Everything of the present state; the surfaces only on demand, since predicting them takes longer than deciding. */
  frame(since: Pick<Frame, 'path' | 'anew' | 'ahead' | 'rows'>, surfaces: boolean): Frame {
    const core = this.#core;
    this.#lookAgain();
    const status = this.status();
    const buffers = this.#pool.pop() ?? this.#newBuffers();
    const returns = core.points(buffers.points);
    const decided = status.tick > 0;
    if (surfaces && decided) {
      core.observed(buffers.observed);
      core.surfaces(buffers.occupancy, buffers.variance);
    } else if (surfaces) {
      buffers.observed.fill(Number.NaN);
      buffers.occupancy.fill(0);
      buffers.variance.fill(1);
    }
    if (decided) {
      core.profile(buffers.profile);
      core.kinds(buffers.kinds);
    } else {
      buffers.profile.fill(Number.NaN);
      buffers.kinds.fill(0);
    }
    return {
      tick: status.tick,
      time_s: status.time_s,
      outcome: this.outcome,
      activity: core.activity() as Activity,
      stopReason: core.stop_reason(),
      pose: only(POSE, status),
      v_m_s: status.v_m_s,
      omega_rad_s: status.omega_rad_s,
      command: { v_m_s: status.command_v_m_s, omega_rad_s: status.command_omega_rad_s },
      returns,
      world_from_sensor: core.world_from_sensor(),
      surfaces,
      threshold: status.threshold,
      segments: decided ? decodeSegments(core.segments()) : [],
      subgoals: decided ? decodeSubgoals(core.subgoals()) : [],
      way: decided ? core.way() : new Float64Array(),
      metrics: only(METRICS, status),
      planner_ms: this.#planner_ms,
      digest: core.digest(),
      buffers,
      timeline: this.timeline,
      waypointsPassed: status.waypoints_passed,
      ...since,
    };
  }

  #readInfo(): SessionInfo {
    const values = this.#core.scene();
    this.#scene = values;
    const scene = named(SCENE, values.subarray(0, SCENE.length));
    const places = values.subarray(SCENE.length);
    return {
      scenario: this.#name,
      ...this.#setting,
      seed: Number(this.#core.seed()),
      start: { x: scene.start_x, y: scene.start_y, heading_rad: scene.start_heading_rad },
      waypoints: Array.from({ length: places.length / 2 }, (_, at) => ({
        x: places[2 * at] ?? 0,
        y: places[2 * at + 1] ?? 0,
      })),
      goal: { x: scene.goal_x, y: scene.goal_y },
      period_s: scene.period_s,
      parameters: this.#parameters,
      overrides: this.#overrides,
      limits: { roll_rad: scene.roll_limit_rad, pitch_rad: scene.pitch_limit_rad },
      occupancy_radius_m: scene.occupancy_radius_m,
      sensor_height_m: scene.sensor_height_m,
      image: { columns: scene.image_columns, rows: scene.image_rows, rings: scene.image_rings },
      demands: {
        robot_width_m: scene.robot_width_m,
        safety_margin_m: scene.safety_margin_m,
        max_slope_rad: scene.max_slope_rad,
        subgoals_on_unknown: scene.subgoals_on_unknown === 1,
      },
    };
  }

  #readParameters(): void {
    this.#parameters = JSON.parse(this.#core.parameters());
  }

  #newBuffers(): FrameBuffers {
    const { columns, rows, rings } = this.#info.image;
    return {
      points: new Float32Array(3 * MAX_RETURNS),
      observed: new Float32Array(columns * rings),
      occupancy: new Float32Array(columns * rows),
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
