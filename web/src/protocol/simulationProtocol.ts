/**
 * What the page and the worker that owns the simulation say to each other.
 *
 * Everything is in SI units and radians. World frame: x east, y north, z up. Robot frame: x forward, y left, z up.
 * Pitch is positive nose-up, roll positive with the left side up. Azimuths are positive to the robot's left.
 */

import type { Experiment, Stroke, Terrain } from '../experiment/experiment.ts';
import type { Overrides } from '../experiment/overrides.ts';
import type { ParameterGroup } from '../experiment/parameters.ts';
import type { Heading, Place } from '../experiment/place.ts';
import type { Setting, Setup } from '../experiment/setting.ts';

/** How a trial stands: `running`, or how it ended. */
export type Outcome = 'running' | 'reached' | 'tilt_limit' | 'stuck' | 'no_subgoal' | 'left_terrain' | 'timeout';

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
  /** Driven to one after the other, before the goal. */
  readonly waypoints: readonly Place[];
  readonly goal: Place;
  /** Time between two ticks. */
  readonly period_s: number;
  /** Every parameter, with the value that holds unless it is overridden. */
  readonly parameters: readonly ParameterGroup[];
  readonly overrides: Overrides;
  readonly limits: { readonly roll_rad: number; readonly pitch_rad: number };
  /** Radius of the occupancy surface: what lies farther is not looked at. */
  readonly occupancy_radius_m: number;
  /** The sensor's height above the ground contact, along the body's z axis. */
  readonly sensor_height_m: number;
  /** Lattice of the predicted surfaces; the observed one has a row for each ring of the sensor. */
  readonly image: { readonly columns: number; readonly rows: number; readonly rings: number };
  /** What a segment must be to carry subgoals. */
  readonly demands: SegmentDemands;
}

export interface SegmentDemands {
  /** Wider than the robot's width and the margin on it together. */
  readonly robot_width_m: number;
  readonly safety_margin_m: number;
  /** The skyline no higher and no lower than this, seen from the sensor's foot. */
  readonly max_slope_rad: number;
  /** Whether columns without a return may carry subgoals, on ground that earlier scans saw. */
  readonly subgoals_on_unknown: boolean;
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

/** Why a forecast ends where it does: at the end of the path, before ground that tilts too far, or before ground never seen. */
export const REACH_ENDS = ['whole', 'tilt', 'unseen'] as const;
export type ReachEnd = (typeof REACH_ENDS)[number];

/** What the planned path to a subgoal promises, from the ground that earlier scans saw. */
export interface Forecast {
  readonly reach_m: number;
  /** Mean of (tilt / limit)² over the reach. */
  readonly mean_risk: number;
  readonly max_roll_rad: number;
  readonly max_pitch_rad: number;
  readonly end: ReachEnd;
}

/** A place where the robot could go next: on the skyline, the committed target, a frontier, or the goal itself once it is in sight. */
export interface Subgoal {
  readonly azimuth_rad: number;
  readonly elevation_rad: number;
  /** World frame. */
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly chosen: boolean;
  readonly refusal: Refusal;
  /** Index of its segment in the frame; nothing for the goal itself, the committed target and frontiers. */
  readonly segment: number | undefined;
  /** Nothing where the cost judges steepness by the paper's height alone. */
  readonly forecast: Forecast | undefined;
  /** Weighted cost terms, in the order of `TERMS`; nothing for the refused and for the goal itself. */
  readonly terms: readonly number[] | undefined;
  /** Sum of the terms; NaN without them. */
  readonly total: number;
}

/** Names of the cost terms. The paper has the first three. */
export const TERMS = ['direction', 'distance', 'steepness', 'commitment', 'correction'] as const;

/** What the planner does at present. */
export type Activity = 'driving' | 'arrived' | 'retreating' | 'looking' | 'stopped';

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
  /** Observed occupancy in metres, azimuth-major, a value for each ring, NaN without a return. */
  readonly observed: Float32Array<ArrayBuffer>;
  /** Predicted occupancy in metres, azimuth-major: column 0 looks backwards (-π), row 0 is the lowest. */
  readonly occupancy: Float32Array<ArrayBuffer>;
  /** Predictive variance as a share of the prior's, on the same lattice. */
  readonly variance: Float32Array<ArrayBuffer>;
  /** Elevation of the skyline in each column, in radians; NaN where there is none. */
  readonly profile: Float32Array<ArrayBuffer>;
  /** Index into `COLUMN_KINDS` for each column. */
  readonly kinds: Uint8Array<ArrayBuffer>;
}

/** Hands a frame's arrays over instead of copying them. */
export function transferables(buffers: FrameBuffers): ArrayBuffer[] {
  return Object.values(buffers).map((array: FrameBuffers[keyof FrameBuffers]) => array.buffer);
}

/** Where in time one can go, in ticks. */
export interface Timeline {
  readonly first: number;
  readonly end: number;
  /** Where the route was changed. */
  readonly changes: readonly number[];
}

