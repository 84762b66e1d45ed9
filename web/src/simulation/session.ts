/** One loaded scenario in the wasm core, as the plain data of the protocol. Runs in the worker. */

import type { Core } from '../bindings/simulationModule.ts';
import type { Experiment } from '../experiment/experiment.ts';
import { type WorldObject, walkOf } from '../experiment/objects.ts';
import type { Overrides } from '../experiment/overrides.ts';
import type { Goal, Heading, Place } from '../experiment/place.ts';
import type { Setup } from '../experiment/setting.ts';
import type {
  ClimbStep,
  Computing,
  Frame,
  FrameBuffers,
  Ground,
  GroundPatch,
  Inside,
  InsideQuestion,
  PlaceReport,
  SessionInfo,
  Solid,
} from '../protocol/simulationProtocol.ts';
import type { Session as CoreSession, Standing, Stroke, Tick } from '../wasm/mapless_wasm.js';
import { newFrameBuffers } from './frameBuffers.ts';
import { filesOf, readTerrain } from './opening.ts';

/** A decision as slow as this was may well be followed by one that takes long. */
const SLOW_MS = 200;

export class Session {
  readonly #core: CoreSession;
  readonly #name: string;
  /** What the run drives with. */
  #setup: Setup;
  /** What is tried at the present pose instead, if anything is. */
  #tried: Setup | undefined;
  readonly #pool: FrameBuffers[] = [];
  readonly #warnings: readonly string[];
  #info: SessionInfo;
  #standing: Standing;
  /** Whether another route may hold than the info says. */
  #rerouted = false;
  #planner_ms = 0;

  private constructor(core: CoreSession, experiment: Experiment, warnings: readonly string[]) {
    const { name, preset, learning, overrides } = experiment;
    this.#core = core;
    this.#warnings = warnings;
    this.#name = name;
    this.#setup = { preset, learning, overrides };
    this.#info = this.#readInfo(undefined);
    this.#standing = core.standing();
  }

  static async open(core: Core, experiment: Experiment): Promise<Session> {
    const { preset, learning, overrides } = experiment;
    // Without the overrides, so that the core knows the defaults, too.
    const [scenario, ...terrain] = filesOf(core, { ...experiment, overrides: {} });
    const text = new TextDecoder().decode(scenario.bytes);
    const { files, warnings } = await readTerrain(core, terrain);
    const options = {
      scenario: { name: scenario.name, text },
      terrain: files,
      preset,
      learning,
      overrides,
    };
    return new Session(new core.Session(options), experiment, warnings);
  }

  free(): void {
    this.#core.free();
  }

  get info(): SessionInfo {
    return this.#info;
  }

  /** Where the robot stands, and whether the trial goes on. */
  get standing(): Standing {
    return this.#standing;
  }

  get running(): boolean {
    return this.#standing.outcome === 'running';
  }

  /** The next decision, with `setup` where that is tried, if it may take long. */
  computing({ learning }: Setup = this.#tried ?? this.#setup): Computing | undefined {
    const { tick } = this.#standing;
    const learns = learning === 'every_scan' || (learning === 'once' && (tick === 0 || this.tries));
    return learns || this.#planner_ms > SLOW_MS ? { tick, learns } : undefined;
  }

  ground(): Ground {
    return this.#core.ground();
  }

  restart(): void {
    this.#core.restart();
    this.#began();
  }

  setRoute(waypoints: readonly Place[], goal: Goal): void {
    this.#core.set_route({ waypoints, goal });
    this.#info = this.#readInfo(this.#info);
    this.#standing = this.#core.standing();
  }

  /** Begins anew with these overrides, and another seed if given; the ground, the start and the route stay. */
  setOverrides(overrides: Overrides, seed?: number): void {
    this.#core.set_parameters(overrides, seed);
    this.#setup = { ...this.#setup, overrides };
    this.#info = this.#readInfo(undefined);
    this.#began();
  }

