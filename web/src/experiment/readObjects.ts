/** Checks objects from outside. */

import { fail, fields, list, number } from '../base/checks.ts';
import type { WorldObject } from './objects.ts';

const MAX_OBJECTS = 1000;
const MAX_WALK = 100;
const FAR_M = 1e6;

type Check = (value: unknown, at: string) => unknown;

const size: Check = (value, at) => number(value, at, 0.001, 100);
const room: Check = (value, at) => number(value, at, 0, 100);
const angle: Check = (value, at) => number(value, at, -1000, 1000);
const place: Check = (value, at) => numbers(value, at, 2, (one, where) => number(one, where, 0, FAR_M));
const sizes: Check = (value, at) => numbers(value, at, 3, size);

/** The keys of each kind; those after the first list may be absent. */
const KINDS: Record<WorldObject['kind'], readonly [Record<string, Check>, Record<string, Check>]> = {
  post: [{ at: place, radius_m: size, height_m: size }, { walk }],
  box: [
    { at: place, size_m: sizes },
    { yaw_rad: angle, raised_m: room, walk },
  ],
  rock: [{ at: place, radius_m: size }, { sunk_m: room }],
  wall: [{ from: place, to: place, height_m: size }, { thickness_m: size }],
  gate: [{ at: place, yaw_rad: angle, width_m: size, height_m: size }, {}],
  roof: [{ at: place, size_m: sizes, height_m: size }, { yaw_rad: angle }],
};

function numbers(value: unknown, at: string, count: number, check: Check): unknown {
  const found = list(value, at, count);
  if (found.length !== count) fail(at, value, `${count} numbers`);
  return found.map((one, index) => check(one, `${at}[${index}]`));
}

function walk(value: unknown, at: string): unknown {
  const { path, speed_m_s, starts_within_m } = fields(value, at, ['path', 'speed_m_s'], ['starts_within_m']);
  const points = list(path, `${at}.path`, MAX_WALK);
  if (points.length === 0) fail(`${at}.path`, path, `1 to ${MAX_WALK} points`);
  return {
    path: points.map((one, index) => place(one, `${at}.path[${index}]`)),
    speed_m_s: number(speed_m_s, `${at}.speed_m_s`, 0.001, 10),
    ...(starts_within_m === undefined
      ? {}
      : { starts_within_m: number(starts_within_m, `${at}.starts_within_m`, 0.001, FAR_M) }),
  };
}

function readObject(value: unknown, at: string): WorldObject {
  const { kind } = (value ?? {}) as { kind?: unknown };
  const known = Object.keys(KINDS) as WorldObject['kind'][];
  const name = known.find((one) => one === kind) ?? fail(`${at}.kind`, kind, known.join(' or '));
  const [required, optional] = KINDS[name];
  const found = fields(value, at, ['kind', ...Object.keys(required)], Object.keys(optional));
  const read = Object.entries({ ...required, ...optional }).flatMap(([key, check]) =>
    found[key] === undefined ? [] : [[key, check(found[key], `${at}.${key}`)] as const],
  );
  return { kind: name, ...Object.fromEntries(read) } as WorldObject;
}

/** The objects that a value is, or an error that says what is wrong with it. */
export function readObjects(value: unknown): readonly WorldObject[] {
  return list(value, 'objects', MAX_OBJECTS).map((one, index) => readObject(one, `objects[${index}]`));
}
