/** A recorded moment as the panels of a run know it. */

import type { Goal } from '../experiment/place.ts';
import type { Frame, FrameBuffers, Metrics, Pose, SessionInfo, Timeline } from '../protocol/simulationProtocol.ts';
import type { RecordedFrame, RecordedScene } from './recordedProtocol.ts';

/** One step of the slider. */
export const PERIOD_S = 0.1;

/** A place that is nowhere: without a goal. */
const NOWHERE: Goal = { x: Number.NaN, y: Number.NaN };

const STATE_WORDS: Record<string, string> = {
  Standby: 'standing by, without a goal',
  Driving: 'driving',
  Paused: 'paused',
  Aborted: 'goal given up',
  Latched: 'stopped until it is reset',
};

/** The supervisor's state in words, with its reason. */
export function stateWords({ state, reason, cause }: Pick<RecordedFrame, 'state' | 'reason' | 'cause'>): string {
  const words = STATE_WORDS[state] ?? 'not decided yet';
  const now = cause && cause !== reason ? `now: ${cause}` : undefined;
  return [words, reason, now].filter((part) => part).join('; ');
}

export function infoOf(name: string, scene: RecordedScene, goal: RecordedFrame['goal'], pose: Pose): SessionInfo {
  const { limits, occupancy_radius_m, mount, image, demands, is_paper } = scene;
  return {
    ...{ limits, occupancy_radius_m, mount, image, demands },
    scenario: name,
    preset: is_paper ? 'paper' : 'default',
    learning: 'fixed',
    seed: 0,
    start: { x: pose.x, y: pose.y, heading_rad: pose.yaw },
    waypoints: [],
    goal: goalOf(goal),
    period_s: PERIOD_S,
    reality: 'own',
    parameters: [],
    overrides: {},
    runsWith: undefined,
    objects: [],
    solids: [],
    warnings: [],
  };
}

export function goalOf(goal: RecordedFrame['goal']): Goal {
  if (!goal) return NOWHERE;
  const { x, y, heading_rad } = goal;
  return heading_rad === undefined ? { x, y } : { x, y, heading_rad };
}

/** What comes from the page: where on the line it is, and the trajectory around it. */
interface Along {
  readonly timeline: Timeline;
  readonly trail: Float32Array<ArrayBuffer>;
  readonly ahead: Float32Array<ArrayBuffer> | undefined;
  readonly anew: boolean;
}

/** `pose` is where the robot is shown. */
export function frameOf(recorded: RecordedFrame, pose: Pose, buffers: FrameBuffers, along: Along): Frame {
  const { goal, command, activity, stop_reason, state } = recorded;
  const stops = state !== 'Driving';
  return {
    ...along,
    tick: Math.round(recorded.time_s / PERIOD_S),
    time_s: recorded.time_s,
    thought: 'run',
    outcome: 'running',
    activity: stops ? 'stopped' : (activity ?? 'stopped'),
    stop_reason: stops ? stateWords(recorded) : stop_reason,
    pose,
    believed: undefined,
    v_m_s: command.v_m_s,
    omega_rad_s: command.omega_rad_s,
    command,
    returns: recorded.returns,
    set_aside: recorded.set_aside,
    mount_misfit: undefined,
    sensor: recorded.sensor,
    threshold: recorded.threshold,
    segments: recorded.segments,
    subgoals: recorded.subgoals,
    path: recorded.path,
    metrics: NO_METRICS,
    distance_to_goal_m: goal ? Math.hypot(goal.x - pose.x, goal.y - pose.y) : Number.NaN,
    digest: '',
    waypoints_passed: 0,
    movers: [],
    surfaces: recorded.surfaces,
    buffers,
    planner_ms: Number.NaN,
    rows: new Float64Array(),
  };
}

/** A recording has none of these. */
const NO_METRICS: Metrics = {
  distance_m: Number.NaN,
  max_abs_roll_rad: Number.NaN,
  max_abs_pitch_rad: Number.NaN,
  mean_vibration_rad_s: Number.NaN,
  mean_elevation_rate_cm_s: Number.NaN,
  curvature_change_rad_m: Number.NaN,
};
