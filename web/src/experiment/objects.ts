/** What stands and walks on the ground: how the page makes objects, and what it does to one. */

import type { WorldObject } from '../wasm/mapless_wasm.js';
import type { Place } from './place.ts';

export type { WorldObject };

/** What the page places. A person is a post that walks. */
export const PALETTE = ['post', 'rock', 'box', 'wall', 'gate', 'roof', 'person'] as const;
export type PaletteKind = (typeof PALETTE)[number];

type Point = [number, number];

const WALL_M = 3;
const WALK_M = 5;
const WALK_SPEED_M_S = 0.8;
const SMALLEST_M = 0.05;
const LARGEST_M = 50;

/** Whether it is dragged from one end to the other: a wall, or the way of a person. */
export function isDrawn(kind: PaletteKind): boolean {
  return kind === 'wall' || kind === 'person';
}

/**
 * A new object at a place. What has a direction lies along `heading_rad` or is driven through along it. What is drawn
 * goes on to the place `to`, or across the heading.
 */
export function makeObject(kind: PaletteKind, { x, y }: Place, heading_rad: number, to?: Place): WorldObject {
  const at: Point = [x, y];
  const aside = (along_m: number): Point => [x - along_m * Math.sin(heading_rad), y + along_m * Math.cos(heading_rad)];
  const end = to && ([to.x, to.y] satisfies Point);
  switch (kind) {
    case 'post':
      return { kind, at, radius_m: 0.15, height_m: 1.2 };
    case 'rock':
      return { kind, at, radius_m: 0.5, sunk_m: 0.15 };
    case 'box':
      return { kind, at, size_m: [1, 1, 0.8], yaw_rad: heading_rad };
    case 'wall':
      return { kind, from: end ? at : aside(-WALL_M / 2), to: end ?? aside(WALL_M / 2), height_m: 1 };
    case 'gate':
      return { kind, at, yaw_rad: heading_rad, width_m: 1.6, height_m: 1.6 };
    case 'roof':
      return { kind, at, size_m: [3, 3, 0.2], yaw_rad: heading_rad, height_m: 2 };
    case 'person': {
      const walk = { path: [end ?? aside(WALK_M)], speed_m_s: WALK_SPEED_M_S };
      return { kind: 'post', at, radius_m: 0.25, height_m: 1.7, walk };
    }
  }
}

/** The same object with each of its places put elsewhere. */
function mapPlaces(object: WorldObject, put: (place: Point) => Point): WorldObject {
  if (object.kind === 'wall') return { ...object, from: put(object.from), to: put(object.to) };
  if ((object.kind === 'post' || object.kind === 'box') && object.walk) {
    return { ...object, at: put(object.at), walk: { ...object.walk, path: object.walk.path.map(put) } };
  }
  return { ...object, at: put(object.at) };
}

/** Where its middle is, or where it begins to walk. */
export function placeOf(object: WorldObject): Place {
  if (object.kind !== 'wall') return { x: object.at[0], y: object.at[1] };
  return { x: (object.from[0] + object.to[0]) / 2, y: (object.from[1] + object.to[1]) / 2 };
}

/** The points of its walk, from its own place on; none where it stands. */
export function walkOf(object: WorldObject | undefined): readonly Place[] {
  if ((object?.kind !== 'post' && object?.kind !== 'box') || !object.walk) return [];
  return [object.at, ...object.walk.path].map(([x, y]) => ({ x, y }));
}

/** The ends that can be dragged by themselves: both of a wall, the last of a walk. */
export function endsOf(object: WorldObject): readonly Place[] {
  if (object.kind === 'wall') return [object.from, object.to].map(([x, y]) => ({ x, y }));
  return walkOf(object).slice(-1);
}

/** With one of its ends elsewhere. */
export function withEnd(object: WorldObject, end: number, { x, y }: Place): WorldObject {
  if (object.kind === 'wall') return { ...object, [end === 0 ? 'from' : 'to']: [x, y] };
  if ((object.kind !== 'post' && object.kind !== 'box') || !object.walk) return object;
  return { ...object, walk: { ...object.walk, path: [...object.walk.path.slice(0, -1), [x, y]] } };
}

