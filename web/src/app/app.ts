/** The page's state and its actions: what buttons, keys, tools and `window.mapless` call. */

import { messageOf } from '../base/messageOf.ts';
import { Editor } from '../editor/editor.ts';
import { entry, following } from '../experiment/catalogue.ts';
import { type Experiment, FIRST_SETUP, type Holes } from '../experiment/experiment.ts';
import type { Overrides } from '../experiment/overrides.ts';
import type { Place } from '../experiment/place.ts';
import type { Setup } from '../experiment/setting.ts';
import { HeightField } from '../ground/heightField.ts';
import type {
  Beginning,
  Frame,
  GroundPatch,
  Loaded,
  NamedFile,
  SessionInfo,
  Solid,
  Source,
  TerrainPreview,
} from '../protocol/simulationProtocol.ts';
import { RunRecord } from '../run/record.ts';
import { SPEEDS } from '../run/speeds.ts';
import type { SimulationClient } from '../simulation/simulationClient.ts';
import { AutoAdvance } from './autoAdvance.ts';
import { CourseEdits } from './courseEdits.ts';
import { Insight } from './insight.ts';
import { Recovery } from './recovery.ts';
import { Seeker } from './seeker.ts';
import { stateOf } from './state.ts';
import type { Views } from './views.ts';
import type { MaplessState } from './windowApi.ts';

/** One jump along the timeline. */
const JUMP_S = 5;

export class App {
  /** The run so far. */
  readonly record = new RunRecord();
  readonly #views: Views;
  readonly #core: SimulationClient;
  #info: SessionInfo | undefined;
  /** Of what was loaded last. */
  #frame: Frame | undefined;
  #field: HeightField | undefined;
  #playing = false;
  #speed = 1;
  /** Whether somebody has used the page: then it does nothing by itself any more. */
  #touched = false;
  readonly #autoAdvance: AutoAdvance;
  readonly #seeker = new Seeker((tick) => this.#core.request({ type: 'seek', tick }));
  /** Whether anything shows the surfaces. */
  #watching = false;
  readonly #recovery: Recovery;
  readonly editor: Editor;
  readonly course: CourseEdits;
  readonly insight: Insight;

