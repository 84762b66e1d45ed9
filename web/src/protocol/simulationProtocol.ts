/**
 * What the page and the worker that owns the simulation say to each other.
 *
 * Everything is in SI units and radians. World frame: x east, y north, z up. Robot frame: x forward, y left, z up.
 * Pitch is positive nose-up, roll positive with the left side up. Azimuths are positive to the robot's left.
 */

import type { Work } from '../experiment/autosave.ts';
import type { Experiment, Holes, Stroke, Terrain } from '../experiment/experiment.ts';
import type { WorldObject } from '../experiment/objects.ts';
import type { ParameterGroup } from '../experiment/parameters.ts';
import type { Goal, Heading, Place } from '../experiment/place.ts';
import type { Setting, Setup } from '../experiment/setting.ts';
import type {
  Frame as CoreFrame,
  Cost,
  FrameBuffers,
  Ground,
  GroundPatch,
  InsideQuestion,
  Overrides,
  Scene,
  SetAside,
  Solid,
  Timeline,
} from '../wasm/mapless_wasm.js';

/** What crosses from the core as it is. */
export type {
  Activity,
  ClimbStep,
  Cost,
  FrameBuffers,
  Ground,
  GroundPatch,
  Inside,
  InsideQuestion,
  Metrics,
  Mount,
  Outcome,
  PathPoint,
  Placement,
  PlaceReport,
  Pose,
  Segment,
  SensorPose,
  SetAside,
  Solid,
  Subgoal,
  TerrainPreview,
  Thought,
  Timeline,
  Verdict,
} from '../wasm/mapless_wasm.js';

/** What a scenario is made of, after its files were read. */
export interface SessionInfo extends Setting, Scene {
  readonly scenario: string;
  /** Every parameter, with the value that holds unless it is overridden. */
  readonly parameters: readonly ParameterGroup[];
  readonly overrides: Overrides;
  /** What the run drives with, where something else is only tried at the present pose. */
  readonly runsWith: Setup | undefined;
  readonly objects: readonly WorldObject[];
  /** The shapes of those that stand; those that walk come with each frame. */
  readonly solids: readonly Solid[];
  /** What was done to a file of heights that its owner should know. */
  readonly warnings: readonly string[];
}

/** What `FrameBuffers.kinds` says of a column, by its number. */
export const COLUMN_KINDS = ['ground', 'unknown', 'wall'] as const;
export type ColumnKind = (typeof COLUMN_KINDS)[number];

/** What `FrameBuffers.return_kinds` says of a return, by its number. */
export const RETURN_KINDS = ['surface', 'invalid', 'far', 'body', 'stray', 'overhead'] as const;
/** Those that the planner sets aside, as the page names them. */
export const SET_ASIDE = ['stray', 'body', 'overhead'] as const satisfies readonly (keyof SetAside)[];
export type SetAsideKind = (typeof SET_ASIDE)[number];

/** Whether the planner sets returns with this number aside. */
export function isSetAside(kind: number): boolean {
  return (SET_ASIDE as readonly string[]).includes(RETURN_KINDS[kind] ?? '');
}

/** The terms of a subgoal's cost. The paper has the first three. */
export const TERMS = [
  'direction',
  'distance',
  'steepness',
  'commitment',
  'correction',
] as const satisfies readonly (keyof Cost)[];

/** Hands a frame's arrays over instead of copying them. */
export function transferables(buffers: FrameBuffers): ArrayBuffer[] {
  return Object.values(buffers).map((array: FrameBuffers[keyof FrameBuffers]) => array.buffer);
}

export const TIMELINE_START: Timeline = { first: 0, end: 0, changes: [] };

/** Whether a run no longer follows from its start: ground, route or planner changed under way. */
export function isDisturbed({ first, changes }: Timeline): boolean {
  return first > 0 || changes.some((tick) => tick > 0);
}

