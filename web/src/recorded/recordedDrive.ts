/** A recording that is open: goes to any moment of it, plays it, and tells the panels what is there. */

import { gate } from '../base/gate.ts';
import { messageOf } from '../base/messageOf.ts';
import { HeightField } from '../ground/heightField.ts';
import type { Frame, FrameBuffers, Pose, SessionInfo } from '../protocol/simulationProtocol.ts';
import { transferables } from '../protocol/simulationProtocol.ts';
import { SPEEDS } from '../run/speeds.ts';
import { frameOf, goalOf, infoOf, PERIOD_S } from './recordedFrame.ts';
import { RecordedPast } from './recordedPast.ts';
import type {
  FromRecording,
  RecordedFrame,
  RecordedScene,
  SupervisorInfo,
  TopicChoice,
  Topics,
  ToRecording,
} from './recordedProtocol.ts';

/** One jump along the timeline. */
const JUMP_S = 5;
/** While it plays, no moment is asked for sooner after the one before than this. */
const PLAY_MS = 50;

/** What shows the drive. */
export interface DriveViews {
  /** The recording, or the goal in it, is another one; with `field`, heights around the robot, too. */
  session(info: SessionInfo, field: HeightField | undefined): void;
  /** Heights around the robot as of now. */
  surroundings(field: HeightField): void;
  frame(frame: Frame, recorded: RecordedFrame): void;
  playing(playing: boolean): void;
  speed(speed: number): void;
  /** More of it was decided again. */
  news(past: RecordedPast): void;
  /** It cannot go on. */
  failed(message: string): void;
}

export class RecordedDrive {
  readonly name: string;
  readonly scene: RecordedScene;
  readonly supervisor: SupervisorInfo;
  past = new RecordedPast();
  readonly #worker: Worker;
  readonly #views: DriveViews;
  #info: SessionInfo | undefined;
  #recorded: RecordedFrame | undefined;
  /** Where the robot is known to be first. */
  #pose: Pose = { x: 0, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0 };
  readonly #begun = gate();
  #buffers: FrameBuffers | undefined;
  /** Places of the trajectory that the view has, behind the robot and in all. */
  #drawn = { behind: 0, all: 0 };
  #playing = false;
  #speed = 1;
  #played_ms = 0;
  /** Where somebody wants to be, and who waits until that is shown. */
  #wish: { time_s: number; jumps: boolean } | undefined;
  #waiting: (() => void)[] = [];
  #asked: { jumps: boolean } | undefined;
  #timer: ReturnType<typeof setTimeout> | undefined;

