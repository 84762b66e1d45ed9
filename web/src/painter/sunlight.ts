/** How bright each sample of the ground is: cast shadow times the openness of its surroundings. Computed once per relief. */

import type { HeightField } from '../ground/heightField.ts';
import type { Solid } from '../protocol/simulationProtocol.ts';

/** Towards the sun: north-west, as on every shaded map. */
export const SUN = normalise(-0.62, 0.62, 0.62);
const PENUMBRA_M = 0.35;

function normalise(x: number, y: number, z: number): readonly [number, number, number] {
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

/** One byte per sample: 255 is full light. The solids cast their shadows, too. */
export function sunlight(field: HeightField, solids: readonly Solid[], out: Uint8Array): void {
  const { columns, rows, cell_m, heights_m } = field;
  const shadow_m = castShadow(field, solids);
  const near_m = blur(heights_m, columns, rows, Math.max(1, Math.round(0.8 / cell_m)));
  const wide_m = blur(heights_m, columns, rows, Math.max(2, Math.round(3 / cell_m)));
  for (let index = 0; index < heights_m.length; index += 1) {
    const height = heights_m[index] ?? 0;
    const depth = ((shadow_m[index] ?? height) - height) / PENUMBRA_M;
    const lit = 1 - 0.62 * smooth(Math.min(Math.max(depth, 0), 1));
    const hollow = 1.1 * ((near_m[index] ?? height) - height) + 0.32 * ((wide_m[index] ?? height) - height);
    const open = Math.min(Math.max(1 - hollow, 0.45), 1.12) / 1.12;
    out[index] = 255 * lit * open;
  }
}

function smooth(t: number): number {
  return t * t * (3 - 2 * t);
}

/** Height of the shadow's ceiling above each sample, swept once from the sun's side. */
function castShadow({ columns, rows, cell_m, heights_m }: HeightField, solids: readonly Solid[]): Float32Array {
  const ceiling = Float32Array.from(heights_m);
  for (const solid of solids) raise(ceiling, columns, rows, cell_m, solid);
  const [x, y, z] = SUN;
  // The sun stands exactly north-west: one sample diagonally up-sun is one step.
  const drop_m = (cell_m * Math.SQRT2 * z) / Math.hypot(x, y);
  for (let row = rows - 2; row >= 0; row -= 1) {
    for (let column = 1; column < columns; column += 1) {
      const index = row * columns + column;
      const above = (ceiling[index + columns - 1] ?? 0) - drop_m;
      if (above > (ceiling[index] ?? 0)) ceiling[index] = above;
    }
  }
  return ceiling;
}

/** Raises the ceiling to the top of a solid where that stands, however thin: no ray of light slips between samples. */
function raise(ceiling: Float32Array, columns: number, rows: number, cell_m: number, solid: Solid): void {
  const {
    shape,
    centre_m: [x, y, z],
    size_m: [length, width, height],
    sin_cos_yaw: [sin, cos],
  } = solid;
  const [ahead_m, left_m] = [length, width].map((size) => Math.max(size, Math.SQRT2 * cell_m) / 2) as [number, number];
  const reach_m = Math.hypot(ahead_m, left_m);
  const within = (low_m: number, high_m: number, count: number): [number, number] => [
    Math.max(Math.ceil(low_m / cell_m), 0),
    Math.min(Math.floor(high_m / cell_m), count - 1),
  ];
  const [west, east] = within(x - reach_m, x + reach_m, columns);
  const [south, north] = within(y - reach_m, y + reach_m, rows);
  for (let row = south; row <= north; row += 1) {
    for (let column = west; column <= east; column += 1) {
      const [dx, dy] = [column * cell_m - x, row * cell_m - y];
      const [along, across] = [(dx * cos + dy * sin) / ahead_m, (dy * cos - dx * sin) / left_m];
      const off = shape === 'box' ? Math.max(Math.abs(along), Math.abs(across)) : Math.hypot(along, across);
      if (off > 1) continue;
      const half_m = shape === 'ball' ? (height / 2) * Math.sqrt(1 - off * off) : height / 2;
      const index = row * columns + column;
      ceiling[index] = Math.max(ceiling[index] ?? 0, z + half_m);
    }
  }
}

/** Mean over a square of `2 radius + 1` samples, clipped at the edges. */
function blur(values: Float32Array, columns: number, rows: number, radius: number): Float32Array {
  const across = new Float32Array(values.length);
  const result = new Float32Array(values.length);
  for (let row = 0; row < rows; row += 1) slide(values, across, row * columns, 1, columns, radius);
  for (let column = 0; column < columns; column += 1) slide(across, result, column, columns, rows, radius);
  return result;
}

function slide(
  from: Float32Array,
  to: Float32Array,
  start: number,
  stride: number,
  count: number,
  radius: number,
): void {
  let [sum, size] = [0, 0];
  for (let index = -radius; index < count; index += 1) {
    const enter = index + radius;
    const leave = index - radius - 1;
    if (enter < count) {
      sum += from[start + enter * stride] ?? 0;
      size += 1;
    }
    if (leave >= 0) {
      sum -= from[start + leave * stride] ?? 0;
      size -= 1;
    }
    if (index >= 0) to[start + index * stride] = sum / size;
  }
}
