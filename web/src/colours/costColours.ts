/** The colours of one tick's subgoals, the same in the 3D view, the image and the list. */

import type { Subgoal } from '../protocol/simulationProtocol.ts';
import { costColour, type Rgb } from './scale.ts';

/** Gives each candidate its colour; the refused have none, and the goal itself, once chosen, that of the least cost. */
export function costColours(subgoals: readonly Subgoal[]): (one: Subgoal) => Rgb | undefined {
  const totals = subgoals.flatMap(({ cost }) => (cost ? [cost.total] : []));
  const [lowest, highest] = [Math.min(...totals), Math.max(...totals)];
  return (one) => {
    if (one.cost) return costColour(one.cost.total, lowest, highest);
    return one.chosen ? costColour(0, 0, 0) : undefined;
  };
}
