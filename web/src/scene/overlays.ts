/** The planner's thinking in the 3D view: surfaces, segments, ways, and marks on what somebody points at. */

import { type Camera, Group } from 'three';
import type { Frame, Pose, SessionInfo } from '../core/protocol.ts';
import type { Finder, Target } from '../ui/attention.ts';
import type { Theme } from '../ui/theme.ts';
import { Bands } from './bands.ts';
import type { Layers } from './layers.ts';
import { Marks } from './marks.ts';
import { nearestMark, projector } from './pointing.ts';
import { Ways } from './ways.ts';

type Height = (x: number, y: number) => number;

export class Overlays {
  readonly group = new Group();
  readonly #bands: Bands;
  readonly #ways: Ways;
  readonly #marks: Marks;
  readonly #height: Height;
  #layers: Layers;
  #radius_m = 0;
  #frame: Frame | undefined;

  constructor(theme: Theme, layers: Layers, height: Height) {
    this.#height = height;
    this.#bands = new Bands(theme);
    this.#ways = new Ways(theme);
    this.#marks = new Marks(theme);
    this.group.add(this.#bands.group, this.#ways.group, this.#marks.group);
    this.#layers = layers;
    this.layers(layers);
  }

  theme(theme: Theme): void {
    for (const part of [this.#bands, this.#ways, this.#marks]) part.theme(theme);
    this.#showWays();
  }

  session(info: SessionInfo): void {
    this.#radius_m = info.occupancy_radius_m;
    this.#bands.session(info);
  }

  layers(layers: Layers): void {
    this.#layers = layers;
    this.#bands.layers(layers);
    this.#ways.layers(layers);
    this.#showWays();
  }

  /** The robot has moved to here. */
  pose(pose: Pose): void {
    this.#bands.pose(pose);
  }

  show(frame: Frame): void {
    this.#frame = frame;
    this.#bands.show(frame);
    this.#showWays();
  }

  /** Marks what somebody points at. */
  mark(frame: Frame, target: Target | undefined): void {
    this.#marks.show(frame, target, this.#radius_m, this.#height);
  }

  /** How to find the subgoal or segment under a place of the canvas, within so many pixels. */
  pointedAt(
    canvas: HTMLCanvasElement,
    camera: Camera,
    clientX: number,
    clientY: number,
    within_px: number,
  ): Finder | undefined {
    const find: Finder = (frame) => {
      const project = projector(canvas.getBoundingClientRect(), camera);
      const shown = { ...this.#layers, radius_m: this.#radius_m, height: this.#height };
      return nearestMark(frame, shown, within_px, (place) => {
        const at = project(place);
        return at ? Math.hypot(at.x - clientX, at.y - clientY) : Number.POSITIVE_INFINITY;
      });
    };
    return this.#frame && find(this.#frame) ? find : undefined;
  }

  #showWays(): void {
    if (this.#frame) this.#ways.show(this.#frame, this.#radius_m, this.#height);
  }
}
