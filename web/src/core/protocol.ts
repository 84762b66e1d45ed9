/**
 * What the page and the worker that owns the simulation say to each other.
 *
 * Everything is in SI units and radians. World frame: x east, y north, z up. Robot frame: x forward, y left, z up.
 * Pitch is positive nose-up, roll positive with the left side up. Azimuths are positive to the robot's left.
 */

/** How a trial stands: `running`, or how it ended. */
export type Outcome = 'running' | 'reached' | 'tilt_limit' | 'stuck' | 'no_subgoal' | 'left_terrain' | 'timeout';

/** `default` is the best mapless planner known to the project, `paper` the literal text of the paper. */
export type Preset = 'default' | 'paper';

/** When the planner learns the hyperparameters of its Gaussian process. */
export type Learning = 'fixed' | 'once' | 'every_scan';

/** How the planner is set up. */
export interface Setting {
  readonly preset: Preset;
  readonly learning: Learning;
}

export type BrushKind = 'raise' | 'lower' | 'smooth';

/** One dab of the sculpting brush, centred on a point of the ground. */
export interface Brush {
  readonly x: number;
  readonly y: number;
  readonly radius_m: number;
  /** The largest change of a height, reached at the centre. */
  readonly strength_m: number;
  readonly kind: BrushKind;
}

export interface Place {
  readonly x: number;
  readonly y: number;
}

export interface Heading extends Place {
  /** Counter-clockwise from east, in radians. */
  readonly heading_rad: number;
}

/** A regular grid of heights; row 0 is the southern edge, column 0 the western one. */
export interface Ground {
  readonly columns: number;
  readonly rows: number;
  readonly cell_m: number;
  /** `rows × columns` heights in metres. */
  readonly heights_m: Float32Array<ArrayBuffer>;
}

/** New heights of a rectangle of the grid, row by row from its south-western corner. */
export interface GroundPatch {
  readonly column: number;
  readonly row: number;
  readonly columns: number;
  readonly rows: number;
  readonly heights_m: Float32Array<ArrayBuffer>;
}

/** What a scenario is made of, after its files were read. */
export interface SessionInfo extends Setting {
  readonly scenario: string;
  readonly seed: number;
  readonly start: Heading;
  readonly goal: Place;
  readonly limits: { readonly roll_rad: number; readonly pitch_rad: number };
  /** Radius of the occupancy surface: what lies farther is not looked at. */
  readonly occupancy_radius_m: number;
  /** The sensor's height above the ground contact, along the body's z axis. */
  readonly sensor_height_m: number;
  /** Lattice of the variance image. */
  readonly image: { readonly columns: number; readonly rows: number };
}

export interface Pose extends Place {
  /** Height of the ground contact under the body's centre. */
  readonly z: number;
  readonly roll: number;
  readonly pitch: number;
  readonly yaw: number;
}

/** What was found in one azimuth column of the variance image. */
export const COLUMN_KINDS = ['ground', 'unknown', 'wall'] as const;
export type ColumnKind = (typeof COLUMN_KINDS)[number];

/** Whether subgoals may stand on a segment, and if not, why. */
export const VERDICTS = ['valid', 'too_narrow', 'too_steep', 'unknown', 'wall'] as const;
export type Verdict = (typeof VERDICTS)[number];

/** A run of neighbouring columns at one level of the skyline. */
export interface Segment {
  readonly begin_rad: number;
  /** At least `begin_rad`; beyond π where the segment crosses the azimuth behind the robot. */
  readonly end_rad: number;
  /** NaN where unknown, and so is the height. */
  readonly elevation_rad: number;
  readonly height_m: number;
  readonly width_m: number;
  readonly verdict: Verdict;
}

/** Why a subgoal is no candidate. */
export const REFUSALS = ['none', 'tilt', 'unseen'] as const;
export type Refusal = (typeof REFUSALS)[number];

