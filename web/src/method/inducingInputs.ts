/** The inducing inputs over the image: shown, placed otherwise, and taken away one by one. */

import { button, html, setText } from '../base/dom.ts';
import { Newest } from '../base/newest.ts';
import { css } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Plot } from '../inspector/imagePlot.ts';
import { azimuthOf, columnsApart, elevationOf } from '../inspector/lattice.ts';
import type { Inside, InsideQuestion, Placement, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { InducingInput } from './slice.ts';

/** What is pressed this near, in columns and rows, is meant. */
const REACH = { columns: 4, rows: 2 };

const PLACEMENTS: readonly [Placement | '', string][] = [
  ['', 'the planner’s own'],
  ['lattice', 'on the lattice'],
  ['farthest_points', 'farthest points'],
  ['strided', 'every nth return'],
];

interface Host {
  look(question: InsideQuestion): Promise<Inside>;
  /** There is another answer. */
  changed(): void;
  pause(): Promise<void>;
  failed(error: unknown): void;
}

export class InducingInputs {
  readonly element: HTMLElement;
  readonly #host: Host;
  readonly #choice = html('select');
  readonly #said = html('span', 'method-count');
  readonly #take = button('plain', 'Take one away', () => this.#takeNearest());
  /** Without it, a press in the image only moves the slice. */
  readonly #byPress = button('plain', 'By press', () => {
    this.#byPress.setAttribute('aria-pressed', String(!this.#pressTakes));
  });
  readonly #back = button('plain', 'Put back', () => this.#putBack());
  readonly #newest = new Newest();
  #without: readonly number[] = [];
  #inside: Inside | undefined;
  #list: readonly InducingInput[] = [];
  #at = { column: 180, row: 15 };
  /** What the list belongs to. */
  #scan = '';

  constructor(host: Host) {
    this.#host = host;
    for (const [value, name] of PLACEMENTS) this.#choice.append(new Option(name, value));
    this.#choice.addEventListener('change', () => {
      this.#without = [];
      this.#answer(true);
    });
    this.#take.title = 'The one nearest to the slice: a false hole may open there';
    this.#byPress.title = 'A press in the image takes an inducing input away, or puts it back';
    this.#byPress.setAttribute('aria-pressed', 'false');
    this.#back.disabled = true;
    this.element = html('div', 'method-inputs', [
      html('label', 'method-choice', [html('span', '', ['Inducing inputs']), this.#choice]),
      html('div', 'method-row', [this.#said, this.#take, this.#byPress, this.#back]),
    ]);
  }

  /** Whether the process is the planner's own; nothing before it is known. */
  get isOwn(): boolean | undefined {
    return this.#choice.value === '' && this.#without.length === 0;
  }

  get inside(): Inside | undefined {
    return this.#inside;
  }

  get list(): readonly InducingInput[] {
    return this.#list;
  }

  /** There is a frame; with another `scan` than before, or other parameters, its inputs are others. */
  scanned(playing: boolean, scan: string): void {
    if (playing) {
      this.#forget();
      return;
    }
    if (scan === this.#scan) return;
    this.#scan = scan;
    this.#without = [];
    this.#answer(false);
  }

  reset(): void {
    this.#choice.value = '';
    this.#byPress.setAttribute('aria-pressed', 'false');
    this.#forget();
  }

  get #pressTakes(): boolean {
    return this.#byPress.getAttribute('aria-pressed') === 'true';
  }

  /** The image was pressed here: takes away the input there, or puts it back, where presses do. */
  pressed(column: number, row: number): void {
    this.#at = { column, row };
    if (!this.#pressTakes) return;
    const near = this.#nearest(
      (one) => this.#apart(one, column) <= REACH.columns && Math.abs(one.row - row) <= REACH.rows,
    );
    if (near === undefined) return;
    this.#without = this.#without.includes(near)
      ? this.#without.filter((one) => one !== near)
      : [...this.#without, near];
    this.#answer(true);
  }

  draw(context: CanvasRenderingContext2D, plot: Plot, image: SessionInfo['image'], theme: Theme): void {
    for (const { column, row, out } of this.#list) {
      if (row >= image.rows) continue;
      const [x, y] = [plot.x(azimuthOf(column, image.columns)), plot.y(elevationOf(row, image.rows))];
      context.beginPath();
      context.arc(x, y, plot.detailed ? 2.6 : 1.6, 0, 2 * Math.PI);
      context.lineWidth = 1;
      context.strokeStyle = out ? css(theme.danger) : 'rgb(255 255 255 / 0.85)';
      context.fillStyle = out ? 'transparent' : 'rgb(0 0 0 / 0.75)';
      context.fill();
      context.stroke();
    }
  }

  #takeNearest(): void {
    const { column, row } = this.#at;
    const kept = this.#nearest((one) => !one.out, column, row);
    if (kept === undefined) return;
    this.#without = [...this.#without, kept];
    this.#answer(true);
  }

  /** The column that the slice goes through, and the row where its skyline is. */
  lookAt(column: number, row: number): void {
    this.#at = { column, row };
  }

  #putBack(): void {
    this.#without = [];
    this.#answer(true);
  }

  #nearest(passes: (one: InducingInput) => boolean, column = this.#at.column, row = this.#at.row): number | undefined {
    let [best, least] = [-1, Number.POSITIVE_INFINITY];
    this.#list.forEach((one, index) => {
      const apart = Math.hypot(this.#apart(one, column), 2 * (one.row - row));
      if (passes(one) && apart < least) [best, least] = [index, apart];
    });
    return best < 0 ? undefined : best;
  }

  #apart(one: InducingInput, column: number): number {
    return columnsApart(one.column, column, this.#inside?.profile.length ?? 0);
  }

  #forget(): void {
    this.#without = [];
    this.#inside = undefined;
    this.#list = [];
    this.#scan = '';
    this.#say();
  }

  /** Asks the core; `byHand` if somebody changed something, for which the run stands still. */
  #answer(byHand: boolean): void {
    this.#newest.do(async () => {
      try {
        if (byHand) await this.#host.pause();
        const placement = PLACEMENTS.find(([value]) => value === this.#choice.value)?.[0] || undefined;
        const without = [...this.#without];
        this.#inside = await this.#host.look({ ...(placement ? { placement } : {}), without });
        const { inducing } = this.#inside;
        this.#list = Array.from({ length: inducing.length / 2 }, (_, index) => ({
          column: inducing[2 * index] ?? 0,
          row: inducing[2 * index + 1] ?? 0,
          out: without.includes(index),
        }));
        this.#say();
        this.#host.changed();
      } catch (error) {
        this.#host.failed(error);
      }
    });
  }

  #say(): void {
    const [all, out] = [this.#list.length, this.#without.length];
    setText(this.#said, all === 0 ? '' : out === 0 ? `${all}` : `${all - out} of ${all}`);
    this.#back.disabled = out === 0;
    this.#take.disabled = all === 0;
  }
}
