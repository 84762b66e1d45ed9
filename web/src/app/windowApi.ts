/**
 * `window.mapless`: the page's own controls as functions, for tests, teachers and the browser's console. Each promise
 * resolves once the simulation has carried the call out, and is rejected with a message when it could not. `docs/API.md`
 * says the same to those who use it.
 */

import { number } from '../base/checks.ts';
import type { Experiment, Stroke } from '../experiment/experiment.ts';
import { linkTo } from '../experiment/link.ts';
import type { WorldObject } from '../experiment/objects.ts';
import type { Overrides } from '../experiment/overrides.ts';
import type { Goal, Heading, Place } from '../experiment/place.ts';
import { readExperiment, readStroke } from '../experiment/readExperiment.ts';
import { readObjects } from '../experiment/readObjects.ts';
import type { Setting, Setup } from '../experiment/setting.ts';
import type { Frame, SessionInfo, SetAside } from '../protocol/simulationProtocol.ts';
import type { App } from './app.ts';

/** Arrays and what only drawing needs stay out. */
type Drawn = 'buffers' | 'trail' | 'rows' | 'anew' | 'ahead' | 'movers' | 'path' | 'sensor' | 'segments' | 'subgoals';

/** What the page shows, as plain data. */
export type MaplessState = Omit<Frame, Drawn | 'stop_reason' | 'set_aside' | 'mount_misfit' | 'waypoints_passed'> &
  Pick<
    SessionInfo,
    'scenario' | 'preset' | 'learning' | 'seed' | 'start' | 'waypoints' | 'goal' | 'objects' | 'overrides' | 'reality'
  > & {
    /** Why the planner stopped, where it did. */
    readonly stopReason: string | undefined;
    /** How many returns of the last scan the planner set aside, by kind. */
    readonly setAside: SetAside;
    /** Where the ground in the first scan does not fit the mount of the sensor: what to do about it. */
    readonly mountMisfit: string | undefined;
    readonly waypointsPassed: number;
    readonly playing: boolean;
    readonly speed: number;
    readonly ground: { readonly columns: number; readonly rows: number; readonly cell_m: number };
    /** How many segments and subgoals the last tick found. */
    readonly segments: number;
    readonly subgoals: number;
    /** Whether ground or route were changed under way, so that a restart drives differently. */
    readonly disturbed: boolean;
  };

export interface MaplessApi {
  /** Nothing until the first scenario is loaded. */
  state(): MaplessState | undefined;
  /** Loads a scenario by its name, such as `cht-ad`; the seed is the scenario's own unless given. */
  loadScenario(scenario: string, options?: Partial<Setting> & { seed?: number }): Promise<void>;
  play(): Promise<void>;
  /** Resolves once the state is that of the last tick. */
  pause(): Promise<void>;
  /** Pauses; resolves once the view is drawn and nothing in it moves any more: a picture taken then is the picture. */
  still(): Promise<void>;
  /** One planning tick; pauses first. */
  step(): Promise<void>;
  restart(): Promise<void>;
  /** Simulated seconds per second; `Infinity` is as fast as it goes. */
  setSpeed(speed: number): Promise<void>;
  /** The goal, with a final heading if it has one, and with waypoints that are driven to before it. */
  setGoal(goal: Goal, waypoints?: readonly Place[]): Promise<void>;
  /** Goes to a tick of the run so far and pauses; the state's `timeline` says which there are. */
  seek(tick: number): Promise<void>;
  /** Begins anew with other parameters, as tables with the names of a scenario file: `{ sensor: { range_noise_m: 0.1 } }`. */
  setOverrides(overrides: Overrides): Promise<void>;
  /** Planner, learning or parameters: while the run is paused they are tried where the robot stands, otherwise it begins anew with them and drives. */
  adjust(setup: Partial<Setup>): Promise<void>;
  setStart(start: Heading): Promise<void>;
  sculpt(stroke: Stroke): Promise<void>;
  /** Puts objects on the ground in place of all there are. */
  setObjects(objects: readonly WorldObject[]): Promise<void>;
  /** Everything that a run depends on, as plain data; nothing until the first scenario is loaded. */
  experiment(): Experiment | undefined;
  /** Loads an experiment, after checking it. */
  openExperiment(experiment: unknown): Promise<void>;
  /** A link that reopens the experiment; a long one for much sculpting. */
  link(): Promise<string>;
  undo(): Promise<void>;
  redo(): Promise<void>;
  /** Height of the ground in metres, nothing outside it. */
  heightAt(place: Place): number | undefined;
  /** World-frame x, y, z of the newest scan's returns. */
  scan(): Float32Array;
}

declare global {
  interface Window {
    mapless?: MaplessApi;
  }
}

export function publish(app: App): void {
  const used =
    <Arguments extends unknown[]>(act: (...args: Arguments) => Promise<void>) =>
    async (...args: Arguments) => {
      app.touch();
      await act(...args);
    };
  window.mapless = {
    state: () => app.state(),
    loadScenario: used((scenario, { seed, ...setting } = {}) => app.load(scenario, setting, seed)),
    play: used(() => app.play()),
    pause: used(() => app.pause()),
    still: used(() => app.still()),
    step: used(() => app.step()),
    restart: used(() => app.restart()),
    setSpeed: used((speed: number) => app.setSpeed(number(speed, 'speed', 0.01, Number.POSITIVE_INFINITY))),
    setGoal: used((goal: Goal, waypoints?: readonly Place[]) => {
      if (goal.heading_rad !== undefined) number(goal.heading_rad, 'goal.heading_rad', -1000, 1000);
      return app.course.setGoal(goal, waypoints);
    }),
    seek: used((tick: number) => app.seek(number(tick, 'tick', 0, Number.MAX_SAFE_INTEGER))),
    setOverrides: used((overrides: Overrides) => app.setOverrides(overrides)),
    adjust: used((setup: Partial<Setup>) => app.adjust(setup)),
    setStart: used((start: Heading) => app.course.setStart(start)),
    sculpt: used((stroke: Stroke) => app.course.sculpt(readStroke(stroke))),
    setObjects: used(async (objects: readonly WorldObject[]) => {
      const read = readObjects(objects);
      await app.course.setObjects(() => read);
    }),
    experiment: () => app.editor.experiment,
    openExperiment: used(async (value: unknown) => app.open({ experiment: readExperiment(value) })),
    link: async () => {
      const { experiment } = app.editor;
      if (!experiment) throw new Error('No scenario is loaded yet.');
      return linkTo(location.href, experiment);
    },
    undo: used(() => app.undo()),
    redo: used(() => app.redo()),
    heightAt: (place) => app.heightAt(place),
    scan: () => app.scan(),
  };
}
