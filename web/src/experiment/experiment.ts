/**
 * The experiment: all that a run depends on, as one plain document. The same document gives the same run, bit by bit, in any
 * browser and on the command line. Undo, links, files and autosave all keep documents of this kind.
 */

import type { Stroke, StrokeKind } from '../wasm/mapless_wasm.js';
import type { WorldObject } from './objects.ts';
import type { Overrides } from './overrides.ts';
import type { Goal, Heading, Place } from './place.ts';
import type { Learning, Preset, Setup } from './setting.ts';

export const VERSION = 1;

/** Kinds of generated terrain: bare ground by difficulty, then those with obstacles. */
export const FAMILIES = ['easy', 'moderate', 'hard', 'rocks', 'posts', 'walls', 'ditches', 'mixed', 'movers'] as const;
export type Family = (typeof FAMILIES)[number];

/** A file as text, for recipes that import a grid of heights. */
export interface ImportedFile {
  readonly name: string;
  readonly base64: string;
}

/** What becomes of samples without a height in a file of heights by itself; a recipe says so itself. */
export const HOLES = ['refuse', 'fill', 'crop'] as const;
export type Holes = (typeof HOLES)[number];

/** Where the ground comes from, before any stroke. */
export type Terrain =
  | { readonly catalogue: string }
  /** `difficulty` is any family: links have named it so since there were only difficulties. */
  | { readonly generated: { readonly difficulty: Family; readonly seed: number } }
  /** The text of a recipe, and the file that it imports, if it does. */
  | { readonly recipe: string; readonly imported?: ImportedFile };

export type { Stroke, StrokeKind };

export const STROKE_KINDS = [
  'raise',
  'lower',
  'smooth',
  'level',
  'roughen',
  'crater',
  'boulder',
  'ramp',
  'ditch',
] as const satisfies readonly StrokeKind[];

export interface Experiment {
  readonly version: typeof VERSION;
  /** That of the scenario or of the file it began with. */
  readonly name: string;
  readonly terrain: Terrain;
  readonly strokes: readonly Stroke[];
  /** What stands and walks on the ground; absent where the scenario or the terrain says it. */
  readonly objects?: readonly WorldObject[];
  readonly start: Heading;
  /** Driven to one after the other, before the goal. */
  readonly waypoints: readonly Place[];
  readonly goal: Goal;
  readonly seed: number;
  readonly preset: Preset;
  readonly learning: Learning;
  /** Tables `planner`, `sensor`, `robot` and `reality`. */
  readonly overrides: Overrides;
}

/** How the first visit begins. */
export const FIRST_SETUP: Setup = { preset: 'default', learning: 'fixed', overrides: {} };

export const OVERRIDDEN = ['planner', 'sensor', 'robot', 'reality'] as const;
export const PRESETS: readonly Preset[] = ['default', 'paper'];
/** Presets of `reality`. */
export const REALITIES: readonly string[] = ['ideal', 'field', 'harsh'];
export const LEARNING: readonly Learning[] = ['fixed', 'once', 'every_scan'];

export const MAX_SEED = 0xffff_ffff;
/** Touches of all strokes together: more would take long to repeat. */
export const MAX_TOUCHES = 50_000;
export const MAX_WAYPOINTS = 1000;
export const MAX_RECIPE_CHARACTERS = 1_000_000;
/** Of an imported file. */
export const MAX_FILE_BYTES = 16 << 20;

/** A whole centimetre: finer places make longer links and no difference. */
export function centimetres(value_m: number): number {
  return Math.round(100 * value_m);
}

/** Rounded as documents keep it: places to centimetres. */
export function tidyPlace({ x, y }: Place): Place {
  return { x: centimetres(x) / 100, y: centimetres(y) / 100 };
}

/** Places to centimetres, headings to a thousandth of a radian. */
export function tidyHeading(heading: Heading): Heading {
  return { ...tidyPlace(heading), heading_rad: Math.round(1000 * heading.heading_rad) / 1000 };
}

export function tidyGoal({ x, y, heading_rad }: Goal): Goal {
  return heading_rad === undefined ? tidyPlace({ x, y }) : tidyHeading({ x, y, heading_rad });
}

/** Whether two experiments lead over the same ground, past the same objects, from the same start to the same goal. */
export function sameCourse(one: Experiment, other: Experiment): boolean {
  const route = ({ start, waypoints, goal, objects }: Experiment) =>
    JSON.stringify([tidyHeading(start), waypoints.map(tidyPlace), tidyGoal(goal), objects]);
  return (
    one.strokes.length + other.strokes.length === 0 &&
    route(one) === route(other) &&
    JSON.stringify(one.terrain) === JSON.stringify(other.terrain)
  );
}
