/** Other robots on the same course: translucent, each in its colour with its trail. */

import { Group, Mesh, MeshStandardMaterial } from 'three';
import type { Pose } from '../core/protocol.ts';
import { Husky } from './husky.ts';
import { Route } from './route.ts';

const OPACITY = 0.5;

/** One of them: its poses by tick, as rows of x, y, z, roll, pitch, yaw. */
export interface GhostTrack {
  readonly colour: string;
  pose(tick: number): Pose | undefined;
}

interface Ghost {
  readonly track: GhostTrack;
  readonly husky: Husky;
  readonly look: MeshStandardMaterial;
  readonly route: Route;
  /** The newest tick that is drawn. */
  tick: number;
}

export class Ghosts {
  readonly group = new Group();
  #ghosts: Ghost[] = [];

  /** Takes these in place of those before. */
  set(tracks: readonly GhostTrack[], sensorHeight_m: number): void {
    for (const { husky, look, route } of this.#ghosts) {
      this.group.remove(husky.group, route.line);
      husky.group.traverse((part) => {
        if (part instanceof Mesh) part.geometry.dispose();
      });
      look.dispose();
      route.line.geometry.dispose();
    }
    this.#ghosts = tracks.map((track) => {
      const look = new MeshStandardMaterial({
        color: track.colour,
        transparent: true,
        opacity: OPACITY,
        roughness: 0.7,
      });
      const husky = new Husky();
      husky.mast(sensorHeight_m);
      husky.group.traverse((part) => {
        if (part instanceof Mesh) part.material = look;
      });
      husky.group.visible = false;
      const route = new Route(0.8);
      route.paint(track.colour);
      this.group.add(husky.group, route.line);
      return { track, husky, look, route, tick: -1 };
    });
  }

  /** Shows where each stood at its tick. */
  show(ticks: readonly number[]): void {
    for (const [index, ghost] of this.#ghosts.entries()) {
      const tick = ticks[index] ?? -1;
      if (tick < ghost.tick) {
        ghost.route.clear();
        ghost.tick = -1;
      }
      const places: number[] = [];
      for (let at = ghost.tick + 1; at <= tick; at += 1) {
        const { x, y, z } = ghost.track.pose(at) ?? {};
        if (x !== undefined && y !== undefined && z !== undefined) places.push(x, y, z);
      }
      ghost.route.extend(new Float32Array(places));
      ghost.tick = tick;
      const pose = ghost.track.pose(tick);
      ghost.husky.group.visible = pose !== undefined;
      if (pose) ghost.husky.pose(pose);
    }
  }
}
