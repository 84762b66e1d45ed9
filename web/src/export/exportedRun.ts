/** A run as its files describe it. */

import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import { MOTION, POSE } from '../run/columns.ts';
import { ACTIVITIES, type RunRecord } from '../run/record.ts';

/** A run as it was at one moment: its files take a while to write, and meanwhile it goes on. */
export interface Run {
  readonly info: SessionInfo;
  /** Where the run stands now: files end there, though the record may know what comes next. */
  readonly frame: Frame;
  readonly record: RunRecord;
  /** World-frame x, y, z of the newest scan's returns: those of the frame go back to the worker. */
  readonly points: Float32Array;
}

/** The trajectory with the columns of `mapless run --out`. The last line is where the robot stands. */
export function trajectoryCsv({ frame, record }: Run): string {
  const lines = [
    'time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,speed_m_s,turn_rate_rad_s,command_speed_m_s,command_turn_rate_rad_s,subgoal_x_m,subgoal_y_m,status',
  ];
  for (let row = 0; row < record.before(frame.tick); row += 1) {
    const motion = MOTION.map((name) => decimals(record.get(row, name)));
    const [x, y] = [record.get(row, 'subgoal_x'), record.get(row, 'subgoal_y')];
    const subgoal = Number.isNaN(x) ? ',' : `${decimals(x)},${decimals(y)}`;
    const activity = ACTIVITIES[record.get(row, 'activity')] ?? '';
    lines.push(`${record.get(row, 'time_s').toFixed(3)},${motion.join(',')},${subgoal},${activity}`);
  }
  const { pose, time_s, v_m_s, omega_rad_s, outcome } = frame;
  const last = [...POSE.map((name) => pose[name]), v_m_s, omega_rad_s].map(decimals);
  lines.push(`${time_s.toFixed(3)},${last.join(',')},,,,,${outcome}`);
  return `${lines.join('\n')}\n`;
}

/** Six decimals, with the sign of a negative zero, as the command line writes them. */
function decimals(value: number): string {
  return Object.is(value, -0) ? '-0.000000' : value.toFixed(6);
}

/** The result as `mapless run --json` prints it; the outcome of a run that has not ended is `running`. */
export function runJson({ info, frame, record }: Run): string {
  const { outcome, stop_reason, metrics, distance_to_goal_m, tick, time_s, digest } = frame;
  const times_ms = Float64Array.from({ length: record.before(frame.tick) }, (_, row) =>
    record.get(row, 'planner_ms'),
  ).sort();
  const result = {
    outcome,
    reason: stop_reason ?? null,
    metrics,
    distance_to_goal_m,
    ticks: tick,
    sim_time_s: time_s,
    planner_ms: { p50: quantile(times_ms, 50), p99: quantile(times_ms, 99) },
    digest,
    warnings: info.warnings,
  };
  return `${JSON.stringify(result, null, 2)}\n`;
}

/** Nearest rank: a time that was measured. */
function quantile(sorted: Float64Array, percent: number): number {
  return sorted[Math.max(Math.ceil((sorted.length * percent) / 100), 1) - 1] ?? 0;
}

/** A name for a file of this run, without extension. */
export function fileName({ info }: Run, what: string): string {
  return `mapless-${info.scenario}-seed${info.seed}-${what}`;
}
