/** Where a run went for another subgoal than just before, and why. */

import { wrap } from '../base/format.ts';
import { direction } from '../inspector/decision.ts';
import { VERDICT_WORDS } from '../inspector/explain.ts';
import type { Frame, Subgoal } from '../protocol/simulationProtocol.ts';
import type { RunRecord } from '../run/record.ts';
import { segmentAt } from '../scene/selection.ts';
import { dearerBy } from './dearer.ts';

/** A subgoal that moved no farther in one tick is the same one, seen from farther on. */
const SAME_WITHIN_M = 1.5;

/** The tick of the next decision, or of the one before, for another subgoal; `shown` is the tick that is shown, `first` the earliest that can be. */
export function changeOfMind(record: RunRecord, shown: number, by: 1 | -1, first: number): number | undefined {
  const begin = record.length > 0 ? record.get(0, 'tick') : 0;
  // What is shown at a tick was decided in the one before.
  for (let row = shown - begin + (by > 0 ? 0 : -2); row >= 1 && row < record.length; row += by) {
    const tick = record.get(row, 'tick');
    if (tick <= first) return undefined;
    const moved = Math.hypot(
      record.get(row, 'subgoal_x') - record.get(row - 1, 'subgoal_x'),
      record.get(row, 'subgoal_y') - record.get(row - 1, 'subgoal_y'),
    );
    if (moved > SAME_WITHIN_M) return tick;
  }
  return undefined;
}

/** Why what was chosen before is not any more, in a sentence. */
export function whatChangedIt(former: Subgoal | undefined, before: Frame, now: Frame): string {
  const chosen = now.subgoals.find((one) => one.chosen);
  if (!former || !chosen) return 'Nothing was chosen before or after.';
  const turn_rad = before.pose.yaw - now.pose.yaw;
  const from = direction(wrap(former.azimuth_rad + turn_rad));
  const words = `From ${from} to ${direction(chosen.azimuth_rad)}`;
  const apart = (one: Subgoal) => Math.hypot(one.x - former.x, one.y - former.y);
  const same = now.subgoals
    .filter((one) => one !== chosen && apart(one) < SAME_WITHIN_M)
    .sort((a, b) => apart(a) - apart(b))[0];
  if (!same) {
    const segment = now.segments[segmentAt(now, wrap(former.azimuth_rad + turn_rad)) ?? -1];
    const verdict = segment && segment.verdict !== 'valid' ? `: its segment is ${VERDICT_WORDS[segment.verdict]}` : '';
    return `${words}: no subgoal stands there any more${verdict}.`;
  }
  if (same.refusal === 'tilt') return `${words}: the path to the former would tilt the robot too far.`;
  if (same.refusal === 'unseen') return `${words}: no scan has seen the ground on the way to the former.`;
  const [theirs, ours] = [same.cost, chosen.cost];
  if (!theirs || !ours) return `${words}: the goal itself is not weighed.`;
  return `${words}: the former is dearer by ${dearerBy(theirs, ours)}.`;
}
