/** A stroke while it is being made: touches go to the core as they come, and what the ground was before is kept for undoing. */

import { gate } from '../base/gate.ts';
import { centimetres, type Stroke } from '../experiment/experiment.ts';
import type { Place } from '../experiment/place.ts';
import type { Ground, GroundPatch } from '../protocol/simulationProtocol.ts';

export type Brush = Omit<Stroke, 'points_cm'>;

/** A finished stroke, and the ground where it worked. */
export interface MadeStroke {
  readonly stroke: Stroke;
  readonly before: GroundPatch;
  readonly after: GroundPatch;
}

export class StrokeInHand {
  readonly #brush: Brush;
  readonly #apply: (stroke: Stroke) => Promise<void>;
  readonly #begun = gate();
  readonly #ended = gate();
  #working: Promise<void> = this.#begun.passed;
  #waiting: number[] = [];
  #done: number[] = [];
  #bounds: Omit<GroundPatch, 'heights_m'> | undefined;

  constructor(brush: Brush, apply: (stroke: Stroke) => Promise<void>) {
    this.#brush = brush;
    this.#apply = apply;
  }

  /** Adds a touch. While the core is slower than the pointer, touches go to it several at once. */
  touch({ x, y }: Place): void {
    this.#waiting.push(centimetres(x), centimetres(y));
    this.#working = this.#working.then(() => this.#send());
  }

  end(): void {
    this.#ended.open();
  }

  /** Lets touches go to work on this ground, and waits for the end. Nothing comes of a stroke beside the terrain. */
  async made(ground: Ground): Promise<MadeStroke | undefined> {
    const before = ground.heights_m.slice();
    this.#begun.open();
    await this.#ended.passed;
    await this.#working;
    if (!this.#bounds) return undefined;
    return {
      stroke: { ...this.#brush, points_cm: this.#done },
      before: cut(before, ground.columns, this.#bounds),
      after: cut(ground.heights_m, ground.columns, this.#bounds),
    };
  }

  /** The core has changed the ground here. */
  patched({ column, row, columns, rows }: GroundPatch): void {
    const old = this.#bounds ?? { column, row, columns, rows };
    const west = Math.min(old.column, column);
    const south = Math.min(old.row, row);
    this.#bounds = {
      column: west,
      row: south,
      columns: Math.max(old.column + old.columns, column + columns) - west,
      rows: Math.max(old.row + old.rows, row + rows) - south,
    };
  }

  async #send(): Promise<void> {
    const points_cm = this.#waiting;
    if (points_cm.length === 0) return;
    this.#waiting = [];
    await this.#apply({ ...this.#brush, points_cm });
    for (const value of points_cm) this.#done.push(value);
  }
}

function cut(heights_m: Float32Array, width: number, bounds: Omit<GroundPatch, 'heights_m'>): GroundPatch {
  const { column, row, columns, rows } = bounds;
  const part = new Float32Array(columns * rows);
  for (let line = 0; line < rows; line += 1) {
    const begin = (row + line) * width + column;
    part.set(heights_m.subarray(begin, begin + columns), line * columns);
  }
  return { column, row, columns, rows, heights_m: part };
}
