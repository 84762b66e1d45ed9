/** What the inspector shows in the 3D view: surfaces, segments, the planned path, and marks on what somebody points at. */

import { Group } from 'three';
import type { Theme } from '../colours/theme.ts';
import type { Pose } from '../protocol/simulationProtocol.ts';
import type { Layers } from '../scene/layers.ts';
import type { Target } from '../scene/selection.ts';
import { Bands } from './bands.ts';
import { Marks } from './marks.ts';
import type { Scenery, Seen } from './painterProtocol.ts';
import { SegmentsAndPath } from './segmentsAndPath.ts';

type Height = (x: number, y: number) => number;

export class Overlays {
  readonly group = new Group();
  readonly #bands: Bands;
  readonly #lines: SegmentsAndPath;
  readonly #marks: Marks;
  readonly #height: Height;
  #radius_m = 0;
  #seen: Seen | undefined;

  constructor(theme: Theme, layers: Layers, height: Height) {
    this.#height = height;
    this.#bands = new Bands(theme);
    this.#lines = new SegmentsAndPath(theme);
    this.#marks = new Marks(theme);
    this.group.add(this.#bands.group, this.#lines.group, this.#marks.group);
    this.layers(layers);
  }

  theme(theme: Theme): void {
    for (const part of [this.#bands, this.#lines, this.#marks]) part.theme(theme);
    this.#showLines();
  }

  session(scenery: Scenery): void {
    this.#radius_m = scenery.occupancy_radius_m;
    this.#bands.session(scenery);
  }

  layers(layers: Layers): void {
    this.#bands.layers(layers);
    this.#lines.layers(layers);
    this.#showLines();
  }

  /** The robot has moved to here. */
  pose(pose: Pose): void {
    this.#bands.pose(pose);
  }

  show(seen: Seen): void {
    this.#seen = seen;
    this.#bands.show(seen);
    this.#showLines();
  }

  /** Marks what somebody points at. */
  mark(target: Target | undefined): void {
    if (this.#seen) this.#marks.show(this.#seen, target, this.#radius_m, this.#height);
  }

  #showLines(): void {
    if (this.#seen) this.#lines.show(this.#seen, this.#radius_m, this.#height);
  }
}
