/** Holds the experiment that the page shows, and its history: everything that changes it goes through here. */

import {
  type Experiment,
  MAX_TOUCHES,
  type Stroke,
  sameCourse,
  tidyGoal,
  tidyHeading,
  tidyPlace,
} from '../experiment/experiment.ts';
import { tidyObject, type WorldObject } from '../experiment/objects.ts';
import type { Overrides } from '../experiment/overrides.ts';
import type { Heading, Place } from '../experiment/place.ts';
import type { Setup } from '../experiment/setting.ts';
import type {
  Beginning,
  Command,
  Ground,
  GroundPatch,
  Loaded,
  SessionInfo,
  Source,
} from '../protocol/simulationProtocol.ts';
import { History } from './history.ts';
import { type Brush, type MadeStroke, StrokeInHand } from './strokeInHand.ts';

/** Ground kept for undoing strokes at once; older strokes are undone by loading the ground anew. */
const MOST_PATCH_BYTES = 64 << 20;

/** A stroke begun with fewer touches than this in all fits into what an experiment holds, however long it is held. */
const FULL_TOUCHES = 0.9 * MAX_TOUCHES;

/** Where to drive: to the waypoints, one after the other, and then to the goal. */
export type Route = Pick<Experiment, 'waypoints' | 'goal'>;

interface Core {
  request(command: Command): Promise<void>;
  /** The page's copy of the ground. */
  ground(): Ground | undefined;
  /** What runs now; going back in time may have brought an earlier route back. */
  info(): Pick<SessionInfo, 'objects' | 'waypoints' | 'goal' | 'runsWith'> | undefined;
  /** Whether the run stands still under way, so that other settings can be tried where it stands. */
  mayThink(): boolean;
  /** The experiment or what can be undone has changed. */
  changed(editor: Editor): void;
}

export class Editor {
  readonly #core: Core;
  #history = new History();
  readonly #patches = new Map<Stroke, MadeStroke>();
  #patchBytes = 0;
  #loaded: Experiment | undefined;
  readonly #opened = new WeakSet<Experiment>();
  /** The scenario that the experiment is named after. */
  #scenario: Experiment | undefined;
  /** What stands on the ground where the document does not say it. */
  #unsaid: readonly WorldObject[] | undefined;
  #inHand: StrokeInHand | undefined;
  /** Changes are made one after the other. */
  #queue: Promise<void> = Promise.resolve();

  constructor(core: Core) {
    this.#core = core;
  }

  get experiment(): Experiment | undefined {
    return this.#history.current;
  }

  get canUndo(): boolean {
    return this.#history.earlier !== undefined;
  }

  get canRedo(): boolean {
    return this.#history.later !== undefined;
  }

  /** The core has loaded this. */
  loaded({ experiment, scenario }: Pick<Loaded, 'experiment' | 'scenario'>): void {
    this.#loaded = experiment;
    this.#opened.add(experiment);
    this.#scenario = scenario;
    this.#unsaid = experiment.objects ? undefined : this.#core.info()?.objects;
  }

  /** Whether ground, start and route are those of the scenario that the experiment is named after; nothing where there is none. */
  get asItComes(): boolean | undefined {
    return this.experiment && this.#scenario && sameCourse(this.experiment, this.#scenario);
  }

  /** The scenario that the experiment is named after, as it comes; nothing where there is none. */
  get scenario(): Experiment | undefined {
    return this.#scenario;
  }

  /** Whether the experiment is as it was opened. */
  get asOpened(): boolean {
    return this.experiment !== undefined && this.#opened.has(this.experiment);
  }

  /** The core has changed the ground here. */
  patched(patch: GroundPatch): void {
    this.#inHand?.patched(patch);
  }

