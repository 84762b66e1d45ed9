/** What a subgoal costs and why a segment carries subgoals or not, in words and numbers. */

import { degrees, fixed, wrap } from '../base/format.ts';
import type { Frame, Segment, SessionInfo, Subgoal, Verdict } from '../protocol/simulationProtocol.ts';
import { direction } from './decision.ts';

export const VERDICT_WORDS: Record<Verdict, string> = {
  valid: 'valid',
  too_narrow: 'too narrow',
  too_steep: 'too steep',
  unknown: 'unknown',
  wall: 'wall',
};

/** Where a subgoal is. */
export function subgoalTitle(one: Subgoal): string {
  if (isGoal(one)) return 'The goal itself';
  const where = direction(one.azimuth_rad);
  return one.segment === undefined ? `Target or frontier, ${where}` : `Subgoal ${where}`;
}

export function subgoalState(one: Subgoal): string {
  if (one.chosen) return 'chosen';
  return one.refusal ? 'refused' : 'candidate';
}

/** What its path promises, or how high it lies where that is all that counts. */
export function subgoalReason(one: Subgoal, { pose }: Frame): string {
  const { forecast } = one;
  if (!forecast) {
    if (isGoal(one)) return 'Nearer than the ground seen in its direction: it is driven to at once.';
    const up_m = one.z - pose.z;
    const height = `${fixed(Math.abs(up_m), 2)} m ${up_m < 0 ? 'lower' : 'higher'} than the robot`;
    return `${height}. The paper judges steepness by this and the robot’s pitch.`;
  }
  const tilt = `roll up to ${degrees(forecast.max_roll_rad)}, pitch up to ${degrees(forecast.max_pitch_rad)}`;
  const reach = `${fixed(forecast.reach_m, 1)} m`;
  if (one.refusal === 'tilt') return `Refused: after ${reach} of path the ground would tilt the robot too far.`;
  if (one.refusal === 'unseen') return `Refused: after ${reach} of path no scan has seen the ground.`;
  const beyond = {
    whole: 'all of it seen.',
    tilt: 'then it gets too steep, so the subgoal lies before that.',
    unseen: 'then no scan has seen the ground, so the subgoal lies before that.',
  }[forecast.end];
  const path = `${fixed(forecast.path_m, 1)} m of path to ${reach} away`;
  return `Forecast: ${path}, ${fixed(forecast.climb_m, 2)} m up and down, ${tilt}; ${beyond}`;
}

/** From which direction to which a segment goes, the left end first, as in the image. */
export function segmentTitle({ begin_rad, end_rad }: Segment): string {
  if (end_rad - begin_rad > 2 * Math.PI - 1e-6) return 'All around';
  const [from, to] = [direction(wrap(end_rad)), direction(wrap(begin_rad))];
  const side = [' left', ' right'].find((one) => from.endsWith(one) && to.endsWith(one)) ?? '';
  return `${from.slice(0, from.length - side.length)} to ${to}`;
}

/** The verdict with the numbers that it follows from. */
export function segmentReason(one: Segment, { demands, occupancy_radius_m }: SessionInfo): string {
  const { robot_width_m, safety_margin_m, max_slope_rad, subgoals_on_unknown } = demands;
  // Near the least width every centimetre counts.
  const width = `${fixed(one.width_m, one.width_m < 3 ? 2 : 1)} m wide`;
  const least_m = robot_width_m + safety_margin_m;
  const most_m = occupancy_radius_m * Math.sin(max_slope_rad);
  const wide = one.width_m > least_m;
  const needed = `more than ${fixed(least_m, 2)} m (robot ${fixed(robot_width_m, 2)} m, margin ${fixed(safety_margin_m, 2)} m)`;
  const height_m = one.height_m ?? Number.NaN;
  const height = `${fixed(Math.abs(height_m), 2)} m ${height_m < 0 ? 'below' : 'above'} the robot’s feet`;
  switch (one.verdict) {
    case 'valid':
      return `${width}, ${height} at ${fixed(occupancy_radius_m, 0)} m: wide enough and not too steep.`;
    case 'too_narrow':
      return `${width}; the robot needs ${needed}.`;
    case 'too_steep':
      return `${height} at ${fixed(occupancy_radius_m, 0)} m; at most ${fixed(most_m, 2)} m (${degrees(max_slope_rad)}) counts as climbable.`;
    case 'unknown': {
      const why = `No return within ${fixed(occupancy_radius_m, 0)} m: a crest or a drop may hide the ground.`;
      if (!subgoals_on_unknown) return `${why} It carries no subgoals.`;
      if (!wide) return `${why} ${width}; subgoals need ${needed}.`;
      return `${why} Its subgoals lie on ground that earlier scans saw.`;
    }
    case 'wall':
      return 'Occupied up to the highest beam, 15° above the sensor’s horizon.';
  }
}

/** The goal itself stands on no segment and is not weighed. */
export function isGoal(one: Subgoal): boolean {
  return one.segment === undefined && one.cost === undefined;
}
