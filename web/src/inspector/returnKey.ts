/** The key of the returns that the planner sets aside, with how many there are; only while there are some to see. */

import { byId, html, setText, svg } from '../base/dom.ts';
import { grouped } from '../base/format.ts';
import { SET_ASIDE, type SetAside, type SetAsideKind } from '../protocol/simulationProtocol.ts';

/** Name, meaning, and the form that the 3D view draws in a square of 12. */
const WORDS: Record<SetAsideKind, readonly [string, string, string]> = {
  stray: [
    'stray',
    'Returns that stand alone in the air: rain, dust, insects. The planner sets them aside.',
    'm2 2 8 8m0-8-8 8',
  ],
  body: ['on the robot', 'Returns on the robot itself. The planner sets them aside.', 'M2.5 2.5h7v7h-7z'],
  overhead: ['overhead', 'Returns on what the robot can pass below. The planner sets them aside.', 'm6 2 4.5 8h-9z'],
};

export class ReturnKey {
  readonly #list = byId('return-key', HTMLElement);
  readonly #rows: readonly { kind: SetAsideKind; row: HTMLElement; count: HTMLElement }[];
  #counts: SetAside = { stray: 0, body: 0, overhead: 0 };
  #hidden = false;

  constructor() {
    this.#rows = SET_ASIDE.map((kind) => {
      const [name, meaning, form] = WORDS[kind];
      const count = html('span', 'return-count');
      const mark = svg('svg', { class: `return-${kind}`, viewBox: '0 0 12 12', 'aria-hidden': 'true' }, [
        svg('path', { d: form }),
      ]);
      const row = html('li', '', [mark, name, count]);
      row.title = meaning;
      return { kind, row, count };
    });
    this.#list.append(...this.#rows.map(({ row }) => row));
  }

  show(counts: SetAside): void {
    this.#counts = counts;
    for (const { kind, row, count } of this.#rows) {
      row.hidden = counts[kind] === 0;
      setText(count, grouped(counts[kind]));
    }
    this.#arrange();
  }

  /** Whether the view shows no returns. */
  hide(hidden: boolean): void {
    this.#hidden = hidden;
    this.#arrange();
  }

  #arrange(): void {
    this.#list.hidden = this.#hidden || SET_ASIDE.every((kind) => this.#counts[kind] === 0);
  }
}