  constructor(core: SimulationClient, views: Views) {
    this.#core = core;
    this.#views = views;
    this.insight = new Insight(core);
    this.#autoAdvance = new AutoAdvance((seconds) => views.countdown(seconds));
    this.editor = new Editor({
      request: (command) => this.#core.request(command),
      ground: () => this.#field,
      info: () => this.#info,
      mayThink: () => this.#standsStill,
      changed: (editor) => this.#views.experiment(editor),
    });
    this.course = new CourseEdits(this.editor, {
      info: () => this.#info,
      frame: () => this.#frame,
      edited: () => this.#autoAdvance.stop(),
    });
    this.#recovery = new Recovery({
      title: () => this.editor.experiment && entry(this.scenario).title,
      reopen: () => this.#reopen(),
      notice: views.notice,
    });
  }

  /** Marks the page as used. */
  touch(): void {
    this.#touched = true;
    this.#autoAdvance.stop();
  }

  get touched(): boolean {
    return this.#touched;
  }

  get scenario(): string {
    return this.#info?.scenario ?? following('').id;
  }

  get setup(): Setup {
    const { preset, learning, overrides } = this.#info ?? FIRST_SETUP;
    return { preset, learning, overrides };
  }

  state(): MaplessState | undefined {
    const [info, frame, field] = [this.#info, this.#frame, this.#field];
    return info && frame && field && stateOf(info, frame, field, this.#playing, this.#speed);
  }

  /** The newest frame of a running trial in which something was decided, and what it belongs to. */
  async decided(): Promise<{ frame: Frame; info: SessionInfo }> {
    if (this.#frame && this.#frame.outcome !== 'running') await this.restart();
    if (this.#frame?.tick === 0) await this.step();
    if (!this.#frame || !this.#info) throw new Error('No scenario is loaded yet.');
    return { frame: this.#frame, info: this.#info };
  }

  get speed(): number {
    return this.#speed;
  }

  get playing(): boolean {
    return this.#playing;
  }

  load(scenario: string, setup: Partial<Setup> = {}, seed?: number): Promise<void> {
    return this.open({ scenario, setup: { ...this.setup, ...setup }, seed });
  }

  async open(source: Source, play = false): Promise<void> {
    this.#autoAdvance.stop();
    // Before anybody has touched the page there is nothing to go back to.
    await this.editor.open(source, this.#touched || this.editor.canUndo, play);
    this.#showWarnings();
  }

  /** Opens the run of an experiment where it was at a time, paused; its frame there, or where somebody stopped it before. */
  async openAt(experiment: Experiment, time_s: number): Promise<Frame | undefined> {
    await this.pause();
    await this.open({ experiment });
    await this.#drive(this.#core.request({ type: 'drive', time_s }));
    this.#show(false);
    return this.#frame;
  }

  /** Whether the run stands still under way: then other settings are tried where it stands. */
  get #standsStill(): boolean {
    return !this.#playing && this.#frame?.outcome === 'running';
  }

  /** Other parameters, planner or learning: tried where the robot stands while it stands still, otherwise the run begins anew with them and drives. */
  async adjust(part: Partial<Setup>): Promise<void> {
    this.#autoAdvance.stop();
    if (this.#standsStill) await this.editor.think(part);
    else if (part.overrides && Object.keys(part).length === 1) {
      await this.editor.setOverrides(part.overrides);
      await this.play();
    } else await this.#drive(this.editor.change(part));
    this.#views.clearNotice();
  }

  /** Shows at once what other parameters would give here; what holds is said by `adjust`. */
  tryOut(overrides: Overrides): Promise<void> {
    return this.#core.request({ type: 'think', setup: { ...this.setup, overrides } });
  }

  /** Gives up what is only tried. */
  async forgetTried(): Promise<void> {
    const own = this.#info?.runsWith;
    if (own) await this.editor.think(own);
  }

  /** Begins the run anew with what is only tried, and drives. */
  async runTried(): Promise<void> {
    await this.restart();
    await this.play();
  }

  /** Other settings for the experiment as it is. */
  async change(part: Partial<Omit<Experiment, 'version' | 'strokes'>>): Promise<void> {
    const { preset, learning, seed, ...other } = part;
    const sameSeed = seed === undefined || seed === this.#info?.seed;
    if (this.#standsStill && sameSeed && Object.keys(other).length === 0) {
      const { preset: before, learning: old } = this.setup;
      return this.adjust({ preset: preset ?? before, learning: learning ?? old });
    }
    this.#autoAdvance.stop();
    await this.#drive(this.editor.change(part));
    this.#views.clearNotice();
  }

  async undo(): Promise<void> {
    this.#autoAdvance.stop();
    await this.editor.undo();
  }

  async redo(): Promise<void> {
    this.#autoAdvance.stop();
    await this.editor.redo();
  }

  /** The files with which `mapless run` drives the same run. */
  files(experiment = this.editor.experiment): Promise<NamedFile[]> {
    if (!experiment) return Promise.reject(new Error('No scenario is loaded yet.'));
    return this.#core.request({ type: 'export', experiment });
  }

  get field(): HeightField | undefined {
    return this.#field;
  }

  /** A terrain, coarsely, for a picture. */
  preview(terrain: Experiment['terrain']): Promise<TerrainPreview> {
    return this.#core.request({ type: 'preview', terrain });
  }

  /** Loads something and runs it at once. */
  async run(source: Source): Promise<void> {
    await this.#drive(this.open(source, true));
  }

  /** Loads a scenario and runs it at once. */
  async runScenario(scenario: string, setup?: Partial<Setup>, seed?: number): Promise<void> {
    await this.run({ scenario, setup: { ...this.setup, ...setup }, seed });
  }

  /** Shows what the core begins with; undoing leads back to one's own work. */
  async begin(begun: Promise<Beginning>): Promise<Beginning> {
    this.#core.listen({
      session: (info, loaded) => this.#onSession(info, loaded),
      frame: (frame) => this.#onFrame(frame),
      stands: () => this.#show(false),
      ground: (patch, solids) => this.#onPatch(patch, solids),
      failure: (message, panicked) => this.#onFailure(message, panicked),
      computing: (what) => this.#views.computing(what),
      slow: () => this.#views.slow(() => this.#stopOpening()),
      opened: () => this.#views.clearSlow(),
    });
    const beginning = begun.then((known) => {
      if (known.from !== 'catalogue') this.touch();
      return known;
    });
    await this.#drive(this.editor.begin(beginning));
    this.#showWarnings();
    const known = await beginning;
    if (known.moment_s !== undefined) this.#show(false);
    return known;
  }

  /** A terrain by itself, with a start and a goal where it is level. */
  async runTerrain(terrain: Experiment['terrain'], name: string): Promise<void> {
    await this.run({ terrain, name, setup: this.setup });
  }

  /** Files that somebody opened. */
  async runFiles(files: readonly NamedFile[], holes: Holes): Promise<void> {
    await this.run({ files, holes, setup: this.setup });
  }

  async play(): Promise<void> {
    if (this.#frame && this.#frame.outcome !== 'running') await this.restart();
    await this.#setPlaying(true);
  }

  /** Resolves once the frame of the last tick is in. */
  pause(): Promise<void> {
    return this.#setPlaying(false);
  }

  /** Pauses; resolves once the view shows the last tick and nothing in it moves any more. */
  async still(): Promise<void> {
    await this.pause();
    await this.#views.still();
  }

  async togglePlay(): Promise<void> {
    const ended = this.#frame !== undefined && this.#frame.outcome !== 'running';
    if (this.#playing && !ended) await this.pause();
    else if (this.#info?.runsWith && this.#frame?.tick) this.#views.askHow();
    else await this.play();
  }

  async step(): Promise<void> {
    if (this.#frame && this.#frame.outcome !== 'running') return;
    this.#show(false);
    await this.#core.request({ type: 'step' });
  }

  async restart(): Promise<void> {
    this.#autoAdvance.stop();
    await this.editor.restart();
  }

  async next(): Promise<void> {
    await this.runScenario(following(this.scenario).id);
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

  /** What is loaded; nothing until the first scenario is. */
  get info(): SessionInfo | undefined {
    return this.#info;
  }

  /** The newest tick; nothing until the first scenario is loaded. */
  get frame(): Frame | undefined {
    return this.#frame;
  }

  /** Begins anew with these parameters in place of all others, and another seed if given. */
  async setOverrides(overrides: Overrides, seed?: number): Promise<void> {
    this.#autoAdvance.stop();
    await this.editor.setOverrides(overrides, seed);
    this.#views.clearNotice();
  }

  /** Shows a tick of the run again and pauses there. */
  async seek(tick: number): Promise<void> {
    this.#autoAdvance.stop();
    this.#show(false);
    await this.#seeker.to(tick);
  }

  async seekTime(time_s: number): Promise<void> {
    if (this.#info) await this.seek(Math.round(time_s / this.#info.period_s));
  }

  /** Some seconds back or forth along the timeline. */
  async jump(times: number): Promise<void> {
    const [info, frame] = [this.#info, this.#frame];
    if (info && frame)
      await this.seek((this.#seeker.waiting ?? frame.tick) + Math.round((times * JUMP_S) / info.period_s));
  }

  /** Height of the ground, nothing outside it. */
  heightAt({ x, y }: Place): number | undefined {
    return this.#field?.contains(x, y) ? this.#field.height(x, y) : undefined;
  }

  /** World-frame x, y, z of the newest scan's returns. */
  scan(): Float32Array {
    return this.#frame?.buffers.points.slice(0, 3 * this.#frame.returns) ?? new Float32Array();
  }

  /** Has the surfaces predicted while anything shows them. */
  async watch(surfaces: boolean): Promise<void> {
    if (surfaces === this.#watching) return;
    this.#watching = surfaces;
    await this.#core.request({ type: 'watch', surfaces });
  }

  hidden(hidden: boolean): Promise<void> {
    return this.#core.request({ type: 'hidden', hidden });
  }

  async #setPlaying(playing: boolean): Promise<void> {
    this.#show(playing);
    await this.#core.request({ type: 'play', playing });
  }

  /** While something that drives at once is loading: a pause meanwhile comes after it, here as in the worker. */
  async #drive(loading: Promise<void>): Promise<void> {
    const before = this.#playing;
    this.#show(true);
    try {
      await loading;
    } catch (error) {
      this.#show(before && this.#playing);
      throw error;
    }
  }

  #show(playing: boolean): void {
    this.#playing = playing;
    this.#views.playing(playing);
    if (this.#frame) this.#views.status(this.#frame, playing);
  }

  #onSession(info: SessionInfo, loaded: Loaded | undefined): void {
    this.#info = info;
    if (loaded) this.editor.loaded(loaded);
    const field = loaded && new HeightField(loaded.ground);
    this.#field = field ?? this.#field;
    this.#views.session(info, field);
  }

  /** In place of what was said before. */
  #showWarnings(): void {
    const warnings = this.#info?.warnings ?? [];
    if (warnings.length > 0) this.#views.news(`${warnings.join('. ')}.`);
    else this.#views.clearNotice();
  }

  #onPatch(patch: GroundPatch, solids: readonly Solid[]): void {
    this.#field?.patch(patch);
    this.editor.patched(patch);
    this.#views.sculpted(patch, solids);
  }

  #onFrame(frame: Frame): void {
    const last = this.#frame;
    this.#frame = frame;
    this.record.add(frame.rows);
    this.record.end(frame.timeline.end);
    this.#views.frame(frame);
    this.#views.status(frame, this.#playing);
    // The newest frame stays readable; the one before goes back.
    if (last) this.#core.recycle(last.buffers);
    const ended = last?.outcome === 'running' && frame.outcome !== 'running';
    // If nobody has touched anything, the next scenario comes by itself.
    if (ended && !this.#touched) this.#autoAdvance.begin(() => this.attempt(this.next()));
  }

  /** Shows what went wrong instead of leaving a promise unhandled. */
  attempt(action: Promise<void>): Promise<void> {
    return action.catch((error: unknown) => this.#views.notice(messageOf(error)));
  }

  #onFailure(message: string, panicked: boolean): void {
    this.#show(false);
    this.#autoAdvance.stop();
    if (panicked) this.#recovery.afterPanic(message);
    else this.#views.notice(message);
  }

  /** Gives up what is being opened, and goes back to what was there before. */
  #stopOpening(): void {
    this.#show(false);
    this.#views.computing(undefined);
    this.#core.stop('Opening it was stopped.');
    this.#recovery.afterStop();
  }

  async #reopen(): Promise<void> {
    await this.editor.reopen();
    await this.setSpeed(this.#speed);
    await this.#core.request({ type: 'watch', surfaces: this.#watching });
    await this.insight.resume();
  }
}
