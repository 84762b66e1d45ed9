/** Checks a document from outside. Every fault names its place, the value and what was expected. */

import { fail, fields, list, number, oneOf, whole } from '../base/checks.ts';
import {
  type Experiment,
  FAMILIES,
  type ImportedFile,
  LEARNING,
  MAX_FILE_BYTES,
  MAX_RECIPE_CHARACTERS,
  MAX_SEED,
  MAX_TOUCHES,
  MAX_WAYPOINTS,
  OVERRIDDEN,
  PRESETS,
  STROKE_KINDS,
  type Stroke,
  type Terrain,
  VERSION,
} from './experiment.ts';
import type { Overrides, OverrideValue } from './overrides.ts';
import type { Goal, Heading, Place } from './place.ts';
import { readObjects } from './readObjects.ts';
import type { Setup } from './setting.ts';

const MAX_STROKES = 5000;
/** No coordinate lies farther out, in metres. */
const FAR_M = 1e6;
const MAX_DEPTH = 8;
const FILE_NAME = /^[\w][\w .-]{0,79}\.(png|asc|tiff?)$/i;
const KEY = /^[A-Za-z0-9_]{1,64}$/;

function text(value: unknown, place: string, most: number): string {
  if (typeof value !== 'string') fail(place, value, 'text');
  if (value.length > most) fail(place, `${value.length} characters`, `at most ${most}`);
  return value;
}

function place(value: unknown, at: string): Place {
  const { x, y } = fields(value, at, ['x', 'y']);
  return { x: number(x, `${at}.x`, -FAR_M, FAR_M), y: number(y, `${at}.y`, -FAR_M, FAR_M) };
}

function heading(value: unknown, at: string): Heading {
  const { heading_rad, ...rest } = fields(value, at, ['x', 'y', 'heading_rad']);
  return { ...place(rest, at), heading_rad: number(heading_rad, `${at}.heading_rad`, -1000, 1000) };
}

function goal(value: unknown, at: string): Goal {
  const { heading_rad, ...rest } = fields(value, at, ['x', 'y'], ['heading_rad']);
  return heading_rad === undefined ? place(rest, at) : heading({ ...rest, heading_rad }, at);
}

function imported(value: unknown, at: string): ImportedFile {
  const { name, base64 } = fields(value, at, ['name', 'base64']);
  if (typeof name !== 'string' || !FILE_NAME.test(name)) {
    fail(`${at}.name`, name, 'a plain file name that ends in .png, .asc, .tif or .tiff');
  }
  const data = text(base64, `${at}.base64`, Math.ceil(MAX_FILE_BYTES / 3) * 4);
  if (!/^[A-Za-z0-9+/]*={0,2}$/.test(data) || data.length % 4 !== 0) fail(`${at}.base64`, data, 'base64');
  return { name, base64: data };
}

function terrain(value: unknown): Terrain {
  const at = 'terrain';
  const found = fields(value, at, [], ['catalogue', 'generated', 'recipe', 'imported']);
  if (found.catalogue !== undefined) {
    fields(value, at, ['catalogue']);
    const name = text(found.catalogue, `${at}.catalogue`, 64);
    if (!KEY.test(name)) fail(`${at}.catalogue`, name, 'the name of a terrain');
    return { catalogue: name };
  }
  if (found.generated !== undefined) {
    fields(value, at, ['generated']);
    const { difficulty, seed } = fields(found.generated, `${at}.generated`, ['difficulty', 'seed']);
    return {
      generated: {
        difficulty: oneOf(difficulty, `${at}.generated.difficulty`, FAMILIES),
        seed: whole(seed, `${at}.generated.seed`, 0, MAX_SEED),
      },
    };
  }
  const recipe = text(found.recipe, `${at}.recipe`, MAX_RECIPE_CHARACTERS);
  if (found.imported === undefined) return { recipe };
  return { recipe, imported: imported(found.imported, `${at}.imported`) };
}