  private constructor(
    name: string,
    { scene, supervisor }: Extract<FromRecording, { type: 'opened' }>,
    worker: Worker,
    views: DriveViews,
  ) {
    [this.name, this.scene, this.supervisor] = [name, scene, supervisor];
    [this.#worker, this.#views] = [worker, views];
    worker.onmessage = ({ data }: MessageEvent<FromRecording>) => this.#receive(data);
    worker.onerror = (event) => {
      event.preventDefault();
      views.failed(event.message || 'the replay could not be loaded');
    };
  }

  /**
   * `ask` has topics chosen that cannot be told apart; where it gives none, nothing is opened. Rejected, with what was expected, if the file
   * is no recording.
   */
  static open(
    file: File,
    views: DriveViews,
    ask: (choices: readonly TopicChoice[]) => Promise<Topics | undefined>,
  ): Promise<RecordedDrive | undefined> {
    const worker = new Worker(new URL('./recordingWorker.ts', import.meta.url), { type: 'module' });
    return new Promise((resolve, reject) => {
      const refuse = (message: string) => {
        worker.terminate();
        reject(new Error(message));
      };
      worker.onerror = (event) => {
        event.preventDefault();
        refuse(`${file.name}: ${event.message || 'the replay could not be loaded'}`);
      };
      const asked = (topics: Topics | undefined) => {
        if (topics) worker.postMessage({ type: 'open', file, topics } satisfies ToRecording);
        else {
          worker.terminate();
          resolve(undefined);
        }
      };
      worker.onmessage = ({ data }: MessageEvent<FromRecording>) => {
        if (data.type === 'asks') ask(data.choices).then(asked, (error) => refuse(messageOf(error)));
        else if (data.type === 'opened') resolve(new RecordedDrive(file.name, data, worker, views));
        else if (data.type === 'failed') refuse(data.message);
      };
      worker.postMessage({ type: 'open', file } satisfies ToRecording);
    });
  }

  close(): void {
    clearTimeout(this.#timer);
    this.#worker.onmessage = null;
    this.#worker.terminate();
    for (const shown of this.#waiting.splice(0)) shown();
  }

  get playing(): boolean {
    return this.#playing;
  }

  get time_s(): number {
    return this.#recorded?.time_s ?? 0;
  }

  get end_s(): number {
    return this.past.decided?.end_s ?? 0;
  }

  /** Shows the first scan, as soon as that is decided on. */
  async begin(): Promise<void> {
    await this.#begun.passed;
    await this.seekTime(this.past.scanBeside(-1, 1) ?? 0);
  }

  /** Resolves once the moment is shown, or a newer one. */
  seekTime(time_s: number): Promise<void> {
    this.#play(false);
    return this.#go(Math.max(time_s, 0), true);
  }

  seek(tick: number): Promise<void> {
    return this.seekTime(tick * PERIOD_S);
  }

  jump(times: number): Promise<void> {
    return this.seekTime((this.#wish?.time_s ?? this.time_s) + times * JUMP_S);
  }

  /** To the next scan, or the one before. */
  step(way: 1 | -1 = 1): Promise<void> {
    return this.seekTime(this.past.scanBeside(this.time_s, way) ?? this.time_s);
  }

  /** To the next decision that differs from the recorded one, or else the first. */
  async nextDifference(): Promise<void> {
    const next = this.past.differenceBeside(this.time_s, 1) ?? this.past.differences_s[0];
    if (next !== undefined) await this.seekTime(next);
  }

  /** Decides everything anew with faults put in, and shows a moment of that. */
  putIn(faults: readonly string[], time_s: number): Promise<void> {
    this.#post({ type: 'faults', faults });
    return this.seekTime(time_s);
  }

  restart(): Promise<void> {
    return this.seekTime(0);
  }

  async togglePlay(): Promise<void> {
    if (!this.#playing && this.time_s >= this.end_s - PERIOD_S) await this.restart();
    this.#play(!this.#playing);
  }

  async setSpeed(speed: number): Promise<void> {
    this.#speed = speed;
    this.#views.speed(speed);
  }

  faster(steps: number): Promise<void> {
    const index = SPEEDS.indexOf(this.#speed) + steps;
    return this.setSpeed(SPEEDS[Math.min(Math.max(index, 0), SPEEDS.length - 1)] ?? 1);
  }

  #play(playing: boolean): void {
    clearTimeout(this.#timer);
    this.#playing = playing;
    this.#views.playing(playing);
    this.#played_ms = performance.now();
    if (playing) this.#playOn();
  }

  #playOn(): void {
    const now_ms = performance.now();
    const passed_s = (now_ms - this.#played_ms) / 1000;
    this.#played_ms = now_ms;
    // As fast as it goes, no scan is left out.
    const next = this.#speed === Number.POSITIVE_INFINITY ? this.past.scanBeside(this.time_s, 1) : undefined;
    const faster_s = passed_s * Math.min(this.#speed, 10);
    void this.#go(Math.min(next ?? this.time_s + faster_s, this.end_s), false);
  }

  #go(time_s: number, jumps: boolean): Promise<void> {
    this.#wish = { time_s, jumps: jumps || this.#wish?.jumps === true };
    this.#ask();
    return new Promise((resolve) => this.#waiting.push(resolve));
  }

  #ask(): void {
    if (this.#asked || !this.#wish) return;
    const { time_s, jumps } = this.#wish;
    this.#asked = { jumps };
    this.#wish = undefined;
    const since_s = jumps ? time_s - PERIOD_S : this.time_s;
    this.#post({ type: 'show', time_s, since_s });
  }

  #post(message: ToRecording, transfer: Transferable[] = []): void {
    this.#worker.postMessage(message, transfer);
  }

  #receive(message: FromRecording): void {
    if (message.type === 'restarted') {
      this.past = new RecordedPast();
      this.#drawn = { behind: 0, all: 0 };
    } else if (message.type === 'news') {
      this.past.add(message.news);
      this.#views.news(this.past);
      if (this.past.scanBeside(-1, 1) !== undefined || message.news.decided.has_ended) this.#begun.open();
      // The line along which one goes has grown.
      if (this.#recorded && this.#buffers && !this.#playing) this.#show(this.#recorded, this.#buffers, false);
    } else if (message.type === 'shown') this.#shown(message.frame, message.buffers);
    else if (message.type === 'failed') this.#views.failed(message.message);
  }

  #shown(recorded: RecordedFrame, buffers: FrameBuffers): void {
    const jumps = this.#asked?.jumps ?? true;
    this.#asked = undefined;
    const last = this.#buffers;
    this.#show(recorded, buffers, jumps);
    if (last) this.#post({ type: 'recycle', buffers: last }, transferables(last));
    if (this.#wish) {
      this.#ask();
      return;
    }
    for (const shown of this.#waiting.splice(0)) shown();
    if (!this.#playing) return;
    if (recorded.time_s >= this.end_s - 1e-3) this.#play(false);
    else this.#timer = setTimeout(() => this.#playOn(), PLAY_MS);
  }

  #show(recorded: RecordedFrame, buffers: FrameBuffers, jumps: boolean): void {
    [this.#recorded, this.#buffers] = [recorded, buffers];
    if (!this.#info && recorded.pose) this.#pose = recorded.pose;
    // Until odometry and IMU came it stands where it is known to be first.
    const pose = recorded.pose ?? this.#pose;
    const field = new HeightField(recorded.surroundings);
    const first = this.#info === undefined;
    const info = this.#info ?? infoOf(this.name, this.scene, recorded.goal, pose);
    const goal = goalOf(recorded.goal);
    if (first || JSON.stringify(goal) !== JSON.stringify(info.goal)) {
      this.#info = { ...info, goal };
      this.#views.session(this.#info, first ? field : undefined);
    }
    this.#views.surroundings(field);
    this.#views.frame(frameOf(recorded, pose, buffers, this.#along(jumps || first)), recorded);
  }

  #along(anew: boolean) {
    const behind = this.past.placesUntil(this.time_s);
    const all = this.past.places;
    const starts = anew || behind < this.#drawn.behind;
    const drawn = starts ? { behind: 0, all: Math.max(behind - 1, 0) } : this.#drawn;
    this.#drawn = { behind, all };
    const changes = [...new Set(this.past.differences_s.map((at_s) => Math.round(at_s / PERIOD_S)))];
    return {
      timeline: { first: 0, end: Math.ceil(this.end_s / PERIOD_S), changes },
      trail: this.past.trail(drawn.behind, behind),
      ahead: this.past.trail(drawn.all, all),
      anew: starts,
    };
  }
}
