/** An experiment with something of everything. */

import type { Experiment, Stroke } from '../src/experiment/experiment.ts';
import type { WorldObject } from '../src/experiment/objects.ts';

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

export const OBJECTS: readonly WorldObject[] = [
  { kind: 'post', at: [5, 1], radius_m: 0.25, height_m: 1.7, walk: { path: [[5, 5]], speed_m_s: 0.8 } },
  { kind: 'box', at: [8, 8], size_m: [1, 2, 0.5], yaw_rad: 0.5, raised_m: 0.2 },
  { kind: 'rock', at: [9, 3], radius_m: 0.4, sunk_m: 0.1 },
  { kind: 'wall', from: [1, 2], to: [4, 2], height_m: 1, thickness_m: 0.3 },
  { kind: 'gate', at: [7, 2], yaw_rad: 1.5, width_m: 1.6, height_m: 1.6 },
  { kind: 'roof', at: [7, 12], size_m: [3, 3, 0.2], yaw_rad: 0.1, height_m: 2 },
];
