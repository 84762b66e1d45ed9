/** The key of the view: where the robot believes to be, and returns that the planner sets aside; each only while there is some to see. */

import { byId, html, setText, svg } from '../base/dom.ts';
import { fixed, grouped } from '../base/format.ts';
import { type Frame, SET_ASIDE, type SetAside, type SetAsideKind } from '../protocol/simulationProtocol.ts';

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

const BELIEVED = 'Where the planner believes the robot to be, and how far that is from where it is.';

export class ViewKey {
  readonly #list = byId('view-key', HTMLElement);
  readonly #apart = html('span', 'key-count');
  readonly #believed: HTMLElement;
  readonly #rows: readonly { kind: SetAsideKind; row: HTMLElement; count: HTMLElement }[];
  #counts: SetAside = { stray: 0, body: 0, overhead: 0 };
  #hidden = false;

  constructor() {
    const robot = svg('svg', { class: 'key-believed', viewBox: '0 0 12 12', 'aria-hidden': 'true' }, [
      svg('path', { d: 'M1.5 3h6L11 6 7.5 9h-6z' }),
    ]);
    this.#believed = html('li', '', [robot, 'believed', this.#apart]);
    this.#believed.title = BELIEVED;
    this.#believed.hidden = true;
    this.#rows = SET_ASIDE.map((kind) => {
      const [name, meaning, form] = WORDS[kind];
      const count = html('span', 'key-count');
      const mark = svg('svg', { class: `return-${kind}`, viewBox: '0 0 12 12', 'aria-hidden': 'true' }, [
        svg('path', { d: form }),
      ]);
      const row = html('li', '', [mark, name, count]);
      row.title = meaning;
      return { kind, row, count };
    });
    this.#list.append(this.#believed, ...this.#rows.map(({ row }) => row));
  }

  show({ set_aside, pose, believed }: Pick<Frame, 'set_aside' | 'pose' | 'believed'>): void {
    this.#counts = set_aside;
    this.#believed.hidden = believed === undefined;
    if (believed) {
      const apart_m = Math.hypot(believed.x - pose.x, believed.y - pose.y, believed.z - pose.z);
      setText(this.#apart, `${fixed(apart_m, 2)} m off`);
    }
    this.#arrange();
  }

  /** Whether the view shows no returns. */
  hide(hidden: boolean): void {
    this.#hidden = hidden;
    this.#arrange();
  }

  #arrange(): void {
    for (const { kind, row, count } of this.#rows) {
      row.hidden = this.#hidden || this.#counts[kind] === 0;
      setText(count, grouped(this.#counts[kind]));
    }
    this.#list.hidden = this.#believed.hidden && this.#rows.every(({ row }) => row.hidden);
  }
}
