/** What the 3D view shows of the ground and of what the planner computes. */

export const COLOURINGS = ['elevation', 'slope', 'stand'] as const;
/** By what the ground is coloured. */
export type Colouring = (typeof COLOURINGS)[number];
/** Slopes from here on have the last colour: nearly twice what a Husky stands on. */
export const STEEPEST_SHOWN_RAD = (40 * Math.PI) / 180;
/** Returns coloured by range have the last colour from here on. */
export const FARTHEST_RANGE_M = 20;

export const POINT_COLOURS = ['use', 'range', 'height', 'ring', 'none'] as const;
/** `use` sets the returns that the planner takes off from the others; `none` hides them all. */
export type PointColours = (typeof POINT_COLOURS)[number];

/** The surfaces around the robot, from the inner to the outer one. */
export const SURFACES = ['observed', 'occupancy', 'variance'] as const;
export type Surface = (typeof SURFACES)[number];

export interface Layers {
  readonly points: PointColours;
  readonly observed: boolean;
  readonly occupancy: boolean;
  readonly variance: boolean;
  readonly segments: boolean;
  readonly subgoals: boolean;
  /** The planned path to the chosen subgoal. */
  readonly path: boolean;
}

export const FIRST_LAYERS: Layers = {
  points: 'use',
  observed: false,
  occupancy: false,
  variance: false,
  segments: false,
  subgoals: true,
  path: true,
};

/** Whether the layers need the surfaces that the worker predicts on demand. */
export function needsSurfaces(layers: Layers): boolean {
  return SURFACES.some((surface) => layers[surface]);
}
