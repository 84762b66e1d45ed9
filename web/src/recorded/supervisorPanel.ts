/** The supervisor of an open recording as a state machine, and faults that are put in by hand. */

import { button, html, setText, svg } from '../base/dom.ts';
import { clock, fixed } from '../base/format.ts';
import type { RecordedFrame, SupervisorInfo, SupervisorTransition } from './recordedProtocol.ts';

const EVENT_WORDS: Record<string, string> = {
  Goal: 'a goal',
  NoGoal: 'no goal',
  Pause: 'what passes by itself',
  Abort: 'what needs a new goal',
  Latch: 'what needs a reset',
  Clear: 'in order again',
  Reset: 'reset',
};

const FAULT_WORDS: Record<string, string> = {
  no_scan: 'No scan comes',
  no_odometry: 'No odometry comes',
  no_imu: 'Nothing comes from the IMU',
  imu_not_finite: 'The IMU’s orientation is not a number',
  tilt: 'The IMU says that the robot leans',
  pose_jump: 'The odometry is 3 m off',
  emergency_stop: 'The emergency stop is pressed',
  emergency_stop_silent: 'The emergency stop tells nothing',
  planner_silent: 'The planner does not answer',
  planner_panic: 'The planner panics',
  planner_not_finite: 'The planner’s speed is not a number',
  peer_lost: 'Nobody takes the commands',
  publish_failed: 'Commands are not published',
  other_publisher: 'Somebody else publishes commands',
  suspended: 'The process is suspended',
};

/** Where the states stand in the picture. */
const PLACES: Record<string, readonly [number, number]> = {
  Driving: [170, 20],
  Paused: [288, 84],
  Aborted: [244, 172],
  Latched: [96, 172],
  Standby: [52, 84],
};
const [WIDTH, HEIGHT] = [340, 192];
const [NODE_WIDTH, NODE_HEIGHT] = [80, 30];
/** An arrow and the one back stand so far apart. */
const APART = 5;

/** A fault that is put in. */
interface PutIn {
  readonly kind: string;
  readonly from_s: number;
  readonly length_s: number;
}

export class SupervisorPanel {
  readonly section = html('section', 'drive');
  readonly #transitions: readonly SupervisorTransition[];
  readonly #putIn: (faults: readonly string[], time_s: number) => void;
  readonly #picture = svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: 'states', role: 'img' });
  readonly #states = new Map<string, SVGGElement>();
  readonly #arrows: { readonly from: string; readonly line: SVGPathElement }[] = [];
  readonly #onward = html('ul', 'drive-notes');
  readonly #kind = html('select');
  readonly #length = html('input');
  readonly #put: HTMLButtonElement;
  readonly #list = html('ul', 'drive-faults');
  #faults: PutIn[] = [];
  #state: string | undefined;
  #time_s = 0;

