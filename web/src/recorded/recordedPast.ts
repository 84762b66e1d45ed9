/** What is known of a recording as far as it was decided again: times of scans and differences, and the trajectory. */

import type { Change, Decided, News } from './recordedProtocol.ts';

export class RecordedPast {
  readonly #scans_s: number[] = [];
  readonly #differences_s: number[] = [];
  readonly changes: Change[] = [];
  readonly #trail_s: number[] = [];
  #trail_m = new Float32Array(3 * 1024);
  decided: Decided | undefined;

  add({ decided, scans_s, differences_s, changes, trail_s, trail_m }: News): void {
    this.decided = decided;
    this.#scans_s.push(...scans_s);
    this.#differences_s.push(...differences_s);
    this.changes.push(...changes);
    const places = 3 * this.#trail_s.length;
    this.#trail_s.push(...trail_s);
    if (places + trail_m.length > this.#trail_m.length) {
      const larger = new Float32Array(2 * (places + trail_m.length));
      larger.set(this.#trail_m.subarray(0, places));
      this.#trail_m = larger;
    }
    this.#trail_m.set(trail_m, places);
  }

  /** The nearest scan before or after a time. */
  scanBeside(time_s: number, way: 1 | -1): number | undefined {
    return beside(this.#scans_s, time_s, way);
  }

  /** The nearest difference before or after a time. */
  differenceBeside(time_s: number, way: 1 | -1): number | undefined {
    return beside(this.#differences_s, time_s, way);
  }

  /** The times of differences. */
  get differences_s(): readonly number[] {
    return this.#differences_s;
  }

  /** How many places the trajectory has. */
  get places(): number {
    return this.#trail_s.length;
  }

  /** How many places of the trajectory come until a time. */
  placesUntil(time_s: number): number {
    return rank(this.#trail_s, time_s);
  }

  /** x, y, z of the places from one up to another. */
  trail(from: number, to: number): Float32Array<ArrayBuffer> {
    return this.#trail_m.slice(3 * from, 3 * to);
  }
}

/** Times that differ by less are the same. */
const SAME_S = 1e-6;

function beside(times_s: readonly number[], time_s: number, way: 1 | -1): number | undefined {
  return way > 0 ? times_s[rank(times_s, time_s)] : times_s[rank(times_s, time_s - 2 * SAME_S) - 1];
}

/** How many of the ascending times are no later than this one. */
function rank(times_s: readonly number[], time_s: number): number {
  let [low, high] = [0, times_s.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times_s[middle] ?? 0) <= time_s + SAME_S) low = middle + 1;
    else high = middle;
  }
  return low;
}