export const TIMELINE_START: Timeline = { first: 0, end: 0, changes: [] };

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
  /** Where the scan was taken: the sensor's position, then the directions of its x, y and z axes, in the world. */
  readonly world_from_sensor: Float64Array;
  /** Whether the surfaces in `buffers` are this tick's; otherwise nobody watches them, or they are not due again yet. */
  readonly surfaces: boolean;
  /** Share of the prior variance above which space counts as free. */
  readonly threshold: number;
  readonly segments: readonly Segment[];
  readonly subgoals: readonly Subgoal[];
  /** The planned path to the chosen one, from where the robot stands: x, y and whether in reverse (0 or 1) for each place; may be empty. */
  readonly way: Float64Array;
  readonly metrics: Metrics;
  /** Duration of the planner's last step. */
  readonly planner_ms: number;
  /** Digest of the whole trajectory so far; the command line prints the same one. */
  readonly digest: string;
  readonly buffers: FrameBuffers;
  /** x, y, z after each tick since the frame before; after a jump in time, since the beginning. */
  readonly path: Float32Array<ArrayBuffer>;
  /** The ticks since the frame before, as rows of the record (record.ts). */
  readonly rows: Float64Array<ArrayBuffer>;
  /** Whether `path` takes the place of all before: after a jump in time or a new start. */
  readonly anew: boolean;
  /** After a jump back: x, y, z of what came next. */
  readonly ahead: Float32Array<ArrayBuffer> | undefined;
  readonly timeline: Timeline;
  readonly waypointsPassed: number;
}

/** Simulated seconds per second; `Infinity` is as fast as it goes. */
export type Speed = number;

/** A file by its name. */
export interface NamedFile {
  readonly name: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

/** What an experiment is loaded from: a scenario of the catalogue, a document, a terrain without start and goal, or files. */
export type Source =
  | { readonly scenario: string; readonly setup: Setup; readonly seed: number | undefined }
  | { readonly experiment: Experiment }
  | { readonly terrain: Terrain; readonly name: string; readonly setup: Setup }
  | { readonly files: readonly NamedFile[]; readonly setup: Setup };

/** The parts of the page's address that say what to begin with. */
export interface Address {
  readonly hash: string;
  readonly search: string;
}

/** What the page began with. */
export interface Beginning {
  readonly from: 'link' | 'address' | 'last visit' | 'catalogue';
  /** Where somebody left off. */
  readonly own: Experiment | undefined;
  /** Why that cannot be read, where it cannot. */
  readonly unread: string | undefined;
}

export type Command =
  /** Loads and drives what the page begins with; answered with a `Beginning`. */
  | { type: 'begin'; address: Address }
  /** With `play`, it drives at once; otherwise it does so if what was there before did. */
  | { type: 'load'; source: Source; play: boolean }
  | { type: 'restart' }
  | { type: 'play'; playing: boolean }
  | { type: 'speed'; speed: Speed }
  | { type: 'step' }
  | { type: 'goal'; goal: Place; waypoints: readonly Place[] }
  /** Begins anew with these overrides in place of all others, on the same ground and route. */
  | { type: 'parameters'; overrides: Overrides; seed: number | undefined }
  /** Goes to a tick of the timeline and stays there. */
  | { type: 'seek'; tick: number }
  | { type: 'start'; start: Heading }
  | { type: 'sculpt'; stroke: Stroke }
  /** Puts heights back; answered like a stroke. */
  | { type: 'replace'; patch: GroundPatch }
  /** Answered with the ground of a terrain, coarsely, as a `Ground`. */
  | { type: 'preview'; terrain: Terrain }
  /** Answered with the files that `mapless run` reads, as a list of `NamedFile`. */
  | { type: 'export'; experiment: Experiment }
  /** Whether anything shows the surfaces: predicting them costs more than the decision itself. */
  | { type: 'watch'; surfaces: boolean }
  | { type: 'hidden'; hidden: boolean };

/** What is new after a load. */
export interface Loaded {
  readonly ground: Ground;
  readonly experiment: Experiment;
  /** The scenario that it is named after, as that comes; nothing where there is none. */
  readonly scenario: Experiment | undefined;
}

/** From the page. A request is answered by `done` or `failed` with its `id`; a frame's buffers come back for reuse. */
export type ToSimulation =
  | { type: 'request'; id: number; command: Command }
  | { type: 'recycle'; buffers: FrameBuffers };

/** From the worker. */
export type FromSimulation =
  /** Its thread runs: whatever keeps the page busy, the core loads beside it. */
  | { type: 'started' }
  /** The core is there, and opens what this request asks for. */
  | { type: 'opening'; id: number }
  | { type: 'session'; info: SessionInfo; loaded: Loaded | undefined }
  | { type: 'frame'; frame: Frame }
  | { type: 'ground'; patch: GroundPatch }
  | { type: 'done'; id: number; value: unknown }
  | { type: 'failed'; id: number | undefined; message: string; panicked: boolean };
