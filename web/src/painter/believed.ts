/** Where the robot believes to be: a translucent robot with an outline that shows through everything. */

import { Group, MeshStandardMaterial } from 'three';
import type { Theme } from '../colours/theme.ts';
import type { Mount, Pose } from '../protocol/simulationProtocol.ts';
import { Husky } from './husky.ts';
import { colour } from './relief.ts';
import { ThickLines } from './thickLines.ts';

const OPACITY = 0.2;
/** The box of a Husky from belly to deck, and the wedge on it that tells where ahead is. */
const BOX_M = { ahead: 0.49, left: 0.34, low: 0.1, high: 0.38 };
const WEDGE_M = 0.28;

export class Believed {
  readonly group = new Group();
  readonly #husky = new Husky();
  readonly #look = new MeshStandardMaterial({ transparent: true, opacity: OPACITY, roughness: 0.7, depthWrite: false });
  readonly #outline = new ThickLines(16, 1.8);

  constructor() {
    this.#outline.line.material.depthTest = false;
    this.#outline.line.renderOrder = 1;
    this.group.add(this.#husky.group, this.#outline.line);
    this.group.visible = false;
  }

  theme(theme: Theme): void {
    this.#look.color.copy(colour(theme.believed));
    this.#outline.clear();
    for (const line of OUTLINE) this.#outline.add(line, this.#look.color);
    this.#outline.done();
  }

  mount(mount: Mount): void {
    this.#husky.mount(mount);
    this.#husky.wear(this.#look);
  }

  /** Nothing where it cannot err, and where the camera is in its eye. */
  show(pose: Pose | undefined): void {
    this.group.visible = pose !== undefined;
    if (!pose) return;
    this.#husky.pose(pose);
    this.#outline.line.position.copy(this.#husky.group.position);
    this.#outline.line.rotation.copy(this.#husky.group.rotation);
  }
}

/** Lines as x, y, z of their corners. */
const OUTLINE: readonly (readonly number[])[] = (() => {
  const { ahead, left, low, high } = BOX_M;
  const round = (z: number) => [ahead, left, z, -ahead, left, z, -ahead, -left, z, ahead, -left, z, ahead, left, z];
  const uprights = [1, -1].flatMap((x) => [1, -1].map((y) => [x * ahead, y * left, low, x * ahead, y * left, high]));
  return [round(low), round(high), ...uprights, [ahead, left, high, ahead + WEDGE_M, 0, high, ahead, -left, high]];
})();