  /** Senses and decides again here with another setup, or again with the run's own where it is that. */
  think(setup: Setup): void {
    const own = JSON.stringify(setup) === JSON.stringify(this.#setup);
    if (own) this.#core.forget_thought();
    else this.#core.think_again(setup);
    const same = sameDefaults(this.#tried ?? this.#setup, setup);
    this.#tried = own ? undefined : setup;
    this.#info = this.#readInfo(same ? this.#info : undefined);
  }

  /** Senses and decides again here, after something has changed or the robot stands elsewhere. */
  thinkAgain(): void {
    if (this.#tried) this.#core.think_again(this.#tried);
    else if (this.#standing.tick > 0) this.#core.think_again(undefined);
  }

  get tries(): boolean {
    return this.#tried !== undefined;
  }

  /** Drives on from here with what was tried. */
  goOn(): void {
    if (!this.#tried) return;
    this.#core.go_on_so();
    [this.#setup, this.#tried] = [this.#tried, undefined];
    this.#info = this.#readInfo(this.#info);
  }

  lookInside(question: InsideQuestion): Inside {
    return this.#core.look_inside(question);
  }

  reportOn({ x, y }: Place): PlaceReport {
    return this.#core.place_report({ x, y });
  }

  climb(): ClimbStep[] {
    return this.#core.climb();
  }

  kernelFrom(column: number, row: number): Float32Array {
    return this.#core.kernel_from(column, row);
  }

  /** Going back in time may bring another route back; says whether it did. */
  followRoute(): boolean {
    if (!this.#rerouted) return false;
    this.#rerouted = false;
    this.#info = this.#readInfo(this.#info);
    return true;
  }

  /** Goes back to the nearest tick there is, or to a little before it; says which that is. */
  goBack(tick: number): number {
    const nearest = this.#core.go_back(tick);
    this.#rerouted = true;
    this.#standing = this.#core.standing();
    return nearest;
  }

  setStart(start: Heading): void {
    this.#core.set_start(start);
    this.#info = this.#readInfo(this.#info);
    this.#began();
  }

  /** Applies a stroke; returns the new heights of the rectangle that changed, if any. */
  sculpt(stroke: Stroke): GroundPatch | undefined {
    const changed = this.#core.sculpt(stroke);
    this.#standing = this.#core.standing();
    return changed;
  }

  replaceGround(patch: GroundPatch): void {
    this.#core.replace_ground(patch);
    this.#standing = this.#core.standing();
  }

  setObjects(objects: readonly WorldObject[]): void {
    this.#core.set_objects([...objects]);
    this.#info = this.#readInfo(this.#info);
    this.#standing = this.#core.standing();
  }

  /** The shapes of the objects that stand. */
  solids(objects: readonly WorldObject[] = this.#info.objects): Solid[] {
    return this.#core.solids().filter(({ object }) => walkOf(objects[object]).length === 0);
  }

  tick(): Tick {
    const tick = this.#core.tick();
    this.#standing = tick.after;
    this.#rerouted ||= tick.rerouted;
    this.#planner_ms = tick.planner_ms;
    return tick;
  }

  recycle(buffers: FrameBuffers): void {
    const { columns, rows } = this.#info.image;
    if (buffers.variance.length === columns * rows) this.#pool.push(buffers);
  }

  /** Everything of the present state; the surfaces only on demand, since predicting them takes longer than deciding. */
  frame(since: Pick<Frame, 'trail' | 'anew' | 'ahead' | 'rows'>, surfaces: boolean, truth: boolean): Frame {
    const buffers = this.#pool.pop() ?? newFrameBuffers(this.#info.image);
    return { ...this.#core.frame(buffers, surfaces, truth), surfaces, planner_ms: this.#planner_ms, buffers, ...since };
  }

  #began(): void {
    this.#forgetTried();
    this.#planner_ms = 0;
    this.#standing = this.#core.standing();
  }

  #forgetTried(): void {
    if (!this.#tried) return;
    this.#tried = undefined;
    this.#info = this.#readInfo(undefined);
  }

  /** The parameters stay those of the info `before`, where there is one. */
  #readInfo(before: SessionInfo | undefined): SessionInfo {
    const objects = this.#core.objects();
    return {
      ...this.#core.scene(),
      scenario: this.#name,
      ...(this.#tried ?? this.#setup),
      runsWith: this.#tried && this.#setup,
      parameters: before?.parameters ?? this.#core.parameters(),
      objects,
      solids: this.solids(objects),
      warnings: this.#warnings,
    };
  }
}

/** Whether every parameter has the same value unless it is overridden: those of the planner follow sensor and robot. */
function sameDefaults(a: Setup, b: Setup): boolean {
  const given = ({ preset, overrides: { planner: _, ...others } }: Setup) => JSON.stringify([preset, others]);
  return given(a) === given(b);
}
