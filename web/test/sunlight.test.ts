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
  sunlight(new HeightField({ columns, rows, cell_m, heights_m }), bright);
  const at = (column: number, row: number) => bright[row * columns + column] ?? 0;
  assert.ok(at(36, 24) < 0.6 * at(24, 36), 'south-east is darker than north-west');
  assert.equal(at(5, 5), at(55, 55));
});