export function moved(object: WorldObject, by: Place): WorldObject {
  return mapPlaces(object, ([x, y]) => [x + by.x, y + by.y]);
}

/** Whether turning it makes a difference. */
export function turns(object: WorldObject): boolean {
  return !(object.kind === 'rock' || (object.kind === 'post' && !object.walk));
}

/** Counter-clockwise about its place, with its walk. */
export function turned(object: WorldObject, by_rad: number): WorldObject {
  const middle = placeOf(object);
  const [sin, cos] = [Math.sin(by_rad), Math.cos(by_rad)];
  const all = mapPlaces(object, ([x, y]) => {
    const [east, north] = [x - middle.x, y - middle.y];
    return [middle.x + east * cos - north * sin, middle.y + east * sin + north * cos];
  });
  return 'yaw_rad' in all ? { ...all, yaw_rad: (all.yaw_rad ?? 0) + by_rad } : all;
}

/** Larger or smaller by a factor in all that makes up its size; a wall keeps its ends, for those are dragged. */
export function resized(object: WorldObject, factor: number): WorldObject {
  const size = (value_m: number) => Math.min(Math.max(value_m * factor, SMALLEST_M), LARGEST_M);
  switch (object.kind) {
    case 'post':
      return { ...object, radius_m: size(object.radius_m), height_m: size(object.height_m) };
    case 'rock':
      return { ...object, radius_m: size(object.radius_m), sunk_m: (object.sunk_m ?? 0) * factor };
    case 'box': {
      const [length_m, width_m, height_m] = object.size_m;
      return { ...object, size_m: [size(length_m), size(width_m), size(height_m)] };
    }
    case 'wall':
      return { ...object, height_m: size(object.height_m) };
    case 'gate':
      return { ...object, width_m: size(object.width_m), height_m: size(object.height_m) };
    case 'roof': {
      const [length_m, width_m, thickness_m] = object.size_m;
      return { ...object, size_m: [size(length_m), size(width_m), thickness_m], height_m: size(object.height_m) };
    }
  }
}

/** As documents keep it: lengths to centimetres, angles to a thousandth of a radian; all of it on the ground. */
export function tidyObject(object: WorldObject, width_m: number, depth_m: number): WorldObject {
  const keep = (value_m: number, most_m: number) => cm(Math.min(Math.max(value_m, 0), most_m));
  const whole = (value: unknown, key: string): unknown => {
    if (Array.isArray(value)) return value.map((one) => whole(one, key));
    if (typeof value === 'number') return key === 'yaw_rad' ? Math.round(1000 * value) / 1000 : cm(value);
    if (typeof value !== 'object' || value === null) return value;
    return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, whole(one, name)]));
  };
  return mapPlaces(whole(object, '') as WorldObject, ([x, y]) => [keep(x, width_m), keep(y, depth_m)]);
}

function cm(value_m: number): number {
  return Math.round(100 * value_m) / 100;
}

/** As a person calls it, with its number among all objects. */
export function objectName(object: WorldObject, index: number): string {
  const walks = walkOf(object).length > 0;
  const kind = walks ? (object.kind === 'post' ? 'person' : 'moving box') : object.kind;
  return `${kind.charAt(0).toUpperCase()}${kind.slice(1)} ${index + 1}`;
}

/** Its size in words. */
export function sizeWords(object: WorldObject): string {
  const m = (value_m: number) => `${Number(value_m.toFixed(2))} m`;
  switch (object.kind) {
    case 'post':
      return `${m(object.height_m)} high, ${m(2 * object.radius_m)} thick`;
    case 'rock':
      return `${m(2 * object.radius_m)} thick`;
    case 'box':
      return object.size_m.map(m).join(' × ');
    case 'wall': {
      const [[x, y], [u, v]] = [object.from, object.to];
      return `${m(Math.hypot(u - x, v - y))} long, ${m(object.height_m)} high`;
    }
    case 'gate':
      return `${m(object.width_m)} wide, ${m(object.height_m)} high`;
    case 'roof':
      return `${m(object.size_m[0])} × ${m(object.size_m[1])}, ${m(object.height_m)} up`;
  }
}
