/** An experiment with something of everything. */

import type { Experiment, Stroke } from '../src/experiment/experiment.ts';

export const STROKE: Stroke = { kind: 'raise', radius_m: 2, strength_m: 0.07, points_cm: [1234, 560, 1240, 575] };

export const EXPERIMENT: Experiment = {
  version: 1,
  name: 'cht-ad',
  terrain: { catalogue: 'cht' },
  strokes: [STROKE, { kind: 'level', radius_m: 1.5, strength_m: 0.1, height_m: -0.5, points_cm: [300, 400] }],
  start: { x: 12, y: 12, heading_rad: 1.5 },
  waypoints: [{ x: 20, y: 31.5 }],
  goal: { x: 14, y: 57 },
  seed: 1,
  preset: 'default',
  learning: 'fixed',
  overrides: {
    planner: { goal_tolerance_m: 0.5, decision: { steepness_weight: 0.8 } },
    sensor: { range_noise_m: 0.02 },
  },
};
