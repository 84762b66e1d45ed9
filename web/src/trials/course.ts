/** The course that the page shows now, for other trials on it. */

import { type Overrides, withOverride } from '../experiment/overrides.ts';
import type { Ground, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Course } from './trialsProtocol.ts';

export function courseOf(info: SessionInfo, ground: Ground): Course {
  const { preset, overrides, learning, start, waypoints, goal, objects } = info;
  const { columns, rows, cell_m, heights_m } = ground;
  return { preset, overrides, learning, start, waypoints, goal, objects, ground: { columns, rows, cell_m, heights_m } };
}

/** All that trials with other seeds have in common but for the ground, a change of which the page tells by itself. */
export function courseKey({ scenario, preset, learning, overrides, start, waypoints, goal, objects }: SessionInfo) {
  return JSON.stringify([scenario, preset, learning, overrides, start, waypoints, goal, objects]);
}

/** The parameters with the learning among them: a campaign knows no learning but that of its scenario. */
export function drivenWith({ overrides, learning }: Pick<Course, 'overrides' | 'learning'>): Overrides {
  const mode = learning === 'fixed' ? undefined : learning;
  return withOverride(overrides, 'planner.perception.learning', 'mode', mode);
}
