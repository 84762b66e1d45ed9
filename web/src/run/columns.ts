/** Numbers that are kept in rows, one for each tick, by their names. */

import type { Metrics, Pose } from '../protocol/simulationProtocol.ts';

export const POSE = ['x', 'y', 'z', 'roll', 'pitch', 'yaw'] as const satisfies readonly (keyof Pose)[];

/** Pose, speed and turn rate, and what was commanded. */
export const MOTION = [...POSE, 'v_m_s', 'omega_rad_s', 'command_v_m_s', 'command_omega_rad_s'] as const;

/** The paper's six metrics. */
export const METRICS = [
  'distance_m',
  'max_abs_roll_rad',
  'max_abs_pitch_rad',
  'mean_vibration_rad_s',
  'mean_elevation_rate_cm_s',
  'curvature_change_rad_m',
] as const satisfies readonly (keyof Metrics)[];
