/** Why the robot does what it does, in one sentence. */

import { degrees, fixed } from '../base/format.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import { direction } from './decision.ts';

export function reason(frame: Frame, info: SessionInfo): string {
  const { metrics, stop_reason } = frame;
  switch (frame.outcome) {
    case 'running':
      return activity(frame);
    case 'reached':
      return `At the goal after ${fixed(metrics.distance_m, 1)} m, never beyond a tilt limit.`;
    case 'tilt_limit':
      return metrics.max_abs_roll_rad > info.limits.roll_rad
        ? `Roll came to ${degrees(metrics.max_abs_roll_rad, 1)}; the limit is ${degrees(info.limits.roll_rad, 1)}.`
        : `Pitch came to ${degrees(metrics.max_abs_pitch_rad, 1)}; the limit is ${degrees(info.limits.pitch_rad, 1)}.`;
    case 'collision':
    case 'high_centred':
    case 'step':
      return sentence(stop_reason ?? 'It touched what is in its way');
    case 'stuck':
      return 'It stayed within half a metre for a minute.';
    case 'no_subgoal':
      return stop_reason ? sentence(stop_reason) : 'It found no subgoal.';
    case 'left_terrain':
      return 'A wheel would have left the terrain.';
    case 'timeout':
      return 'Its time ran out: many times what the straight line takes at full speed, and a minute.';
  }
}

function activity({ activity, tick, thought, subgoals, stop_reason }: Frame): string {
  if (tick === 0 && thought === 'run' && !stop_reason)
    return 'At the start: the first scan is there, and no decision yet.';
  if (activity === 'backtracking')
    return 'The ground is steeper than predicted, or no path leads on: backtracks along its own path.';
  if (activity === 'searching') return 'No path is safe enough: turns on the spot and searches for one.';
  if (activity === 'stopped') return stop_reason ? sentence(stop_reason) : 'Stands still.';
  const chosen = subgoals.find((one) => one.chosen);
  if (!chosen) return '';
  if (!chosen.cost) return 'The goal is in sight and the path is clear: drives to it.';
  const candidates = subgoals.filter(({ cost }) => cost).length;
  const bearing = direction(chosen.azimuth_rad);
  const heads = bearing === 'ahead' ? 'Straight ahead' : `Heads ${bearing}`;
  return candidates === 1 ? `${heads}: the only candidate.` : `${heads}: the cheapest of ${candidates} candidates.`;
}

function sentence(text: string): string {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;
}
