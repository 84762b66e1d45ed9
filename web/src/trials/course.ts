/** The course that the page shows now, for other trials on it. */

import type { Ground, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Course } from './trialsProtocol.ts';

export function courseOf(info: SessionInfo, ground: Ground): Course {
  const { overrides, learning, start, waypoints, goal } = info;
  const { columns, rows, cell_m, heights_m } = ground;
  return { overrides, learning, start, waypoints, goal, ground: { columns, rows, cell_m, heights_m } };
}
