/** The shadows of those that walk: the relief's own are computed once, these move with each frame. */

import { CircleGeometry, InstancedMesh, Matrix4, MeshBasicMaterial, Vector3 } from 'three';
import type { Solid } from '../protocol/simulationProtocol.ts';
import { SUN } from './sunlight.ts';

const LIFT_M = 0.03;
const MOST = 256;
/** As dark as the relief's own. */
const DARKNESS = 0.5;

export class MoverShadows {
  readonly mesh = new InstancedMesh(
    new CircleGeometry(0.5, 24),
    new MeshBasicMaterial({ color: 0, transparent: true, opacity: DARKNESS, depthWrite: false }),
    MOST,
  );

  constructor() {
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  show(solids: readonly Solid[], height: (x: number, y: number) => number): void {
    const cast = solids.slice(0, MOST);
    for (const [index, solid] of cast.entries()) this.mesh.setMatrixAt(index, shadow(solid, height));
    this.mesh.count = cast.length;
    this.mesh.visible = cast.length > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
  }
}

/** An ellipse on the ground, from the foot to where the top's shadow falls. */
function shadow({ centre_m: [x, y, z], size_m }: Solid, height: (x: number, y: number) => number): Matrix4 {
  const [east, north, up] = SUN;
  const top_m = z + size_m[2] / 2;
  const reach = Math.max(top_m - height(x, y), 0) / up;
  const on = (px: number, py: number) => new Vector3(px, py, height(px, py) + LIFT_M);
  const [foot, tip] = [on(x, y), on(x - reach * east, y - reach * north)];
  const along = tip.clone().sub(foot);
  const middle = foot.clone().addScaledVector(along, 0.5);
  const width_m = Math.max(size_m[0], size_m[1]);
  // Across the sun's way, as the ground lies there.
  const flat = Math.hypot(east, north);
  const [ax, ay] = [(north / flat) * (width_m / 2), (-east / flat) * (width_m / 2)];
  const across = on(middle.x + ax, middle.y + ay).sub(on(middle.x - ax, middle.y - ay));
  along.setLength(along.length() + width_m);
  const normal = new Vector3().crossVectors(along, across).normalize();
  return new Matrix4().makeBasis(along, across, normal).setPosition(middle);
}
