/** The decision by hand: the weights of the cost are dragged, candidates are weighed anew, and changes of mind are gone through. */

import '../style/method.css';
import type { App } from '../app/app.ts';
import { button, html, setText } from '../base/dom.ts';
import { fixed, radians } from '../base/format.ts';
import { Newest } from '../base/newest.ts';
import { type Overrides, override, withOverride } from '../experiment/overrides.ts';
import type { Place } from '../experiment/place.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Stage } from '../view/stage.ts';
import { changeOfMind, whatChangedIt } from './changesOfMind.ts';
import { type Scale, Slider } from './slider.ts';
import { whyThere } from './whyThere.ts';

const TABLE = 'planner.decision';
const WEIGHTS = ['direction', 'distance', 'steepness', 'climb', 'commitment', 'correction'] as const;
/** The paper has the first three. */
const PAPER_WEIGHTS = 3;
const SCALE: Scale = { lowest: 0, highest: 3, steps: 60, words: (value) => fixed(value, 2) };
/** To the right positive, as on the slider. */
const BEARING: Scale = { lowest: -180, highest: 180, steps: 360, words: (value) => `${fixed(value, 0)}°` };
const DISTANCE: Scale = { lowest: 1, highest: 15, steps: 28, words: (value) => `${fixed(value, 1)} m` };
/** Radius of the mark on the ground: about half of the robot. */
const MARK_M = 0.5;

export class Weighing {
  readonly element = html('div', 'weighing');
  readonly #app: App;
  readonly #weights: readonly { name: string; slider: Slider }[];
  readonly #said = html('p', 'weighing-said');
  readonly #newest = new Newest();
  readonly #stage: Stage | undefined;
  readonly #bearing = new Slider('bearing', BEARING, () => this.#askThere());
  readonly #distance = new Slider('distance', DISTANCE, () => this.#askThere());
  readonly #why = html('p', 'weighing-said');

  /** `view` is the canvas of the 3D view: while this is open, a press on its ground asks why the robot does not go there. */
  constructor(app: App, stage: Stage | undefined, view: HTMLCanvasElement) {
    this.#app = app;
    this.#stage = stage;
    this.#why.setAttribute('role', 'status');
    [this.#bearing.value, this.#distance.value] = [0, 5];
    [this.#bearing.label, this.#distance.label] = ['Bearing of the place', 'Distance of the place'];
    view.addEventListener('click', ({ clientX, clientY }) => {
      const place = view.dataset.tool === 'look' && this.#isOpen ? stage?.pick(clientX, clientY) : undefined;
      if (place) this.#ask(place);
    });
    this.#weights = WEIGHTS.map((weight) => {
      const name = `${weight}_weight`;
      const slider = new Slider(
        weight,
        SCALE,
        (value) => this.#try(name, value, (overrides) => app.tryOut(overrides).catch(() => undefined)),
        (value) => this.#try(name, value, (overrides) => app.attempt(app.adjust({ overrides }))),
      );
      return { name, slider };
    });
    this.#said.setAttribute('role', 'status');
    const step = (text: string, title: string, by: 1 | -1) => {
      const made = button('plain', text, () => this.#step(by));
      made.title = title;
      return made;
    };
    this.element.append(
      html('p', 'lab-note', ['Drag a weight: the candidates are weighed anew where the robot stands.']),
      html(
        'div',
        'knobs',
        this.#weights.map(({ slider }) => slider.row),
      ),
      html('div', 'method-row', [
        html('span', 'method-count', ['Changes of mind']),
        step('Earlier', 'To the change of mind before', -1),
        step('Next', 'To the next change of mind', 1),
      ]),
      this.#said,
      html('h3', '', ['Why not there?']),
      html('p', 'lab-note', ['Press the ground in the view, or choose a place around the robot.']),
      this.#bearing.row,
      this.#distance.row,
      this.#why,
    );
    if (app.info) this.session(app.info);
  }

  session(info: SessionInfo): void {
    const parameters = info.parameters.find(({ table }) => table === TABLE)?.parameters ?? [];
    this.#weights.forEach(({ name, slider }, index) => {
      slider.row.hidden = info.preset === 'paper' && index >= PAPER_WEIGHTS;
      const own = parameters.find((one) => one.name === name);
      slider.row.title = own?.text ?? '';
      // A slider in hand stays where it is: what comes in is older.
      if (this.#newest.busy && slider.isInHand) return;
      slider.value = Number(override(info.overrides, TABLE, name) ?? own?.value);
    });
  }

  /** Takes the mark off the ground. */
  close(): void {
    this.#stage?.brush({ x: 0, y: 0 }, { x: 0, y: 0 }, 0);
    setText(this.#why, '');
  }

  get #isOpen(): boolean {
    return this.element.checkVisibility();
  }

  /** The place that bearing and distance say. */
  #askThere(): void {
    const { frame } = this.#app;
    if (!frame) return;
    const bearing_rad = frame.pose.yaw - radians(this.#bearing.value);
    const distance_m = this.#distance.value;
    const { x, y } = frame.pose;
    this.#ask({ x: x + distance_m * Math.cos(bearing_rad), y: y + distance_m * Math.sin(bearing_rad) });
  }

  #ask({ x, y }: Place): void {
    const place = { x, y };
    this.#newest.do(async () => {
      await this.#app.pause();
      const report = await this.#app.insight.reportOn(place);
      const { frame, info } = this.#app;
      if (!frame || !info) return;
      this.#stage?.brush(place, place, MARK_M);
      setText(this.#why, whyThere(place, report, frame, info));
    });
  }

  #try(name: string, value: number, act: (overrides: Overrides) => Promise<void>): void {
    this.#newest.do(async () => {
      this.#app.touch();
      await this.#app.pause();
      const { info } = this.#app;
      if (info) await act(withOverride(info.overrides, TABLE, name, value));
    });
  }

  #step(by: 1 | -1): void {
    this.#newest.do(() => this.#app.attempt(this.#go(by)));
  }

  async #go(by: 1 | -1): Promise<void> {
    const app = this.#app;
    await app.pause();
    const { frame } = app;
    const tick = frame && changeOfMind(app.record, frame.tick, by, frame.timeline.first);
    if (tick === undefined) {
      setText(this.#said, `No ${by > 0 ? 'later' : 'earlier'} change of mind in the run so far.`);
      return;
    }
    await app.seek(tick);
    const before = app.frame;
    if (!before) return;
    // Its arrays are taken back with the next frame; what is needed of it is not among them.
    const former = before.subgoals.find(({ chosen }) => chosen);
    await app.seek(tick + 1);
    if (app.frame) setText(this.#said, whatChangedIt(former, before, app.frame));
  }
}
