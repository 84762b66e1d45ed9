/** How fast a run may be shown: simulated seconds per second. `Infinity` is as fast as it goes. */
export const SPEEDS: readonly number[] = [0.5, 1, 2, 4, Number.POSITIVE_INFINITY];
