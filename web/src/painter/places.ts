/** The goal's flag and the start's mark. */

import {
  BufferGeometry,
  CylinderGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
  Shape,
  ShapeGeometry,
  Vector2,
} from 'three';
import type { Theme } from '../colours/theme.ts';
import type { Goal, Heading } from '../experiment/place.ts';
import type { Vector } from '../ground/heightField.ts';
import { colour } from './relief.ts';

/** From farther away the flag grows with the distance. */
const FULL_SIZE_WITHIN_M = 40;

type Height = (x: number, y: number) => number;

/** A beam over the goal shows above the hills in between. */
const BEAM_M = 12;

export class Places {
  readonly group = new Group();
  readonly #goalLook = new MeshBasicMaterial({ side: DoubleSide });
  readonly #beamLook = new MeshBasicMaterial({ transparent: true, opacity: 0.3, depthWrite: false });
  readonly #poleLook = new MeshBasicMaterial();
  readonly #startLook = new MeshBasicMaterial({ side: DoubleSide });
  readonly #goal = new Group();
  readonly #goalArrow: Mesh;
  readonly #start = new Group();
  #at: { goal: Goal; start: Heading } | undefined;

  constructor() {
    const pole = new Mesh(
      new CylinderGeometry(0.05, 0.05, 3.4, 8).rotateX(Math.PI / 2).translate(0, 0, 1.7),
      this.#poleLook,
    );
    const cloth = new BufferGeometry();
    cloth.setAttribute('position', new Float32BufferAttribute([0, 0, 3.4, 0, 0, 2.3, 1.5, 0, 2.85], 3));
    const ring = new Mesh(new RingGeometry(0.55, 0.68, 40).translate(0, 0, 0.12), this.#goalLook);
    const beam = new Mesh(new CylinderGeometry(0.14, 0.14, BEAM_M, 12, 1, true).rotateX(Math.PI / 2), this.#beamLook);
    beam.position.z = BEAM_M / 2;
    this.#goal.add(beam, pole, new Mesh(cloth, this.#goalLook), ring);
    const arrow = new BufferGeometry();
    arrow.setAttribute(
      'position',
      new Float32BufferAttribute(
        [0.6, 0, 0.14, -0.35, 0.35, 0.14, -0.15, 0, 0.14, 0.6, 0, 0.14, -0.15, 0, 0.14, -0.35, -0.35, 0.14],
        3,
      ),
    );
    this.#start.add(new Mesh(arrow, this.#startLook));
    const outline = [0.6, 0.1, 1.5, 0.1, 1.5, 0.4, 2.3, 0, 1.5, -0.4, 1.5, -0.1, 0.6, -0.1];
    const corners = Array.from({ length: 7 }, (_, corner) => new Vector2().fromArray(outline, 2 * corner));
    this.#goalArrow = new Mesh(new ShapeGeometry(new Shape(corners)), this.#goalLook);
    // First over the slope, then to its heading.
    this.#goalArrow.rotation.order = 'ZYX';
    this.group.add(this.#goal, this.#goalArrow, this.#start);
  }

  theme(theme: Theme): void {
    this.#goalLook.color.copy(colour(theme.goal));
    this.#beamLook.color.copy(colour(theme.goal));
    this.#poleLook.color.copy(colour(theme.ink));
    this.#startLook.color.copy(colour(theme.ink));
  }

  show(goal: Goal, start: Heading, height: Height): void {
    this.#at = { goal, start };
    this.settle(height);
  }

  /** Stands both on the ground again, after the ground has changed. */
  settle(height: Height): void {
    if (!this.#at) return;
    const { goal, start } = this.#at;
    // A goal whose place is no number is nowhere.
    this.#goal.visible = Number.isFinite(goal.x);
    this.#goal.position.set(goal.x, goal.y, height(goal.x, goal.y));
    this.#point(goal, height);
    this.#start.position.set(start.x, start.y, height(start.x, start.y));
    this.#start.rotation.z = start.heading_rad;
  }

  /** Lays the arrow of the goal's heading onto the ground around the goal. */
  #point({ x, y, heading_rad }: Goal, height: Height): void {
    this.#goalArrow.visible = heading_rad !== undefined;
    if (heading_rad === undefined) return;
    const [east, north] = [Math.cos(heading_rad), Math.sin(heading_rad)];
    const slope = (ahead: number, left: number) => (height(x + ahead, y + left) - height(x - ahead, y - left)) / 2;
    this.#goalArrow.rotation.set(Math.atan(slope(-north, east)), -Math.atan(slope(east, north)), heading_rad);
    this.#goalArrow.position.set(x, y, height(x, y) + 0.2);
  }

  /** Turns the flag's cloth to the viewer, and keeps it in sight from afar. */
  face({ x, y, z }: Vector): void {
    const { position, rotation, scale } = this.#goal;
    const [east, north] = [x - position.x, y - position.y];
    rotation.z = Math.atan2(north, east) + Math.PI / 2;
    scale.setScalar(Math.max(1, Math.hypot(east, north, z - position.z) / FULL_SIZE_WITHIN_M));
    this.#goalArrow.scale.copy(scale);
  }
}
