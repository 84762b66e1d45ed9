/** The page's state and its actions: what buttons, keys, tools and `window.mapless` call. */

import type { MaplessState } from './api.ts';
import { entry, following } from './core/catalogue.ts';
import { CoreClient } from './core/client.ts';
import type { Experiment, Stroke } from './core/experiment.ts';
import type {
  Frame,
  Ground,
  GroundPatch,
  Heading,
  NamedFile,
  Place,
  SessionInfo,
  Setting,
  Source,
} from './core/protocol.ts';
import { HeightField } from './scene/heightfield.ts';
import type { Tool } from './scene/tools.ts';
import { SPEEDS } from './ui/controls.ts';
import { Workbench } from './workbench.ts';

/** How long the result of a trial stands before the page goes on by itself. */
const LINGER_S = 8;

export interface Views {
  /** A scenario, goal or start changed; with `field`, the ground is another one. */
  session(info: SessionInfo, field: HeightField | undefined): void;
  frame(frame: Frame): void;
  status(frame: Frame, playing: boolean): void;
  /** The ground was sculpted. */
  sculpted(): void;
  playing(playing: boolean): void;
  speed(speed: number): void;
  tool(tool: Tool): void;
  /** Seconds until the next scenario starts by itself, or nothing. */
  countdown(seconds: number | undefined): void;
  /** The experiment, or what can be undone, has changed. */
  experiment(bench: Workbench): void;
  notice(message: string): void;
  clearNotice(): void;
}

export class App {
  readonly #views: Views;
  readonly #core: CoreClient;
  #info: SessionInfo | undefined;
  #frame: Frame | undefined;
  #field: HeightField | undefined;
  #playing = false;
  #speed = 1;
  /** Whether somebody has used the page: then it does nothing by itself any more. */
  #touched = false;
  #lingering: ReturnType<typeof setInterval> | undefined;
  /** Whether ground or goal have changed under way: the run is then not the one that the experiment gives from its start. */
  #disturbed = false;
  readonly bench: Workbench;

