/** The course that the page shows now, for other trials on it. */

import type { App } from '../app/app.ts';
import type { Course } from './trialsProtocol.ts';

/** Nothing until the first scenario is there. */
export function courseOf(app: App): Course | undefined {
  const { info, field } = app;
  if (!info || !field) return undefined;
  const { overrides, learning, start, waypoints, goal } = info;
  const { columns, rows, cell_m, heights_m } = field;
  return { overrides, learning, start, waypoints, goal, ground: { columns, rows, cell_m, heights_m } };
}
