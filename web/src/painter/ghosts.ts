/** Other robots on the same course: translucent, each in its colour with its trail. */

import { Group, Mesh, MeshStandardMaterial } from 'three';
import type { Mount } from '../protocol/simulationProtocol.ts';
import { Husky } from './husky.ts';
import type { GhostStep } from './painterProtocol.ts';
import { Route } from './route.ts';

const OPACITY = 0.5;

interface Ghost {
  readonly husky: Husky;
  readonly look: MeshStandardMaterial;
  readonly route: Route;
}

export class Ghosts {
  readonly group = new Group();
  #ghosts: Ghost[] = [];

  /** Takes these in place of those before, each in its colour. */
  set(colours: readonly string[], mount: Mount | undefined): void {
    for (const { husky, look, route } of this.#ghosts) {
      this.group.remove(husky.group, route.line);
      husky.group.traverse((part) => {
        if (part instanceof Mesh) part.geometry.dispose();
      });
      look.dispose();
      route.line.geometry.dispose();
    }
    this.#ghosts = colours.map((colour) => {
      const look = new MeshStandardMaterial({
        color: colour,
        transparent: true,
        opacity: OPACITY,
        roughness: 0.7,
      });
      const husky = new Husky();
      if (mount) husky.mount(mount);
      husky.wear(look);
      husky.group.visible = false;
      const route = new Route(0.8);
      route.paint(colour);
      this.group.add(husky.group, route.line);
      return { husky, look, route };
    });
  }

  /** Has each go on by its step. */
  show(steps: readonly GhostStep[]): void {
    for (const [index, { husky, route }] of this.#ghosts.entries()) {
      const { pose, path, anew } = steps[index] ?? {};
      if (anew) route.clear();
      if (path) route.extend(path);
      husky.group.visible = pose !== undefined;
      if (pose) husky.pose(pose);
    }
  }
}
