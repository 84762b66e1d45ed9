/** What the page and the worker that draws the 3D view say to each other. */

import type { Theme } from '../colours/theme.ts';
import type { Place } from '../experiment/place.ts';
import type { PlacedGround } from '../ground/heightField.ts';
import type { Frame, GroundPatch, Pose, SessionInfo, Solid } from '../protocol/simulationProtocol.ts';
import type { Colouring, Layers } from '../scene/layers.ts';
import type { Target } from '../scene/selection.ts';

const SCENERY = [
  'start',
  'waypoints',
  'goal',
  'limits',
  'occupancy_radius_m',
  'mount',
  'objects',
  'solids',
  'image',
] as const satisfies readonly (keyof SessionInfo)[];

const SEEN = [
  'pose',
  'returns',
  'sensor',
  'surfaces',
  'threshold',
  'segments',
  'subgoals',
  'path',
  'buffers',
  'trail',
  'anew',
  'ahead',
  'waypoints_passed',
  'movers',
] as const satisfies readonly (keyof Frame)[];

/** What the view shows of a scenario. */
export type Scenery = Pick<SessionInfo, (typeof SCENERY)[number]>;

/** What the view shows of a tick. */
export type Seen = Pick<Frame, (typeof SEEN)[number]>;

export const sceneryOf = (info: SessionInfo): Scenery => pick(info, SCENERY);
export const seenIn = (frame: Frame): Seen => pick(frame, SEEN);

/** Nearer than this and farther than this the camera sees nothing. */
export const DEPTH_M = { near: 0.1, far: 1500 };

/** Where the camera stands and looks, and where the robot is, at one moment. */
export interface Look {
  readonly position: readonly [number, number, number];
  readonly quaternion: readonly [number, number, number, number];
  /** Of the whole height of the view. */
  readonly fieldOfView_deg: number;
  readonly robot: Pose;
  /** Where the robot believes to be, where that may differ. */
  readonly believed: Pose | undefined;
  /** Whether the camera is the robot's own eye: then the robot is not drawn. */
  readonly eye: boolean;
}

/** How another robot on the same course goes on. */
export interface GhostStep {
  /** Nothing before its start is known. */
  readonly pose: Pose | undefined;
  /** x, y, z of the ticks since the step before; of all ticks with `anew`. */
  readonly path: Float32Array<ArrayBuffer>;
  readonly anew: boolean;
}

export type ToPainter =
  | { type: 'begin'; canvas: OffscreenCanvas; theme: Theme; devicePixelRatio: number }
  | { type: 'size'; width_px: number; height_px: number }
  | { type: 'theme'; theme: Theme }
  | { type: 'scenery'; scenery: Scenery; ground: PlacedGround | undefined }
  /** Heights that only say how high marks stand: no ground is known, and none is drawn. */
  | { type: 'surroundings'; ground: PlacedGround }
  | { type: 'patch'; patch: GroundPatch; solids: readonly Solid[] }
  /** The object in hand, if any, and how far it is dragged from where it stands. */
  | { type: 'held'; object: number | undefined; by: Place }
  | { type: 'seen'; seen: Seen }
  | { type: 'look'; look: Look }
  | { type: 'layers'; layers: Layers }
  | { type: 'colouring'; colouring: Colouring }
  | { type: 'mark'; target: Target | undefined }
  /** The brush's ring, drawn out along the line from `from`; a radius of zero hides it. */
  | { type: 'brush'; at: Place; from: Place; radius_m: number }
  /** Other robots in place of those before, each in its colour. */
  | { type: 'ghosts'; colours: readonly string[] }
  | { type: 'ghostSteps'; steps: readonly GhostStep[] }
  /** Whether each picture is sent to the page, too, and whether the first of them is as fine as the screen shows it. */
  | { type: 'film'; wanted: boolean; fine: boolean }
  /** Answered once everything before it is drawn and nothing changes by itself any more. */
  | { type: 'rest'; id: number };

export type FromPainter =
  /** The view stays empty, for want of WebGL. */
  | { type: 'unavailable' }
  /** There is a first picture. */
  | { type: 'drawn' }
  /** The graphics driver refused a shader program: something is missing in the view. */
  | { type: 'refused'; why: string }
  /** The graphics driver took the view away, or gave it back. */
  | { type: 'lost' }
  | { type: 'restored' }
  | { type: 'picture'; picture: ImageBitmap }
  | { type: 'rested'; id: number };

function pick<Whole extends object, Name extends keyof Whole>(whole: Whole, names: readonly Name[]): Pick<Whole, Name> {
  return Object.fromEntries(names.map((name) => [name, whole[name]])) as Pick<Whole, Name>;
}
