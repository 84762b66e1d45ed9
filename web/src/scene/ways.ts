/** Segments as arcs at the radius where subgoals lie, and the way to the chosen subgoal on the ground. */

import { Color, Group } from 'three';
import type { Frame, Segment } from '../core/protocol.ts';
import type { Theme } from '../ui/theme.ts';
import type { Layers } from './layers.ts';
import { colour } from './relief.ts';
import { Strokes } from './strokes.ts';
import { MARKS_ORDER } from './subgoals.ts';

type Height = (x: number, y: number) => number;

const ARC_STEP_RAD = Math.PI / 90;
const LIFT_M = 0.06;

export class Ways {
  readonly group = new Group();
  readonly #segments = new Strokes(512, 4);
  readonly #way = new Strokes(512, 4);
  #valid = new Color();
  #refused = new Color();

  constructor(theme: Theme) {
    this.group.add(this.#segments.line, this.#way.line);
    for (const { line } of [this.#segments, this.#way]) line.renderOrder = MARKS_ORDER;
    this.theme(theme);
  }

  theme(theme: Theme): void {
    this.#valid = colour(theme.ink);
    this.#refused = colour(theme.danger);
  }

  layers({ segments, way }: Layers): void {
    this.#segments.line.visible = segments;
    this.#way.line.visible = way;
  }

  show(frame: Frame, radius_m: number, height: Height): void {
    if (this.#segments.line.visible) this.#showSegments(frame, radius_m);
    if (this.#way.line.visible) this.#showWay(frame, height);
  }

  #showSegments({ segments, world_from_sensor }: Frame, radius_m: number): void {
    this.#segments.clear();
    for (const one of segments) {
      const arc = segmentArc(one, world_from_sensor, radius_m);
      this.#segments.add(arc, one.verdict === 'valid' ? this.#valid : this.#refused);
    }
    this.#segments.done();
  }

  #showWay({ way, pose }: Frame, height: Height): void {
    this.#way.clear();
    let from = [pose.x, pose.y, height(pose.x, pose.y) + LIFT_M];
    for (let at = 0; at < way.length; at += 3) {
      const [x = 0, y = 0, reverse] = way.subarray(at, at + 3);
      const to = [x, y, height(x, y) + LIFT_M];
      this.#way.add([...from, ...to], reverse === 1 ? this.#refused : this.#valid);
      from = to;
    }
    this.#way.done();
  }
}

/** Points of a segment in the world; nothing where its elevation is unknown. */
export function segmentArc(segment: Segment, world_from_sensor: Float64Array, radius_m: number): number[] {
  const { begin_rad, end_rad, elevation_rad } = segment;
  if (Number.isNaN(elevation_rad)) return [];
  const steps = Math.max(1, Math.ceil((end_rad - begin_rad) / ARC_STEP_RAD));
  const flat_m = radius_m * Math.cos(elevation_rad);
  const up_m = radius_m * Math.sin(elevation_rad);
  const arc: number[] = [];
  for (let step = 0; step <= steps; step += 1) {
    const azimuth = begin_rad + ((end_rad - begin_rad) * step) / steps;
    const [ahead_m, left_m] = [flat_m * Math.cos(azimuth), flat_m * Math.sin(azimuth)];
    for (let axis = 0; axis < 3; axis += 1) {
      const part = (index: number) => world_from_sensor[index + axis] ?? 0;
      arc.push(part(0) + ahead_m * part(3) + left_m * part(6) + up_m * part(9));
    }
  }
  return arc;
}
