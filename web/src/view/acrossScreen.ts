/** Steps over the ground in the directions of the screen. */

import type { Place } from '../experiment/place.ts';

/** So far to the right and ahead as seen along a heading, whichever way the camera looks. */
export function acrossScreen(heading_rad: number, right_m: number, ahead_m: number): Place {
  const [sin, cos] = [Math.sin(heading_rad), Math.cos(heading_rad)];
  return { x: ahead_m * cos + right_m * sin, y: ahead_m * sin - right_m * cos };
}