  constructor({ transitions, faultKinds }: SupervisorInfo, putIn: (faults: readonly string[], time_s: number) => void) {
    [this.#transitions, this.#putIn] = [transitions, putIn];
    const title = html('h2', '', ['Supervisor']);
    title.id = 'supervisor-title';
    this.section.setAttribute('aria-labelledby', title.id);
    this.#draw();
    for (const kind of faultKinds) this.#kind.append(new Option(FAULT_WORDS[kind] ?? kind, kind));
    Object.assign(this.#length, { type: 'number', min: '0.05', max: '10', step: '0.05', value: '0.5', required: true });
    this.#put = html('button', 'filled');
    const form = html('form', 'drive-fault', [
      html('label', 'field', [html('span', '', ['Fault']), this.#kind]),
      html('label', 'field', [html('span', '', ['for, s']), this.#length]),
      this.#put,
    ]);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.#add();
    });
    const words =
      'A fault goes into the recording here. Supervisor and planner decide anew from there on; the robot’s way stays as it was recorded.';
    this.section.append(title, this.#picture, this.#onward, html('p', 'drive-notes', [words]), form, this.#list);
  }

  show({ state, time_s }: RecordedFrame): void {
    this.#time_s = time_s;
    setText(this.#put, `Put in at ${clock(time_s)}`);
    if (state === this.#state) return;
    this.#state = state;
    for (const [name, group] of this.#states) group.toggleAttribute('data-now', name === state);
    for (const { from, line } of this.#arrows) line.toggleAttribute('data-now', from === state);
    const onward = this.#transitions.filter(({ from }) => from === state);
    const lines = onward.map(
      ({ to, events }) => `${events.map((event) => EVENT_WORDS[event] ?? event).join(', ')} → ${to}`,
    );
    this.#onward.replaceChildren(...lines.map((line) => html('li', '', [line])));
    const words = state ? `It is in the state ${state}. From there: ${lines.join('; ')}.` : 'It has not decided yet.';
    this.#picture.setAttribute('aria-label', `The supervisor’s states. ${words}`);
  }

  #draw(): void {
    const tip = svg('path', { d: 'M0 0 6 3 0 6Z' });
    const marker = { viewBox: '0 0 6 6', refX: 6, refY: 3, markerWidth: 6, markerHeight: 6, orient: 'auto' };
    for (const id of ['states-tip', 'states-tip-now']) {
      this.#picture.append(svg('marker', { ...marker, id, class: id }, [tip.cloneNode()]));
    }
    for (const { from, to } of this.#transitions) {
      const [begin, end] = [PLACES[from], PLACES[to]];
      if (!begin || !end) continue;
      const line = svg('path', { d: arrow(begin, end), class: 'states-arrow' });
      this.#arrows.push({ from, line });
      this.#picture.append(line);
    }
    for (const [name, [x, y]] of Object.entries(PLACES)) {
      const box = { x: x - NODE_WIDTH / 2, y: y - NODE_HEIGHT / 2, width: NODE_WIDTH, height: NODE_HEIGHT, rx: 8 };
      const group = svg('g', { class: 'states-state' }, [svg('rect', box), svg('text', { x, y }, [name])]);
      this.#states.set(name, group);
      this.#picture.append(group);
    }
  }

  #add(): void {
    const length_s = this.#length.valueAsNumber;
    this.#faults.push({ kind: this.#kind.value, from_s: this.#time_s, length_s });
    this.#decide(this.#time_s + length_s);
  }

  #decide(time_s: number): void {
    const faults = this.#faults.map(({ kind, from_s, length_s }) => `${kind}@${from_s}+${length_s}`);
    this.#putIn(faults, time_s);
    this.#list.replaceChildren(
      ...this.#faults.map((fault) => {
        const words = `${FAULT_WORDS[fault.kind] ?? fault.kind}, at ${clock(fault.from_s)} for ${fixed(fault.length_s, 2)} s`;
        const out = button('plain', 'Take out', () => {
          this.#faults = this.#faults.filter((other) => other !== fault);
          this.#decide(this.#time_s);
        });
        out.setAttribute('aria-label', `Take out: ${words}`);
        return html('li', 'row', [html('span', '', [words]), out]);
      }),
    );
  }
}

/** From the edge of one state to that of another, aside from the way back. */
function arrow([fromX, fromY]: readonly [number, number], [toX, toY]: readonly [number, number]): string {
  const length = Math.hypot(toX - fromX, toY - fromY);
  const [x, y] = [(toX - fromX) / length, (toY - fromY) / length];
  // Until the line leaves the box of a state.
  const out = Math.min(NODE_WIDTH / 2 / Math.abs(x), NODE_HEIGHT / 2 / Math.abs(y));
  const [asideX, asideY] = [-y * APART, x * APART];
  const at = (along: number) => `${fromX + x * along + asideX} ${fromY + y * along + asideY}`;
  return `M${at(out + 4)}L${at(length - out - 6)}`;
}
