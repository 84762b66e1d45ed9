/** A low-polygon Clearpath Husky A200 with a VLP-16 on a mast. Origin: ground contact under the centre; x forward, y left, z up. */

import {
  BoxGeometry,
  BufferGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshStandardMaterial,
  TorusGeometry,
} from 'three';
import type { Mount, Pose } from '../protocol/simulationProtocol.ts';

const WHEEL_RADIUS_M = 0.165;
const HALF_WHEELBASE_M = 0.256;
const HALF_TRACK_M = 0.2855;
const WHEEL_WIDTH_M = 0.115;
const DECK_M = 0.36;

const material = (colour: number, roughness: number, metalness = 0) =>
  new MeshStandardMaterial({ color: colour, roughness, metalness, flatShading: true });
const YELLOW = material(0xffc414, 0.5);
const BLACK = material(0x17191c, 0.75);
const DARK = material(0x2a2e33, 0.7);
const STEEL = material(0x9aa3ad, 0.35, 0.6);
const RUBBER = material(0x121315, 0.95);
const LENS = material(0x0a1a22, 0.15, 0.4);

export class Husky {
  readonly group = new Group();
  readonly #wheels: Group[] = [];
  readonly #mast = new Group();

  constructor() {
    this.group.rotation.order = 'ZYX';
    this.#chassis();
    this.group.add(this.#mast);
    for (const x of [HALF_WHEELBASE_M, -HALF_WHEELBASE_M]) {
      for (const y of [HALF_TRACK_M, -HALF_TRACK_M]) this.#wheel(x, y);
    }
  }

  /** Has all of it look alike; a new mount does not. */
  wear(look: MeshStandardMaterial): void {
    this.group.traverse((part) => {
      if (part instanceof Mesh) part.material = look;
    });
  }

  pose({ x, y, z, roll, pitch, yaw }: Pose): void {
    this.group.position.set(x, y, z);
    // Positive pitch lifts the nose, which is a negative turn about the left-pointing y axis.
    this.group.rotation.set(roll, -pitch, yaw);
  }

  /** Turns the wheels by the distance driven and the turn made. */
  roll(forward_m: number, turn_rad: number): void {
    for (const wheel of this.#wheels) {
      const arc_m = forward_m - turn_rad * wheel.position.y;
      wheel.rotation.y += arc_m / WHEEL_RADIUS_M;
    }
  }

  #add(geometry: BufferGeometry, look: MeshStandardMaterial, x: number, y: number, z: number): void {
    add(this.group, geometry, look, x, y, z);
  }

