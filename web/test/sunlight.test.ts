import assert from 'node:assert/strict';
import { test } from 'node:test';
import { HeightField } from '../src/ground/heightField.ts';
import { sunlight } from '../src/painter/sunlight.ts';

test('a wall shades the ground to its south-east and no other', () => {
  const [columns, rows, cell_m] = [60, 60, 0.5];
  const heights_m = new Float32Array(columns * rows);
  for (let row = 28; row < 32; row += 1)
    for (let column = 28; column < 32; column += 1) heights_m[row * columns + column] = 4;
  const bright = new Uint8Array(columns * rows);
  sunlight(new HeightField({ columns, rows, cell_m, heights_m }), [], bright);
  const at = (column: number, row: number) => bright[row * columns + column] ?? 0;
  assert.ok(at(36, 24) < 0.6 * at(24, 36), 'south-east is darker than north-west');
  assert.equal(at(5, 5), at(55, 55));
});

test('a post shades the ground to its south-east as far as its height says, however thin it is', () => {
  const [columns, rows, cell_m] = [60, 60, 0.5];
  const field = new HeightField({ columns, rows, cell_m, heights_m: new Float32Array(columns * rows) });
  const light = (height_m: number) => {
    const out = new Uint8Array(columns * rows);
    const centre_m: [number, number, number] = [15, 15, height_m / 2];
    const size_m: [number, number, number] = [0.1, 0.1, height_m];
    sunlight(field, [{ object: 0, shape: 'cylinder', centre_m, size_m, sin_cos_yaw: [0, 1] }], out);
    return (step: number) => out[(30 - step) * columns + 30 + step] ?? 0;
  };
  const [low, high] = [light(1), light(3)];
  assert.ok(low(1) < 0.6 * low(-1), 'behind the low post');
  assert.equal(low(4), low(-1), 'beyond its shadow');
  assert.ok(high(4) < 0.6 * high(-1), 'in that of the high one');
});
