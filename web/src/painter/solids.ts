/** What stands and walks on the ground. */

import {
  BoxGeometry,
  type BufferGeometry,
  Color,
  CylinderGeometry,
  Group,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import type { Theme } from '../colours/theme.ts';
import { type WorldObject, walkOf } from '../experiment/objects.ts';
import type { Place } from '../experiment/place.ts';
import type { Solid } from '../protocol/simulationProtocol.ts';
import { MoverShadows } from './moverShadows.ts';
import { colour } from './relief.ts';
import { ThickLines } from './thickLines.ts';

/** Each of a size of one metre along every axis. */
const SHAPES: Record<Solid['shape'], BufferGeometry> = {
  box: new BoxGeometry(1, 1, 1),
  cylinder: new CylinderGeometry(0.5, 0.5, 1, 24).rotateX(Math.PI / 2),
  ball: new SphereGeometry(0.5, 24, 16),
};
const UP = new Vector3(0, 0, 1);
const LIFT_M = 0.06;
const WALK_STEP_M = 0.5;
const MOST_WALK_PIECES = 2048;

type Height = (x: number, y: number) => number;

export class Solids {
  readonly group = new Group();
  readonly #look = new MeshStandardMaterial({ roughness: 0.85 });
  readonly #meshes = new Map<Solid['shape'], InstancedMesh>();
  readonly #shadows = new MoverShadows();
  readonly #walks = new ThickLines(MOST_WALK_PIECES, 2, 0.7);
  #objects: readonly WorldObject[] = [];
  #standing: readonly Solid[] = [];
  #walking: readonly Solid[] = [];
  #held: number | undefined;
  #by: Place = { x: 0, y: 0 };
  #height: Height = () => 0;
  #stands = new Color();
  #walksIn = new Color();
  #heldIn = new Color();

  constructor() {
    this.group.add(this.#walks.line, this.#shadows.mesh);
    this.#walks.line.visible = false;
  }

  theme(theme: Theme): void {
    this.#stands = colour(theme.object);
    this.#walksIn = colour(theme.mover);
    this.#heldIn = colour(theme.held);
    this.#draw();
    this.#drawWalks();
  }

  /** What is on the ground now, and the shapes of those that stand. */
  stand(objects: readonly WorldObject[], solids: readonly Solid[], height: Height): void {
    [this.#objects, this.#standing, this.#height] = [objects, solids, height];
    this.#by = { x: 0, y: 0 };
    this.#draw();
    this.#drawWalks();
  }

  /** The shapes of those that walk. */
  walk(solids: readonly Solid[]): void {
    if (solids.length === 0 && this.#walking.length === 0) return;
    this.#walking = solids;
    this.#shadows.show(solids, this.#height);
    this.#draw();
  }

  hold(object: number | undefined, by: Place, height: Height): void {
    [this.#held, this.#by, this.#height] = [object, by, height];
    this.#draw();
    this.#drawWalks();
  }

  #draw(): void {
    const solids = [...this.#standing, ...this.#walking];
    for (const shape of Object.keys(SHAPES) as Solid['shape'][]) {
      const alike = solids.filter((solid) => solid.shape === shape);
      const mesh = this.#mesh(shape, alike.length);
      if (!mesh) continue;
      alike.forEach((solid, index) => {
        mesh.setMatrixAt(index, this.#placed(solid));
        mesh.setColorAt(index, this.#colour(solid));
      });
      mesh.count = alike.length;
      mesh.visible = alike.length > 0;
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }

  /** Room for so many; nothing as long as there are none, which needs no shader. */
  #mesh(shape: Solid['shape'], count: number): InstancedMesh | undefined {
    const old = this.#meshes.get(shape);
    if (count <= (old?.instanceMatrix.count ?? 0)) return old;
    if (old) {
      this.group.remove(old);
      old.dispose();
    }
    const mesh = new InstancedMesh(SHAPES[shape], this.#look, 2 * count);
    mesh.frustumCulled = false;
    this.#meshes.set(shape, mesh);
    this.group.add(mesh);
    return mesh;
  }

  #colour({ object }: Solid): Color {
    if (object === this.#held) return this.#heldIn;
    return walkOf(this.#objects[object]).length > 0 ? this.#walksIn : this.#stands;
  }

  #placed({ object, centre_m: [x, y, z], size_m, sin_cos_yaw: [sin, cos] }: Solid): Matrix4 {
    const by = object === this.#held ? this.#by : { x: 0, y: 0 };
    const rise_m = this.#height(x + by.x, y + by.y) - this.#height(x, y);
    return new Matrix4().compose(
      new Vector3(x + by.x, y + by.y, z + rise_m),
      new Quaternion().setFromAxisAngle(UP, Math.atan2(sin, cos)),
      new Vector3(...size_m),
    );
  }

  /** The ways of those that walk, along the ground. */
  #drawWalks(): void {
    this.#walks.clear();
    this.#objects.forEach((object, index) => {
      const by = index === this.#held ? this.#by : { x: 0, y: 0 };
      const corners = walkOf(object);
      const points = corners.slice(0, 1).flatMap((place) => this.#onGround(place, by));
      corners.slice(1).forEach((to, leg) => {
        const from = corners[leg] ?? to;
        const pieces = Math.max(1, Math.ceil(Math.hypot(to.x - from.x, to.y - from.y) / WALK_STEP_M));
        for (let piece = 1; piece <= pieces; piece += 1) {
          const part = piece / pieces;
          const place = { x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y) };
          points.push(...this.#onGround(place, by));
        }
      });
      this.#walks.add(points, index === this.#held ? this.#heldIn : this.#walksIn);
    });
    this.#walks.done();
    this.#walks.line.visible = this.#objects.some((object) => walkOf(object).length > 0);
  }

  #onGround(place: Place, by: Place): number[] {
    const [x, y] = [place.x + by.x, place.y + by.y];
    return [x, y, this.#height(x, y) + LIFT_M];
  }
}