/** Everything that one planning tick saw, decided and did, and what came since the frame before. */
export interface Frame extends CoreFrame {
  /** Whether the surfaces in `buffers` are this tick's; otherwise nobody watches them, or they are not due again yet. */
  readonly surfaces: boolean;
  readonly buffers: FrameBuffers;
  /** Duration of the planner's last step. */
  readonly planner_ms: number;
  /** x, y, z after each tick since the frame before; after a jump in time, since the beginning. */
  readonly trail: Float32Array<ArrayBuffer>;
  /** The ticks since the frame before, as rows of the record (record.ts). */
  readonly rows: Float64Array<ArrayBuffer>;
  /** Whether `trail` takes the place of all before: after a jump in time or a new start. */
  readonly anew: boolean;
  /** After a jump back: x, y, z of what came next. */
  readonly ahead: Float32Array<ArrayBuffer> | undefined;
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
  | { readonly files: readonly NamedFile[]; readonly holes: Holes; readonly setup: Setup };

/** The parts of the page's address that say what to begin with, and which piece of work this tab was at. */
export interface Address {
  readonly hash: string;
  readonly search: string;
  readonly work: string | undefined;
}

/** What the page began with. */
export interface Beginning {
  readonly from: 'link' | 'address' | 'last visit' | 'catalogue';
  /** Where somebody left off. */
  readonly own: Work | undefined;
  /** Why that cannot be read, where it cannot. */
  readonly unread: string | undefined;
  /** The time at which its run stands; without it, it drives. */
  readonly moment_s: number | undefined;
}

export type Command =
  /** Loads and drives what the page begins with; answered with a `Beginning`. */
  | { type: 'begin'; address: Address }
  /** With `play`, it drives at once; otherwise it does so if what was there before did. */
  | { type: 'load'; source: Source; play: boolean }
  /** Drives on to a time of the run as fast as it goes, and stands there; `play` and `load` break it off. */
  | { type: 'drive'; time_s: number }
  | { type: 'restart' }
  /** What is only tried holds from here on, also with `step`. */
  | { type: 'play'; playing: boolean }
  | { type: 'speed'; speed: Speed }
  | { type: 'step' }
  | { type: 'goal'; goal: Goal; waypoints: readonly Place[] }
  /** Begins anew with these overrides in place of all others, on the same ground and route. */
  | { type: 'parameters'; overrides: Overrides; seed: number | undefined }
  /** Senses and decides again where the robot stands, with this setup; the run itself stays as it was. */
  | { type: 'think'; setup: Setup }
  /** Answered with an `Inside`. */
  | { type: 'inside'; question: InsideQuestion }
  /** Answered with what is true of a place, as a `PlaceReport`. */
  | { type: 'place'; place: Place }
  /** Answered with the steps of learning, as a list of `ClimbStep`. */
  | { type: 'climb' }
  /** Answered with the covariances of all directions with this one. */
  | { type: 'kernel'; column: number; row: number }
  /** Whether frames bring the true skyline while nothing drives. */
  | { type: 'truth'; shown: boolean }
  /** Goes to a tick of the timeline and stays there. */
  | { type: 'seek'; tick: number }
  | { type: 'start'; start: Heading }
  /** In place of all there are. */
  | { type: 'objects'; objects: readonly WorldObject[] }
  | { type: 'sculpt'; stroke: Stroke }
  /** Puts heights back; answered like a stroke. */
  | { type: 'replace'; patch: GroundPatch }
  /** Answered with a terrain, coarsely, as a `TerrainPreview`. */
  | { type: 'preview'; terrain: Terrain }
  /** Answered with the files that `mapless run` reads, as a list of `NamedFile`. */
  | { type: 'export'; experiment: Experiment }
  /** Whether anything shows the surfaces: predicting them costs more than the decision itself. */
  | { type: 'watch'; surfaces: boolean }
  | { type: 'hidden'; hidden: boolean };

/** A decision that may take long. */
export interface Computing {
  readonly tick: number;
  /** Whether it learns the hyperparameters. */
  readonly learns: boolean;
}

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
  /** A decision is being made that may take long; whatever comes next, it is made. */
  | ({ type: 'computing' } & Computing)
  /** It plays no longer, though nobody asked for that. */
  | { type: 'stands' }
  /** New heights, and the shapes of what stands on them now. */
  | { type: 'ground'; patch: GroundPatch; solids: readonly Solid[] }
  | { type: 'done'; id: number; value: unknown }
  | { type: 'failed'; id: number | undefined; message: string; panicked: boolean };