  #chassis(): void {
    // Side profile of the hull, cut back at nose and tail.
    const outline = [
      [-0.43, 0.17],
      [-0.36, 0.13],
      [0.36, 0.13],
      [0.43, 0.17],
      [0.43, 0.27],
      [0.37, 0.33],
      [-0.37, 0.33],
      [-0.43, 0.27],
    ] as const;
    this.#add(prism(outline, 0.42), DARK, 0, 0, 0);
    this.#add(new BoxGeometry(0.7, 0.44, 0.035), YELLOW, 0, 0, 0.345);
    this.#add(new BoxGeometry(0.3, 0.3, 0.014), BLACK, -0.12, 0, 0.368);
    for (const end of [1, -1]) {
      this.#add(new BoxGeometry(0.05, 0.52, 0.1), BLACK, 0.462 * end, 0, 0.225);
      this.#add(new BoxGeometry(0.02, 0.3, 0.035), YELLOW, 0.482 * end, 0, 0.255);
    }
    for (const side of [1, -1]) {
      this.#add(new BoxGeometry(0.78, 0.075, 0.03), YELLOW, 0, 0.262 * side, 0.352);
      this.#add(new BoxGeometry(0.86, 0.016, 0.026), BLACK, 0, 0.302 * side, 0.352);
    }
  }

  /** Puts the sensor where it is mounted and as it is turned there, with a mast under it. */
  mount({ forward_m, left_m, height_m, roll_rad, pitch_rad, yaw_rad }: Mount): void {
    this.#mast.traverse((part) => {
      if (part instanceof Mesh) part.geometry.dispose();
    });
    const mast = this.#mast.clear();
    mast.position.set(forward_m, left_m, 0);
    // Half the sensor's height, and a little room: turned it takes more.
    const turned = Math.abs(Math.sin(pitch_rad)) + Math.abs(Math.sin(roll_rad));
    const plate_m = height_m - 0.048 - 0.06 * Math.min(turned, 1);
    const post_m = plate_m - DECK_M;
    if (post_m > 0) {
      for (const x of [0.11, -0.11]) {
        for (const y of [0.13, -0.13]) {
          add(mast, new BoxGeometry(0.028, 0.028, post_m), STEEL, x, y, DECK_M + post_m / 2);
        }
      }
      add(mast, new BoxGeometry(0.29, 0.33, 0.022), BLACK, 0, 0, plate_m - 0.006);
    }
    const sensor = new Group();
    sensor.position.set(0, 0, height_m);
    sensor.rotation.set(roll_rad, -pitch_rad, yaw_rad, 'ZYX');
    const upright = (geometry: CylinderGeometry, look: MeshStandardMaterial, z: number) => {
      add(sensor, geometry, look, 0, 0, z).rotation.x = Math.PI / 2;
    };
    upright(new CylinderGeometry(0.052, 0.052, 0.018, 24), STEEL, -0.028);
    upright(new CylinderGeometry(0.0515, 0.0515, 0.038, 24), LENS, 0);
    upright(new CylinderGeometry(0.048, 0.052, 0.018, 24), STEEL, 0.028);
    // Its socket tells where up is, the cable where behind is.
    upright(new CylinderGeometry(0.03, 0.036, 0.014, 24), BLACK, -0.042);
    add(sensor, new BoxGeometry(0.03, 0.014, 0.014), BLACK, -0.06, 0, -0.028);
    mast.add(sensor);
  }

  #wheel(x: number, y: number): void {
    const wheel = new Group();
    wheel.position.set(x, y, WHEEL_RADIUS_M);
    const tyre = new TorusGeometry(0.112, 0.053, 8, 22);
    tyre.scale(1, 1, 1.12);
    const parts: [BufferGeometry, MeshStandardMaterial][] = [
      [tyre, RUBBER],
      [new CylinderGeometry(0.098, 0.098, WHEEL_WIDTH_M * 0.8, 10).rotateX(Math.PI / 2), YELLOW],
      [new CylinderGeometry(0.045, 0.045, WHEEL_WIDTH_M, 6).rotateX(Math.PI / 2), BLACK],
    ];
    for (let lug = 0; lug < 11; lug += 1) {
      const angle = (lug / 11) * 2 * Math.PI;
      const tread = new BoxGeometry(0.022, 0.03, WHEEL_WIDTH_M);
      tread.translate(WHEEL_RADIUS_M - 0.009, 0, 0).rotateZ(angle);
      parts.push([tread, RUBBER]);
    }
    for (const [geometry, look] of parts) {
      // Built around z; the axle lies along y.
      geometry.rotateX(Math.PI / 2);
      wheel.add(new Mesh(geometry, look));
    }
    this.#wheels.push(wheel);
    this.group.add(wheel);
  }
}

function add(to: Group, geometry: BufferGeometry, look: MeshStandardMaterial, x: number, y: number, z: number): Mesh {
  const mesh = new Mesh(geometry, look);
  mesh.position.set(x, y, z);
  to.add(mesh);
  return mesh;
}

/** A convex outline in x and z, anticlockwise as seen from the right, across `width_m`. */
function prism(outline: readonly (readonly [number, number])[], width_m: number): BufferGeometry {
  const right = outline.map(([x, z]) => [x, -width_m / 2, z]);
  const left = outline.map(([x, z]) => [x, width_m / 2, z]);
  const corners: (number[] | undefined)[] = [];
  for (let at = 0; at < outline.length; at += 1) {
    const next = (at + 1) % outline.length;
    corners.push(right[at], left[at], left[next], right[at], left[next], right[next]);
    corners.push(right[0], right[at], right[next], left[0], left[next], left[at]);
  }
  const places = corners.flatMap((corner) => corner ?? []);
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(places, 3));
  geometry.computeVertexNormals();
  return geometry;
}