  /** Shows what the core begins with; undoing leads back to one's own. */
  begin(begun: Promise<Beginning>): Promise<void> {
    return this.#next(async () => {
      const { from, own } = await begun;
      this.#history = new History();
      if (own && from !== 'last visit') this.#history.push(own.experiment);
      if (this.#loaded) this.#push(this.#loaded);
    });
  }

  /** Shows another experiment, and drives it at once with `play`; unless it is `undoable`, the history begins with it. */
  open(source: Source, undoable: boolean, play: boolean): Promise<void> {
    return this.#next(async () => {
      await this.#core.request({ type: 'load', source, play });
      if (!undoable) this.#history = new History();
      if (this.#loaded) this.#push(this.#loaded);
    });
  }

  /** Loads the current experiment again, after the core was lost. */
  reopen(): Promise<void> {
    return this.#next(async () => {
      const { experiment } = this;
      if (experiment) await this.#core.request({ type: 'load', source: { experiment }, play: false });
    });
  }

  /** Begins the run anew. */
  restart(): Promise<void> {
    return this.#next(async () => {
      const { experiment } = this;
      if (experiment && this.#core.info()?.runsWith)
        return this.#core.request({ type: 'load', source: { experiment }, play: false });
      await this.#takeOwnRoute();
      await this.#core.request({ type: 'restart' });
    });
  }

  /** Settings to try where the robot stands: the planner thinks again with them, and the run stays as it was. */
  think(part: Partial<Setup>): Promise<void> {
    return this.#edit(
      () => part,
      (experiment) => ({ type: 'think', setup: setupOf(experiment) }),
    );
  }

  /** Settings: the trial begins anew with them and drives, on the ground as it is. */
  change(part: Partial<Omit<Experiment, 'version' | 'strokes'>>): Promise<void> {
    return this.#edit(
      () => part,
      (experiment) => ({ type: 'load', source: { experiment }, play: true }),
    );
  }

  /** Parameters, and another seed if given: the trial begins anew with them. */
  setOverrides(overrides: Overrides, seed?: number): Promise<void> {
    const part = seed === undefined ? { overrides } : { overrides, seed };
    return this.#edit(
      () => part,
      () => ({ type: 'parameters', overrides, seed }),
    );
  }

  /** `route` is asked once all changes before are made. */
  setRoute(route: () => Route): Promise<void> {
    const tidy = () => {
      const { waypoints, goal } = route();
      return { waypoints: waypoints.map(tidyPlace), goal: tidyGoal(goal) };
    };
    return this.#edit(tidy, ({ waypoints, goal }) => ({ type: 'goal', goal, waypoints }));
  }

  setStart(heading: Heading): Promise<void> {
    const start = tidyHeading(heading);
    return this.#edit(
      () => ({ start }),
      () => ({ type: 'start', start }),
    );
  }

  /** Other objects in place of those there are, which `change` is given once all changes before are made. */
  setObjects(change: (objects: readonly WorldObject[]) => readonly WorldObject[]): Promise<void> {
    const tidy = () => {
      const [before, ground] = [this.#core.info()?.objects ?? [], this.#core.ground()];
      if (!ground) throw new Error('There is no ground yet.');
      const { columns, rows, cell_m } = ground;
      // What did not change stays as it was written.
      const keep = (object: WorldObject) =>
        before.includes(object) ? object : tidyObject(object, (columns - 1) * cell_m, (rows - 1) * cell_m);
      return { objects: change(before).map(keep) };
    };
    return this.#edit(tidy, ({ objects = [] }) => ({ type: 'objects', objects }));
  }

  /** Begins a stroke: `touch` it, then `end` it. Everything else waits until it has ended. */
  stroke(brush: Brush): { touch(place: Place): void; end(): Promise<void> } {
    const stroke = new StrokeInHand(brush, (part) => this.#core.request({ type: 'sculpt', stroke: part }));
    const made = this.#next(async () => {
      const [ground, { experiment }] = [this.#core.ground(), this];
      if (!ground || !experiment) throw new Error('There is no ground yet.');
      const touches = experiment.strokes.reduce((sum, { points_cm }) => sum + points_cm.length / 2, 0);
      if (touches > FULL_TOUCHES) {
        const advice = 'Save the heights as an ASCII grid and open them to go on';
        throw new Error(`An experiment holds no more than ${touches} touches. ${advice}.`);
      }
      this.#inHand = stroke;
      try {
        const result = await stroke.made(ground);
        if (!result) return;
        this.#keep(result);
        this.#push({ ...experiment, strokes: [...experiment.strokes, result.stroke] });
      } finally {
        this.#inHand = undefined;
      }
    });
    // Whoever ends the stroke hears of a failure.
    made.catch(() => undefined);
    return {
      touch: (place) => stroke.touch(place),
      end: () => {
        stroke.end();
        return made;
      },
    };
  }

  undo(): Promise<void> {
    return this.#next(async () => {
      await this.#become(this.#history.earlier);
      this.#history.back();
      this.#core.changed(this);
    });
  }

  redo(): Promise<void> {
    return this.#next(async () => {
      await this.#become(this.#history.later);
      this.#history.forth();
      this.#core.changed(this);
    });
  }

  #next(act: () => Promise<void>): Promise<void> {
    const result = this.#queue.then(act);
    this.#queue = result.catch(() => undefined);
    return result;
  }

  #edit(part: () => Partial<Experiment>, command: (experiment: Experiment) => Command): Promise<void> {
    return this.#next(async () => {
      const { experiment } = this;
      if (!experiment) throw new Error('No scenario is loaded yet.');
      const changed = { ...experiment, ...part() };
      const first = command(changed);
      // What is tried is no part of the run that these would begin anew.
      const anew = first.type === 'parameters' || first.type === 'start';
      if (anew && this.#core.info()?.runsWith) {
        await this.#core.request({ type: 'load', source: { experiment: changed }, play: false });
      } else {
        if (first.type === 'parameters') await this.#takeOwnRoute();
        await this.#core.request(first);
      }
      this.#push(changed);
    });
  }

  #push(experiment: Experiment): void {
    this.#history.push(experiment);
    this.#core.changed(this);
  }

  /** Makes the core show another document of the history: by small steps where they lead there, else by loading it. */
  async #become(to: Experiment | undefined): Promise<void> {
    const from = this.experiment;
    if (!to || !from) return;
    if (this.#core.mayThink() && differInSetup(from, to))
      return this.#core.request({ type: 'think', setup: setupOf(to) });
    const patches = this.#patchesBetween(from, to);
    const objects = to.objects ?? this.#unsaid;
    if (!patches || !(objects || from.objects === to.objects))
      return this.#core.request({ type: 'load', source: { experiment: to }, play: false });
    for (const patch of patches) await this.#core.request({ type: 'replace', patch });
    if (objects && from.objects !== to.objects) await this.#core.request({ type: 'objects', objects });
    if (from.start !== to.start) await this.#core.request({ type: 'start', start: to.start });
    const { goal, waypoints } = to;
    if (from.goal !== goal || from.waypoints !== waypoints) await this.#core.request({ type: 'goal', goal, waypoints });
  }

  /** What begins anew does so with the route of the experiment, also where an earlier one is shown. */
  async #takeOwnRoute(): Promise<void> {
    const [info, experiment] = [this.#core.info(), this.experiment];
    if (!info || !experiment) return;
    const { goal, waypoints } = experiment;
    if (JSON.stringify([goal, waypoints]) === JSON.stringify([info.goal, info.waypoints])) return;
    await this.#core.request({ type: 'goal', goal, waypoints });
  }

  /** The heights to put back, where the documents differ in strokes at the end, objects, start and route alone. */
  #patchesBetween(from: Experiment, to: Experiment): GroundPatch[] | undefined {
    const { strokes: _a, start: _b, goal: _c, waypoints: _d, objects: _e, ...rest } = from;
    const keys = Object.keys(rest) as (keyof typeof rest)[];
    if (keys.some((key) => from[key] !== to[key])) return undefined;
    const common = from.strokes.findIndex((stroke, index) => stroke !== to.strokes[index]);
    const shared = common < 0 ? from.strokes.length : common;
    const gone = from.strokes.slice(shared).reverse();
    const patches = gone.map((stroke) => this.#patches.get(stroke)?.before);
    patches.push(...to.strokes.slice(shared).map((stroke) => this.#patches.get(stroke)?.after));
    return patches.every((patch) => patch !== undefined) ? patches : undefined;
  }

  #keep(made: MadeStroke): void {
    this.#patches.set(made.stroke, made);
    this.#patchBytes += bytes(made);
    for (const [stroke, oldest] of this.#patches) {
      if (this.#patchBytes <= MOST_PATCH_BYTES) break;
      this.#patches.delete(stroke);
      this.#patchBytes -= bytes(oldest);
    }
  }
}

function bytes({ before, after }: MadeStroke): number {
  return before.heights_m.byteLength + after.heights_m.byteLength;
}

function setupOf({ preset, learning, overrides }: Experiment): Setup {
  return { preset, learning, overrides };
}

/** Whether they differ in nothing but the settings that can be tried under way. */
function differInSetup(from: Experiment, to: Experiment): boolean {
  const keys = Object.keys({ ...from, ...to }) as (keyof Experiment)[];
  return keys.every((key) => from[key] === to[key] || ['preset', 'learning', 'overrides'].includes(key));
}