export function readStroke(value: unknown, at = 'stroke'): Stroke {
  const found = fields(value, at, ['kind', 'radius_m', 'strength_m', 'points_cm'], ['height_m', 'seed']);
  const kind = oneOf(found.kind, `${at}.kind`, STROKE_KINDS);
  const points_cm = list(found.points_cm, `${at}.points_cm`, 2 * MAX_TOUCHES);
  if (points_cm.length % 2 !== 0) fail(`${at}.points_cm`, `${points_cm.length} numbers`, 'pairs of x and y');
  return {
    kind,
    radius_m: number(found.radius_m, `${at}.radius_m`, 0.01, 1000),
    strength_m: number(found.strength_m, `${at}.strength_m`, 0, 100),
    ...(kind === 'level' ? { height_m: number(found.height_m, `${at}.height_m`, -1e5, 1e5) } : {}),
    ...(kind === 'roughen' ? { seed: whole(found.seed, `${at}.seed`, 0, MAX_SEED) } : {}),
    points_cm: points_cm.map((one, index) => whole(one, `${at}.points_cm[${index}]`, -100 * FAR_M, 100 * FAR_M)),
  };
}

function strokes(value: unknown): readonly Stroke[] {
  const read = list(value, 'strokes', MAX_STROKES).map((one, index) => readStroke(one, `strokes[${index}]`));
  const touches = read.reduce((sum, { points_cm }) => sum + points_cm.length / 2, 0);
  if (touches > MAX_TOUCHES) fail('strokes', `${touches} touches`, `at most ${MAX_TOUCHES}`);
  return read;
}

function override(value: unknown, at: string, depth: number): OverrideValue | Overrides {
  if (depth > MAX_DEPTH) fail(at, value, `at most ${MAX_DEPTH} tables within each other`);
  if (typeof value === 'number') return number(value, at, -1e300, 1e300);
  if (typeof value === 'boolean') return value;
  if (typeof value === 'string') return text(value, at, 200);
  if (Array.isArray(value))
    return list(value, at, 1000).map((one, index) => override(one, `${at}[${index}]`, depth + 1));
  return table(value, at, depth);
}

function table(value: unknown, at: string, depth: number): Overrides {
  if (typeof value !== 'object' || value === null) fail(at, value, 'a table');
  const entries = Object.entries(value);
  for (const [key, one] of entries) if (!KEY.test(key)) fail(`${at}.${key}`, one, 'a key of letters, digits and _');
  return Object.fromEntries(entries.map(([key, one]) => [key, override(one, `${at}.${key}`, depth + 1)]));
}

function overrides(value: unknown): Overrides {
  const found = fields(value, 'overrides', [], OVERRIDDEN);
  return Object.fromEntries(Object.entries(found).map(([key, one]) => [key, table(one, `overrides.${key}`, 1)]));
}

/** How the planner is set up, from outside. */
export function readSetup(value: unknown, at: string): Setup {
  const found = fields(value, at, ['preset', 'learning', 'overrides']);
  return {
    preset: oneOf(found.preset, 'preset', PRESETS),
    learning: oneOf(found.learning, 'learning', LEARNING),
    overrides: overrides(found.overrides),
  };
}

/** The document that a value is, or an error that says what is wrong with it. */
export function readExperiment(value: unknown): Experiment {
  const version = (value as { version?: unknown } | null)?.version;
  if (version !== VERSION) fail('version', version, `${VERSION}: this page reads no other version of experiments`);
  const scenario = ['start', 'waypoints', 'goal', 'seed', 'preset', 'learning', 'overrides'];
  const found = fields(value, 'experiment', ['version', 'name', 'terrain', 'strokes', ...scenario], ['objects']);
  const { preset, learning } = found;
  return {
    version: VERSION,
    name: text(found.name, 'name', 80),
    terrain: terrain(found.terrain),
    strokes: strokes(found.strokes),
    ...(found.objects === undefined ? {} : { objects: readObjects(found.objects) }),
    start: heading(found.start, 'start'),
    waypoints: list(found.waypoints, 'waypoints', MAX_WAYPOINTS).map((one, at) => place(one, `waypoints[${at}]`)),
    goal: goal(found.goal, 'goal'),
    seed: whole(found.seed, 'seed', 0, MAX_SEED),
    ...readSetup({ preset, learning, overrides: found.overrides }, 'experiment'),
  };
}
