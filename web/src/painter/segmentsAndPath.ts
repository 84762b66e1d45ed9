/** Segments as arcs at the radius where subgoals lie, and the planned path to the chosen subgoal on the ground. */

import { Color, Group } from 'three';
import type { Theme } from '../colours/theme.ts';
import type { Layers } from '../scene/layers.ts';
import { segmentArc } from '../scene/segmentArc.ts';
import type { Seen } from './painterProtocol.ts';
import { colour } from './relief.ts';
import { MARKS_ORDER } from './subgoals.ts';
import { ThickLines } from './thickLines.ts';

type Height = (x: number, y: number) => number;

const LIFT_M = 0.06;

export class SegmentsAndPath {
  readonly group = new Group();
  readonly #segments = new ThickLines(512, 4);
  readonly #path = new ThickLines(512, 4);
  #valid = new Color();
  #refused = new Color();

  constructor(theme: Theme) {
    this.group.add(this.#segments.line, this.#path.line);
    for (const { line } of [this.#segments, this.#path]) line.renderOrder = MARKS_ORDER;
    this.theme(theme);
  }

  theme(theme: Theme): void {
    this.#valid = colour(theme.ink);
    this.#refused = colour(theme.danger);
  }

  layers({ segments, path }: Layers): void {
    this.#segments.line.visible = segments;
    this.#path.line.visible = path;
  }

  show(seen: Seen, radius_m: number, height: Height): void {
    if (this.#segments.line.visible) this.#showSegments(seen, radius_m);
    if (this.#path.line.visible) this.#showPath(seen, height);
  }

  #showSegments({ segments, sensor }: Seen, radius_m: number): void {
    this.#segments.clear();
    for (const one of segments) {
      const arc = segmentArc(one, sensor, radius_m);
      this.#segments.add(arc, one.verdict === 'valid' ? this.#valid : this.#refused);
    }
    this.#segments.done();
  }

  #showPath({ path, pose }: Seen, height: Height): void {
    this.#path.clear();
    let from = [pose.x, pose.y, height(pose.x, pose.y) + LIFT_M];
    for (const { x, y, reverse } of path) {
      const to = [x, y, height(x, y) + LIFT_M];
      this.#path.add([...from, ...to], reverse ? this.#refused : this.#valid);
      from = to;
    }
    this.#path.done();
  }
}
