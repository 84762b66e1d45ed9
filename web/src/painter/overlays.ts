/** The planner's thinking in the 3D view: surfaces, segments, ways, and marks on what somebody points at. */

import { Group } from 'three';
import type { Theme } from '../colours/theme.ts';
import type { Pose } from '../protocol/simulationProtocol.ts';
import type { Layers } from '../scene/layers.ts';
import type { Target } from '../scene/selection.ts';
import { Bands } from './bands.ts';
import { Marks } from './marks.ts';
import type { Scenery, Seen } from './painterProtocol.ts';
import { Ways } from './ways.ts';

type Height = (x: number, y: number) => number;

export class Overlays {
  readonly group = new Group();
  readonly #bands: Bands;
  readonly #ways: Ways;
  readonly #marks: Marks;
  readonly #height: Height;
  #radius_m = 0;
  #seen: Seen | undefined;

  constructor(theme: Theme, layers: Layers, height: Height) {
    this.#height = height;
    this.#bands = new Bands(theme);
    this.#ways = new Ways(theme);
    this.#marks = new Marks(theme);
    this.group.add(this.#bands.group, this.#ways.group, this.#marks.group);
    this.layers(layers);
  }

  theme(theme: Theme): void {
    for (const part of [this.#bands, this.#ways, this.#marks]) part.theme(theme);
    this.#showWays();
  }

  session(scenery: Scenery): void {
    this.#radius_m = scenery.occupancy_radius_m;
    this.#bands.session(scenery);
  }

  layers(layers: Layers): void {
    this.#bands.layers(layers);
    this.#ways.layers(layers);
    this.#showWays();
  }

  /** The robot has moved to here. */
  pose(pose: Pose): void {
    this.#bands.pose(pose);
  }

  show(seen: Seen): void {
    this.#seen = seen;
    this.#bands.show(seen);
    this.#showWays();
  }

  /** Marks what somebody points at. */
  mark(target: Target | undefined): void {
    if (this.#seen) this.#marks.show(this.#seen, target, this.#radius_m, this.#height);
  }

  #showWays(): void {
    if (this.#seen) this.#ways.show(this.#seen, this.#radius_m, this.#height);
  }
}
