/** What a ghost is compared with: the robot in view at the same tick. */

import type { Frame, Metrics } from '../protocol/simulationProtocol.ts';
import type { RunRecord } from '../run/record.ts';
import type { GhostRun } from '../trials/ghostRun.ts';
import type { TrialResult } from '../trials/trialsProtocol.ts';

/** Whether a ghost has yet to drive to where the robot in view is. */
export function isBehind(ghost: Pick<TrialResult, 'outcome' | 'tick'>, frame: Pick<Frame, 'tick'>): boolean {
  return ghost.outcome === 'running' && ghost.tick < frame.tick;
}

/** The metrics of the robot in view to compare a ghost's with; nothing where the record no longer has them. */
export function counterpart(
  ghost: Pick<TrialResult, 'outcome' | 'tick'>,
  frame: Pick<Frame, 'tick' | 'metrics'>,
  record: RunRecord,
): Metrics | undefined {
  return isBehind(ghost, frame) ? record.metricsAt(ghost.tick) : frame.metrics;
}

/** Once the page's robot has ended, those that are still on their way are shown as far as they are. */
export function shownTick(
  { lastTick }: Pick<GhostRun, 'lastTick'>,
  { outcome, tick }: Pick<Frame, 'outcome' | 'tick'>,
): number {
  return outcome === 'running' ? Math.min(tick, lastTick) : lastTick;
}
