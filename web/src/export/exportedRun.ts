/** A run as its files describe it. */

import { hashOf } from '../experiment/changes.ts';
import { type Experiment, FIRST_SETUP } from '../experiment/experiment.ts';
import { plainName } from '../files/download.ts';
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
  /** Everything that a run from the start depends on. */
  readonly experiment: Experiment;
  /** In what it differs from the scenario that it is named after. */
  readonly changes: readonly string[];
  /** Height of the ground at the goal. */
  readonly goal_z_m: number;
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

/** The result as `mapless run --json` prints it, and what was run; the outcome of a run that has not ended is `running`. */
export function runJson(run: Run): string {
  const { info, frame, record } = run;
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
    run: whatWasRun(run),
  };
  return `${JSON.stringify(result, null, 2)}\n`;
}

/** Nearest rank: a time that was measured. */
function quantile(sorted: Float64Array, percent: number): number {
  return sorted[Math.max(Math.ceil((sorted.length * percent) / 100), 1) - 1] ?? 0;
}

/** What a file says of where it comes from: `experiment` opens in the page, and gives this run unless something changed while it drove. */
export function whatWasRun({ info, frame, experiment, changes }: Run) {
  const { scenario, preset, seed } = info;
  const changed_at_ticks = changesUnderWay(frame);
  return { scenario, planner: preset, seed, changes, changed_at_ticks, experiment };
}

/** The ticks at which ground, objects or route were changed; before the last change of the ground there is no going back. */
function changesUnderWay({ timeline: { first, changes } }: Frame): readonly number[] {
  return [...new Set([first, ...changes])].filter((tick) => tick > 0);
}

/** The same in a line or several, for a picture. */
export function runWords(run: Run): readonly string[] {
  const { scenario, planner, seed, changes, changed_at_ticks } = whatWasRun(run);
  const during = changed_at_ticks.length > 0 ? [`changed during the run, at tick ${changed_at_ticks.join(', ')}`] : [];
  return [
    `scenario ${scenario}, planner ${planner}, seed ${seed}`,
    ...changes,
    ...during,
    `digest ${run.frame.digest}`,
  ];
}

/** A name for a file of this run. Where the scenario's name does not say what was run, it has a hash of the experiment. */
export function fileName({ info, experiment, changes, frame }: Run, what: string): string {
  const { scenario, preset, seed } = info;
  const planner = preset === FIRST_SETUP.preset ? '' : `-${preset}`;
  const changed = changes.length > 0 || changesUnderWay(frame).length > 0;
  return `mapless-${plainName(scenario)}${planner}-seed${seed}${changed ? `-changed-${hashOf(experiment)}` : ''}-${what}`;
}
