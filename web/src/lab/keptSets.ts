/** Parameter sets that somebody keeps, to drive as ghosts beside others. This tab of the browser notes them, so that they outlast a reload. */

import { readSetup } from '../experiment/readExperiment.ts';
import type { Setup } from '../experiment/setting.ts';
import { SET_RIVALS } from './planners.ts';

const NOTE = 'mapless-kept-parameters';

export class KeptSets {
  readonly #sets = new Map<string, Setup>(noted());

  /** Which one a ghost drives with, if it is a set at all and one was kept. */
  get(planner: string): Setup | undefined {
    return this.#sets.get(planner);
  }

  keep(planner: string, { preset, learning, overrides }: Setup): void {
    this.#sets.set(planner, { preset, learning, overrides });
    try {
      sessionStorage.setItem(NOTE, JSON.stringify(Object.fromEntries(this.#sets)));
    } catch {
      // A browser may keep nothing: then they are there until a reload.
    }
  }
}

/** What cannot be read is as if it were not there: somebody else may have written it. */
function noted(): [string, Setup][] {
  try {
    const all = JSON.parse(sessionStorage.getItem(NOTE) ?? '{}') as Readonly<Record<string, unknown>>;
    return SET_RIVALS.flatMap(({ planner }): [string, Setup][] =>
      all[planner] === undefined ? [] : [[planner, readSetup(all[planner], planner)]],
    );
  } catch {
    return [];
  }
}
