/** The page's copy of the height field: lookups and the ray under the pointer. */

import type { Ground, GroundPatch } from '../protocol/simulationProtocol.ts';

/** A ground whose south-western corner may lie anywhere. */
export interface PlacedGround extends Ground {
  /** That corner; the world's origin without it. */
  readonly origin?: readonly [number, number] | undefined;
}

export interface Vector {
  x: number;
  y: number;
  z: number;
}

export class HeightField {
  readonly columns: number;
  readonly rows: number;
  readonly cell_m: number;
  readonly heights_m: Float32Array<ArrayBuffer>;
  readonly width_m: number;
  readonly depth_m: number;
  /** The south-western corner. */
  readonly west_m: number;
  readonly south_m: number;
  min_m = 0;
  max_m = 0;

  constructor(ground: PlacedGround) {
    [this.west_m, this.south_m] = ground.origin ?? [0, 0];
    this.columns = ground.columns;
    this.rows = ground.rows;
    this.cell_m = ground.cell_m;
    this.heights_m = ground.heights_m;
    this.width_m = (ground.columns - 1) * ground.cell_m;
    this.depth_m = (ground.rows - 1) * ground.cell_m;
    this.#measure();
  }

  patch(patch: GroundPatch): void {
    let extreme = false;
    let [min, max] = [this.min_m, this.max_m];
    for (let row = 0; row < patch.rows; row += 1) {
      const begin = (patch.row + row) * this.columns + patch.column;
      for (let column = 0; column < patch.columns; column += 1) {
        const old = this.heights_m[begin + column] ?? 0;
        const height = patch.heights_m[row * patch.columns + column] ?? 0;
        if (old === this.min_m || old === this.max_m) extreme = true;
        if (height < min) min = height;
        if (height > max) max = height;
        this.heights_m[begin + column] = height;
      }
    }
    // Only where the lowest or highest point went does the whole ground have to be searched for another.
    if (extreme) this.#measure();
    else [this.min_m, this.max_m] = [min, max];
  }

  /** As it is now, to be handed to a worker. */
  get ground(): PlacedGround {
    const { columns, rows, cell_m, heights_m, west_m, south_m } = this;
    return { columns, rows, cell_m, heights_m, origin: [west_m, south_m] };
  }

  contains(x: number, y: number): boolean {
    const [east_m, north_m] = [x - this.west_m, y - this.south_m];
    return east_m >= 0 && north_m >= 0 && east_m <= this.width_m && north_m <= this.depth_m;
  }

  /** The ground as it is now, whatever becomes of this. */
  copy(): HeightField {
    return new HeightField({ ...this.ground, heights_m: this.heights_m.slice() });
  }

  /** Bilinear height; the nearest edge's outside the field. */
  height(x: number, y: number): number {
    const u = Math.min(Math.max((x - this.west_m) / this.cell_m, 0), this.columns - 1);
    const v = Math.min(Math.max((y - this.south_m) / this.cell_m, 0), this.rows - 1);
    const column = Math.min(Math.floor(u), this.columns - 2);
    const row = Math.min(Math.floor(v), this.rows - 2);
    const at = row * this.columns + column;
    const h = (offset: number) => this.heights_m[at + offset] ?? 0;
    const [s, t] = [u - column, v - row];
    const south = h(0) * (1 - s) + h(1) * s;
    const north = h(this.columns) * (1 - s) + h(this.columns + 1) * s;
    return south * (1 - t) + north * t;
  }

  /** Where a ray from above first meets the ground, or nothing. */
  intersect(origin: Vector, direction: Vector): Vector | undefined {
    const [enter, leave] = this.#span(origin, direction);
    if (!(leave > enter)) return undefined;
    const at = (t: number): Vector => ({
      x: origin.x + direction.x * t,
      y: origin.y + direction.y * t,
      z: origin.z + direction.z * t,
    });
    const above = (t: number) => {
      const point = at(t);
      return point.z - this.height(point.x, point.y);
    };
    const flat = Math.hypot(direction.x, direction.y);
    const step = flat > 1e-6 ? (0.7 * this.cell_m) / flat : leave - enter;
    let before = enter;
    if (above(before) < 0) return undefined;
    for (let t = enter; t < leave + step; t += step) {
      const here = Math.min(t, leave);
      if (above(here) > 0) {
        before = here;
        continue;
      }
      let [low, high] = [before, here];
      for (let round = 0; round < 24; round += 1) {
        const middle = (low + high) / 2;
        if (above(middle) > 0) low = middle;
        else high = middle;
      }
      return at(high);
    }
    return undefined;
  }

  /** The part of the ray inside the box around the ground. */
  #span(origin: Vector, direction: Vector): [number, number] {
    let [enter, leave] = [0, Number.POSITIVE_INFINITY];
    const slabs: [number, number, number, number][] = [
      [origin.x - this.west_m, direction.x, 0, this.width_m],
      [origin.y - this.south_m, direction.y, 0, this.depth_m],
      [origin.z, direction.z, this.min_m - 0.01, this.max_m + 0.01],
    ];
    for (const [from, along, low, high] of slabs) {
      if (along === 0) {
        if (from < low || from > high) return [0, -1];
        continue;
      }
      const [a, b] = [(low - from) / along, (high - from) / along];
      enter = Math.max(enter, Math.min(a, b));
      leave = Math.min(leave, Math.max(a, b));
    }
    return [enter, leave];
  }

  #measure(): void {
    let [min, max] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
    // An index is faster than an iterator where this runs for the first time.
    for (let index = 0; index < this.heights_m.length; index += 1) {
      const height = this.heights_m[index] ?? 0;
      if (height < min) min = height;
      if (height > max) max = height;
    }
    this.min_m = min;
    this.max_m = max;
  }
}
