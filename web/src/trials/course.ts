/** The course that the page shows now, for other trials on it. */

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
