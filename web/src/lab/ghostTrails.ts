/** What each ghost has driven since it was last shown. */

import type { GhostStep } from '../painter/painterProtocol.ts';
import type { GhostRun } from '../trials/ghostRun.ts';

export class GhostTrails {
  #ghosts: { readonly run: GhostRun; tick: number }[] = [];

  /** Takes these in place of those before. */
  set(runs: readonly GhostRun[]): void {
    this.#ghosts = runs.map((run) => ({ run, tick: -1 }));
  }

  /** How each gets to its tick. */
  steps(ticks: readonly number[]): GhostStep[] {
    return this.#ghosts.map((ghost, index) => {
      const tick = ticks[index] ?? -1;
      const anew = tick < ghost.tick;
      const places: number[] = [];
      for (let at = anew ? 0 : ghost.tick + 1; at <= tick; at += 1) {
        const { x, y, z } = ghost.run.pose(at) ?? {};
        if (x !== undefined && y !== undefined && z !== undefined) places.push(x, y, z);
      }
      ghost.tick = tick;
      return { pose: ghost.run.pose(tick), path: new Float32Array(places), anew };
    });
  }
}
