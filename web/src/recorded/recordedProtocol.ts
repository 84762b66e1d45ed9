/** What the page and the worker that reads a recording say to each other. */

import type { FrameBuffers } from '../protocol/simulationProtocol.ts';
import type {
  Change,
  Decided,
  RecordedFrame,
  RecordedScene,
  SupervisorTransition,
  TopicChoice,
} from '../wasm/mapless_wasm_replay.js';

export type { Change, Decided, RecordedFrame, RecordedScene, SupervisorTransition, TopicChoice };

/** What holds for every recording. */
export interface SupervisorInfo {
  readonly transitions: readonly SupervisorTransition[];
  /** Kinds of faults that can be put in. */
  readonly faultKinds: readonly string[];
}

/** Names of topics by their roles. */
export type Topics = Readonly<Record<string, string>>;

/** What was found since the news before, as far as everything was decided again. */
export interface News {
  readonly decided: Decided;
  /** When the planner answered or, while it had no goal, scans came. */
  readonly scans_s: Float64Array;
  readonly differences_s: Float64Array;
  readonly changes: readonly Change[];
  /** When the robot was where: x, y, z of each time. */
  readonly trail_s: Float64Array;
  readonly trail_m: Float32Array;
}

export type ToRecording =
  /** First of all; answered by `opened` or `failed`, or, without topics, by `asks`. */
  | { type: 'open'; file: File; topics?: Topics }
  /** Answered by `shown`, once the drive was decided so far; only the newest of several is. */
  | { type: 'show'; time_s: number; since_s: number }
  /** Everything is decided anew with these faults, as `no_scan@1.5+0.4`; answered by `restarted`. */
  | { type: 'faults'; faults: readonly string[] }
  | { type: 'recycle'; buffers: FrameBuffers };

export type FromRecording =
  | { type: 'opened'; scene: RecordedScene; supervisor: SupervisorInfo }
  /** Topics must be chosen before it can be opened. */
  | { type: 'asks'; choices: readonly TopicChoice[] }
  /** The news from here on are of the drive with other faults. */
  | { type: 'restarted' }
  | { type: 'news'; news: News }
  | { type: 'shown'; frame: RecordedFrame; buffers: FrameBuffers }
  /** Nothing more comes. */
  | { type: 'failed'; message: string };
