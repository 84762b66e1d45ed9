/** The course that the page shows now, for other trials on it. */

import type { App } from '../app.ts';
import type { Course } from './protocol.ts';

/** Nothing until the first scenario is there. */
export function courseOf(app: App): Course | undefined {
  const { info, ground } = app;
  if (!info || !ground) return undefined;
  const { scenario, overrides, learning, start, waypoints, goal } = info;
  const { columns, rows, cell_m, heights_m } = ground;
  return { scenario, overrides, learning, start, waypoints, goal, ground: { columns, rows, cell_m, heights_m } };
}
