/** Candidate subgoals as spheres coloured by cost; the chosen one is larger, on a stem, and joined to the robot by a line. */

import {
  Color,
  CylinderGeometry,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  TorusGeometry,
  type Vector3,
} from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { costColours } from '../colours/costColours.ts';
import type { Theme } from '../colours/theme.ts';
import type { Subgoal } from '../protocol/simulationProtocol.ts';
import { colour } from './relief.ts';

const CAPACITY = 256;
const REFUSED = new Color(0x7d8590);
/** Place in the order of drawing of what must not be veiled. */
export const MARKS_ORDER = 10;

export class Subgoals {
  readonly group = new Group();
  readonly #spheres = new InstancedMesh(new SphereGeometry(1, 18, 12), new MeshBasicMaterial(), CAPACITY);
  readonly #rims = new InstancedMesh(new SphereGeometry(1, 18, 12), new MeshBasicMaterial({ side: 1 }), CAPACITY);
  readonly #halo = new Mesh(new TorusGeometry(0.46, 0.045, 8, 40), new MeshBasicMaterial());
  readonly #stem = new Mesh(new CylinderGeometry(0.025, 0.025, 1, 6).rotateX(Math.PI / 2), new MeshBasicMaterial());
  readonly #lineMaterial = new LineMaterial({
    linewidth: 2.5,
    dashed: true,
    dashSize: 0.28,
    gapSize: 0.2,
    transparent: true,
  });
  readonly #line = new Line2(new LineGeometry(), this.#lineMaterial);
  readonly #matrix = new Matrix4();
  #target: Subgoal | undefined;

  constructor() {
    this.#spheres.setColorAt(0, REFUSED);
    // Drawn after the surfaces around the robot, which would veil them.
    for (const mark of [this.#rims, this.#spheres, this.#halo, this.#stem]) {
      mark.material.transparent = true;
      mark.renderOrder = MARKS_ORDER;
    }
    this.#line.renderOrder = MARKS_ORDER;
    this.#spheres.frustumCulled = false;
    this.#rims.frustumCulled = false;
    this.#line.frustumCulled = false;
    this.group.add(this.#rims, this.#spheres, this.#halo, this.#stem, this.#line);
    this.show([], () => 0);
  }

  theme(theme: Theme): void {
    const ink = colour(theme.ink);
    this.#halo.material.color.copy(ink);
    this.#stem.material.color.copy(ink);
    this.#lineMaterial.color.copy(ink);
    // A dark rim sets the spheres off from ground of any colour.
    this.#rims.material.color.set(0x0d1014);
  }

  show(subgoals: readonly Subgoal[], groundHeight: (x: number, y: number) => number): void {
    const colourOf = costColours(subgoals);
    const shown = subgoals.slice(0, CAPACITY);
    shown.forEach((one, index) => {
      const cost = colourOf(one);
      const radius_m = one.chosen ? 0.26 : cost ? 0.17 : 0.1;
      // Half-sunk markers would look smaller than they are: each stands on the ground or on its own height above it.
      const z = Math.max(one.z, groundHeight(one.x, one.y) + radius_m);
      this.#matrix.makeScale(radius_m, radius_m, radius_m).setPosition(one.x, one.y, z);
      this.#spheres.setMatrixAt(index, this.#matrix);
      this.#spheres.setColorAt(index, cost ? colour(cost) : REFUSED);
      const rim_m = radius_m + 0.035;
      this.#matrix.makeScale(rim_m, rim_m, rim_m).setPosition(one.x, one.y, z);
      this.#rims.setMatrixAt(index, this.#matrix);
    });
    for (const mesh of [this.#spheres, this.#rims]) {
      mesh.count = shown.length;
      mesh.instanceMatrix.needsUpdate = true;
    }
    if (this.#spheres.instanceColor) this.#spheres.instanceColor.needsUpdate = true;
    this.#target = shown.find((one) => one.chosen);
    for (const mark of [this.#halo, this.#stem, this.#line]) mark.visible = this.#target !== undefined;
    if (!this.#target) return;
    const { x, y, z } = this.#target;
    const floor = groundHeight(x, y);
    const top = Math.max(z, floor + 0.26);
    this.#halo.position.set(x, y, top);
    this.#stem.position.set(x, y, (floor + top) / 2);
    this.#stem.scale.set(1, 1, Math.max(top - floor, 0.01));
  }

  /** Keeps the line attached to the moving robot and the halo facing the viewer. */
  attach(sensor: Vector3, camera: Vector3): void {
    if (!this.#target) return;
    const end = this.#halo.position;
    this.#line.geometry.setPositions([sensor.x, sensor.y, sensor.z, end.x, end.y, end.z]);
    this.#line.computeLineDistances();
    this.#halo.lookAt(camera);
  }
}