  constructor(views: Views) {
    this.#views = views;
    this.#core = new CoreClient({
      session: (info, ground, experiment) => this.#onSession(info, ground, experiment),
      frame: (frame) => this.#onFrame(frame),
      ground: (patch) => this.#onPatch(patch),
      failure: (message, panicked) => this.#onFailure(message, panicked),
    });
    this.bench = new Workbench({
      request: (command) => {
        if (['goal', 'sculpt', 'replace'].includes(command.type)) this.#disturbed = true;
        return this.#core.request(command);
      },
      ground: () => this.#field,
      changed: (bench) => this.#views.experiment(bench),
    });
  }

  /** Marks the page as used. */
  touch(): void {
    this.#touched = true;
    this.#stopLingering();
  }

  get touched(): boolean {
    return this.#touched;
  }

  get scenario(): string {
    return this.#info?.scenario ?? following('').id;
  }

  get setting(): Setting {
    const { preset = 'default', learning = 'fixed' } = this.#info ?? {};
    return { preset, learning };
  }

  state(): MaplessState | undefined {
    const [info, frame, field] = [this.#info, this.#frame, this.#field];
    if (!info || !frame || !field) return undefined;
    const { buffers: _buffers, path: _path, segments, subgoals, ...rest } = frame;
    return {
      ...rest,
      scenario: info.scenario,
      preset: info.preset,
      learning: info.learning,
      seed: info.seed,
      start: info.start,
      goal: info.goal,
      playing: this.#playing,
      speed: this.#speed,
      ground: { columns: field.columns, rows: field.rows, cell_m: field.cell_m },
      segments: segments.length,
      subgoals: subgoals.length,
      disturbed: this.#disturbed,
    };
  }

  load(scenario: string, setting: Partial<Setting> = {}, seed?: number): Promise<void> {
    return this.open({ scenario, setting: { ...this.setting, ...setting }, seed });
  }

  async open(source: Source): Promise<void> {
    this.#stopLingering();
    // Before anybody has touched the page there is nothing to go back to.
    await this.bench.open(source, this.#touched || this.bench.canUndo);
    this.#views.clearNotice();
  }

  /** Other settings for the experiment as it is. */
  async change(part: Partial<Omit<Experiment, 'version' | 'strokes'>>): Promise<void> {
    this.#stopLingering();
    await this.bench.change(part);
    await this.#setPlaying(true);
    this.#views.clearNotice();
  }

  async undo(): Promise<void> {
    this.#stopLingering();
    await this.bench.undo();
  }

  async redo(): Promise<void> {
    this.#stopLingering();
    await this.bench.redo();
  }

  /** The files with which `mapless run` drives the same run. */
  files(): Promise<NamedFile[]> {
    const { experiment } = this.bench;
    if (!experiment) return Promise.reject(new Error('No scenario is loaded yet.'));
    return this.#core.request({ type: 'export', experiment });
  }

  get field(): HeightField | undefined {
    return this.#field;
  }

  /** The ground of a terrain, coarsely, for a picture. */
  preview(terrain: Experiment['terrain']): Promise<Ground> {
    return this.#core.request({ type: 'preview', terrain });
  }

  /** Loads a scenario and runs it at once. */
  async run(scenario: string, setting?: Partial<Setting>, seed?: number): Promise<void> {
    await this.load(scenario, setting, seed);
    await this.#setPlaying(true);
  }

  /** Runs what the page begins with; undoing leads back to one's own work. */
  async runAfter(own: Experiment | undefined, source: Source): Promise<void> {
    this.touch();
    await this.bench.openAfter(own, source);
    await this.#setPlaying(true);
  }

  /** A terrain by itself, with a start and a goal where it is level. */
  async runTerrain(terrain: Experiment['terrain'], name: string): Promise<void> {
    await this.open({ terrain, name, setting: this.setting });
    await this.#setPlaying(true);
  }

  /** Files that somebody opened. */
  async runFiles(files: readonly NamedFile[]): Promise<void> {
    await this.open({ files, setting: this.setting });
    await this.#setPlaying(true);
  }

  async play(): Promise<void> {
    if (this.#frame && this.#frame.outcome !== 'running') await this.restart();
    await this.#setPlaying(true);
  }

  pause(): Promise<void> {
    return this.#setPlaying(false);
  }

  togglePlay(): Promise<void> {
    const ended = this.#frame !== undefined && this.#frame.outcome !== 'running';
    return this.#playing && !ended ? this.pause() : this.play();
  }

  async step(): Promise<void> {
    if (this.#frame && this.#frame.outcome !== 'running') return;
    this.#show(false);
    await this.#core.request({ type: 'step' });
  }

  async restart(): Promise<void> {
    this.#stopLingering();
    await this.#core.request({ type: 'restart' });
  }

  async next(): Promise<void> {
    await this.run(following(this.scenario).id);
  }

  async setSpeed(speed: number): Promise<void> {
    this.#speed = speed;
    this.#views.speed(speed);
    await this.#core.request({ type: 'speed', speed });
  }

  faster(steps: number): Promise<void> {
    const index = SPEEDS.indexOf(this.#speed) + steps;
    return this.setSpeed(SPEEDS[Math.min(Math.max(index, 0), SPEEDS.length - 1)] ?? 1);
  }

  async setGoal(goal: Place): Promise<void> {
    this.#stopLingering();
    await this.bench.setGoal(goal);
  }

  async setStart(start: Heading): Promise<void> {
    this.#stopLingering();
    await this.bench.setStart(start);
  }

  /** A whole stroke at once. */
  sculpt({ points_cm, ...brush }: Stroke): Promise<void> {
    const stroke = this.bench.stroke(brush);
    for (let at = 0; at + 1 < points_cm.length; at += 2) {
      stroke.touch({ x: (points_cm[at] ?? 0) / 100, y: (points_cm[at + 1] ?? 0) / 100 });
    }
    return stroke.end();
  }

  /** Height of the ground, nothing outside it. */
  heightAt({ x, y }: Place): number | undefined {
    return this.#field?.contains(x, y) ? this.#field.height(x, y) : undefined;
  }

  /** World-frame x, y, z of the newest scan's returns. */
  scan(): Float32Array {
    return this.#frame?.buffers.points.slice(0, 3 * this.#frame.returns) ?? new Float32Array();
  }

  hidden(hidden: boolean): Promise<void> {
    return this.#core.request({ type: 'hidden', hidden });
  }

  async #setPlaying(playing: boolean): Promise<void> {
    this.#show(playing);
    await this.#core.request({ type: 'play', playing });
  }

  #show(playing: boolean): void {
    this.#playing = playing;
    this.#views.playing(playing);
    if (this.#frame) this.#views.status(this.#frame, playing);
  }

  #onSession(info: SessionInfo, ground: Ground | undefined, experiment: Experiment | undefined): void {
    this.#info = info;
    if (experiment) this.bench.loaded(experiment);
    const field = ground ? new HeightField(ground) : undefined;
    this.#field = field ?? this.#field;
    this.#views.session(info, field);
  }

  #onPatch(patch: GroundPatch): void {
    this.#field?.patch(patch);
    this.bench.patched(patch);
    this.#views.sculpted();
  }

  #onFrame(frame: Frame): void {
    const last = this.#frame;
    this.#frame = frame;
    if (frame.tick === 0) this.#disturbed = false;
    this.#views.frame(frame);
    this.#views.status(frame, this.#playing);
    // The newest frame stays readable; the one before goes back.
    if (last) this.#core.recycle(last.buffers);
    const ended = last?.outcome === 'running' && frame.outcome !== 'running';
    if (ended) this.#linger();
  }

  /** Leaves time to look at the result; then, if nobody has touched anything, shows the next scenario. */
  #linger(): void {
    this.#stopLingering();
    if (this.#touched) return;
    let seconds = LINGER_S;
    this.#views.countdown(seconds);
    this.#lingering = setInterval(() => {
      seconds -= 1;
      this.#views.countdown(Math.max(seconds, 0));
      if (seconds <= 0) this.attempt(this.next());
    }, 1000);
  }

  #stopLingering(): void {
    clearInterval(this.#lingering);
    this.#lingering = undefined;
    this.#views.countdown(undefined);
  }

  /** Shows what went wrong instead of leaving a promise unhandled. */
  attempt(action: Promise<void>): void {
    action.catch((error: unknown) => this.#views.notice(error instanceof Error ? error.message : String(error)));
  }

  #onFailure(message: string, panicked: boolean): void {
    this.#show(false);
    this.#stopLingering();
    if (!panicked) {
      this.#views.notice(message);
      return;
    }
    const { title } = entry(this.scenario);
    this.#views.notice(
      `The simulation stopped on an internal error and was started anew with “${title}”. (${message})`,
    );
    const again = this.bench.reopen();
    again
      .then(() => this.setSpeed(this.#speed))
      .catch(() => this.#views.notice(`The simulation cannot be started: ${message}`));
  }
}