/** A place where the robot could go next: on the skyline, or the goal itself once it is in sight. */
export interface Subgoal {
  readonly azimuth_rad: number;
  readonly elevation_rad: number;
  /** World frame. */
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly chosen: boolean;
  readonly refusal: Refusal;
  /** Weighted cost terms, in the order of `TERMS`; nothing for the refused and for the goal itself. */
  readonly terms: readonly number[] | undefined;
  /** Sum of the terms; NaN without them. */
  readonly total: number;
}

/** Names of the cost terms. The paper has the first three. */
export const TERMS = ['direction', 'distance', 'steepness', 'commitment', 'dead_end'] as const;

/** What the planner does at present. */
export type Activity = 'driving' | 'arrived' | 'looking' | 'stopped';

/** The paper's six metrics, with the names that the command line prints. */
export interface Metrics {
  readonly distance_m: number;
  readonly max_abs_roll_rad: number;
  readonly max_abs_pitch_rad: number;
  readonly mean_vibration_rad_s: number;
  readonly mean_elevation_rate_cm_s: number;
  readonly curvature_change_rad_m: number;
}

/** Typed arrays of a frame. They travel to the page and back, so that no tick allocates them anew. */
export interface FrameBuffers {
  /** LiDAR returns in the world frame: x, y, z of `Frame.returns` points. */
  readonly points: Float32Array<ArrayBuffer>;
  /** Predictive variance as a share of the prior's, azimuth-major: column 0 looks backwards (-π), row 0 is the lowest. */
  readonly variance: Float32Array<ArrayBuffer>;
  /** Elevation of the skyline in each column, in radians; NaN where there is none. */
  readonly profile: Float32Array<ArrayBuffer>;
  /** Index into `COLUMN_KINDS` for each column. */
  readonly kinds: Uint8Array<ArrayBuffer>;
}

/** Everything that one planning tick saw, decided and did. At tick 0 there is a scan but no decision yet. */
export interface Frame {
  readonly tick: number;
  readonly time_s: number;
  readonly outcome: Outcome;
  readonly activity: Activity;
  /** Why the planner stopped, where it did. */
  readonly stopReason: string | undefined;
  readonly pose: Pose;
  readonly v_m_s: number;
  readonly omega_rad_s: number;
  readonly command: { readonly v_m_s: number; readonly omega_rad_s: number };
  readonly returns: number;
  /** Share of the prior variance above which space counts as free. */
  readonly threshold: number;
  readonly segments: readonly Segment[];
  readonly subgoals: readonly Subgoal[];
  readonly metrics: Metrics;
  /** Duration of the planner's last step. */
  readonly planner_ms: number;
  /** Digest of the whole trajectory so far; the command line prints the same one. */
  readonly digest: string;
  readonly buffers: FrameBuffers;
  /** x, y, z after each tick since the frame before. */
  readonly path: Float32Array<ArrayBuffer>;
}

/** Ticks per second of simulated time. */
export const TICK_RATE_HZ = 10;

/** Simulated seconds per second; `Infinity` is as fast as it goes. */
export type Speed = number;

export type Command =
  | { type: 'load'; scenario: string; setting: Setting; seed: number | undefined }
  | { type: 'restart' }
  | { type: 'play'; playing: boolean }
  | { type: 'speed'; speed: Speed }
  | { type: 'step' }
  | { type: 'goal'; goal: Place }
  | { type: 'start'; start: Heading }
  | { type: 'sculpt'; brush: Brush }
  | { type: 'hidden'; hidden: boolean };

/** From the page. A request is answered by `done` or `failed` with its `id`; a frame's buffers come back for reuse. */
export type ToWorker = { type: 'request'; id: number; command: Command } | { type: 'recycle'; buffers: FrameBuffers };

/** From the worker. */
export type FromWorker =
  | { type: 'session'; info: SessionInfo; ground: Ground | undefined }
  | { type: 'frame'; frame: Frame }
  | { type: 'ground'; patch: GroundPatch }
  | { type: 'done'; id: number }
  | { type: 'failed'; id: number | undefined; message: string; panicked: boolean };
