/** What the page and a worker that runs whole trials say to each other. A worker has one job and is then ended. */

import type { WorldObject } from '../experiment/objects.ts';
import type { Overrides } from '../experiment/overrides.ts';
import type { Goal, Heading, Place } from '../experiment/place.ts';
import type { Learning, Preset } from '../experiment/setting.ts';
import type { Ground, Metrics, Outcome } from '../protocol/simulationProtocol.ts';
import { METRICS, POSE } from '../run/columns.ts';
import type { Spread, TrialStatus } from '../wasm/mapless_wasm_baselines.js';

/** In place of a planner's name: somebody's own, which is asked through a port. */
export const OWN_PLANNER = 'own';

/** Everything that all trials of a job have in common. */
export interface Course {
  readonly preset: Preset;
  readonly overrides: Overrides;
  readonly learning: Learning;
  readonly start: Heading;
  readonly waypoints: readonly Place[];
  readonly goal: Goal;
  readonly objects: readonly WorldObject[];
  readonly ground: Ground;
}

/** Who drives on a course. */
export interface Rider {
  /** By which its trial is told from others. */
  readonly name: string;
  readonly planner: string;
  readonly learning: Learning;
  readonly overrides: Overrides;
}

export interface TrialResult {
  /** The rider's name. */
  readonly planner: string;
  readonly seed: number;
  readonly outcome: Outcome;
  readonly tick: number;
  readonly time_s: number;
  readonly metrics: Metrics;
  readonly digest: string;
}

export type Job =
  /** Several on the course, no farther than asked for. */
  | { type: 'ghosts'; course: Course; riders: readonly Rider[]; seed: number }
  /** Somebody's own planner on the course, no farther than asked for. */
  | { type: 'own'; course: Course; seed: number; port: MessagePort }
  /** One planner with the seeds that are then given, each to its end. */
  | { type: 'seeds'; course: Course; planner: string };

export type ToTrials =
  | Job
  | { type: 'until'; tick: number }
  /** In place of the ghosts before: whoever has the name of one drives on. */
  | { type: 'riders'; riders: readonly Rider[] }
  | { type: 'drive'; seed: number }
  /** Asks for what these trials show together, whoever drove them. */
  | { type: 'sum'; results: readonly TrialResult[] };

/** What is known of a ghost at one tick. */
export const ROW = ['tick', 'time_s', ...POSE, ...METRICS] as const;

export function rowOf({ tick, time_s, pose, metrics }: TrialStatus): number[] {
  return [tick, time_s, ...POSE.map((name) => pose[name]), ...METRICS.map((name) => metrics[name])];
}

/** Mean and standard deviation over the trials that reached the goal; NaN where there is none. */
export interface Summary {
  readonly reached: number;
  readonly trials: number;
  /** Wilson's 95 % interval of the share that reaches the goal. */
  readonly low: number;
  readonly high: number;
  readonly metrics: Readonly<Record<keyof Metrics, Spread>>;
}

export type FromTrials =
  /** A ghost's rows since the message before, and how it stands now. */
  | { type: 'ghost'; rows: Float64Array<ArrayBuffer>; result: TrialResult }
  /** How long somebody's own planner takes for a decision in the mean. */
  | { type: 'took'; decision_ms: number }
  | { type: 'trial'; result: TrialResult }
  | { type: 'summary'; summary: Summary }
  /** One that cannot drive this course, by its name. */
  | { type: 'refused'; planner: string; message: string }
  /** After a panic the worker is of no more use; another one may be. */
  | { type: 'failed'; message: string; panicked: boolean };
