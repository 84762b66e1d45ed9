/** The decision by hand: the weights of the cost are dragged, candidates are weighed anew, and changes of mind are gone through. */

import '../style/method.css';
import type { App } from '../app/app.ts';
import { html, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import { type Overrides, override, withOverride } from '../experiment/overrides.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import { changeOfMind, whatChangedIt } from './changesOfMind.ts';
import { Newest } from './newest.ts';

const TABLE = 'planner.decision';
const WEIGHTS = ['direction', 'distance', 'steepness', 'climb', 'commitment', 'correction'] as const;
/** The paper has the first three. */
const PAPER_WEIGHTS = 3;
const HIGHEST = 3;

export class Weighing {
  readonly element = html('div', 'weighing');
  readonly #app: App;
  readonly #rows: readonly { name: string; row: HTMLElement; input: HTMLInputElement; output: HTMLOutputElement }[];
  readonly #said = html('p', 'weighing-said');
  readonly #newest = new Newest();

  constructor(app: App) {
    this.#app = app;
    this.#rows = WEIGHTS.map((weight) => {
      const name = `${weight}_weight`;
      const input = html('input');
      Object.assign(input, { type: 'range', min: '0', max: String(HIGHEST), step: '0.05', id: `weight-${weight}` });
      const output = html('output');
      output.htmlFor = input.id;
      input.addEventListener('input', () => {
        setText(output, fixed(Number(input.value), 2));
        this.#try(name, Number(input.value), (overrides) => app.tryOut(overrides).catch(() => undefined));
      });
      input.addEventListener('change', () =>
        this.#try(name, Number(input.value), (overrides) => app.attempt(app.adjust({ overrides }))),
      );
      return { name, row: html('label', 'knob', [html('span', '', [weight]), input, output]), input, output };
    });
    this.#said.setAttribute('role', 'status');
    const step = (text: string, title: string, by: 1 | -1) => {
      const made = html('button', 'plain', [text]);
      made.type = 'button';
      made.title = title;
      made.addEventListener('click', () => this.#step(by));
      return made;
    };
    this.element.append(
      html('p', 'lab-note', ['Drag a weight: the candidates are weighed anew where the robot stands.']),
      html(
        'div',
        'knobs',
        this.#rows.map(({ row }) => row),
      ),
      html('div', 'method-row', [
        html('span', 'method-count', ['Changes of mind']),
        step('Earlier', 'To the change of mind before', -1),
        step('Next', 'To the next change of mind', 1),
      ]),
      this.#said,
    );
    if (app.info) this.session(app.info);
  }

  session(info: SessionInfo): void {
    const parameters = info.parameters.find(({ table }) => table === TABLE)?.parameters ?? [];
    this.#rows.forEach(({ name, row, input, output }, index) => {
      row.hidden = info.preset === 'paper' && index >= PAPER_WEIGHTS;
      const own = parameters.find((one) => one.name === name);
      const value = Number(override(info.overrides, TABLE, name) ?? own?.value);
      row.title = own?.text ?? '';
      // A slider in hand stays where it is: what comes in is older.
      if (this.#newest.busy && input === document.activeElement) return;
      input.value = String(value);
      setText(output, fixed(value, 2));
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
