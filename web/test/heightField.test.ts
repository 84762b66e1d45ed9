import assert from 'node:assert/strict';
import { test } from 'node:test';
import { HeightField } from '../src/ground/heightField.ts';

/** A field of 41 × 31 samples, 0.5 m apart, with the given height at each place. */
function field(height: (x: number, y: number) => number): HeightField {
  const [columns, rows, cell_m] = [41, 31, 0.5];
  const heights_m = Float32Array.from({ length: columns * rows }, (_, index) =>
    height((index % columns) * cell_m, Math.floor(index / columns) * cell_m),
  );
  return new HeightField({ columns, rows, cell_m, heights_m });
}

const hilly = field((x, y) => 2 * Math.sin(0.6 * x) * Math.cos(0.5 * y));

test('heights are those of the samples, and bilinear between them', () => {
  const plane = field((x, y) => 1 + 0.5 * x - 0.25 * y);
  assert.ok(Math.abs(plane.height(3.3, 7.7) - (1 + 1.65 - 1.925)) < 1e-5);
  assert.equal(plane.height(-5, 0), plane.height(0, 0));
});

test('the ray under the pointer meets the ground, nearest first', () => {
  for (const [x, y] of [
    [3, 4],
    [12.2, 9.9],
    [19.5, 0.3],
  ] as const) {
    const target = { x, y, z: hilly.height(x, y) };
    const origin = { x: x - 6, y: y - 5, z: target.z + 30 };
    const direction = { x: 6, y: 5, z: -30 };
    const hit = hilly.intersect(origin, direction);
    assert.ok(hit, 'the ray hits');
    assert.ok(Math.abs(hit.z - hilly.height(hit.x, hit.y)) < 1e-3);
    // Steep enough to meet nothing before its target.
    assert.ok(Math.hypot(hit.x - x, hit.y - y) < 1e-2);
  }
});

test('a ray past the ground, or from below it, meets nothing', () => {
  assert.equal(hilly.intersect({ x: -5, y: -5, z: 10 }, { x: -1, y: 0, z: -0.1 }), undefined);
  assert.equal(hilly.intersect({ x: 5, y: 5, z: 10 }, { x: 0, y: 0, z: 1 }), undefined);
  assert.equal(hilly.intersect({ x: 10, y: 5, z: -9 }, { x: 0, y: 0, z: -1 }), undefined);
  assert.ok(hilly.intersect({ x: 5, y: 5, z: 10 }, { x: 0, y: 0, z: -1 }));
});

test('a patch changes its rectangle and the range of heights', () => {
  const level = field(() => 0);
  level.patch({ column: 2, row: 3, columns: 2, rows: 1, heights_m: new Float32Array([5, 6]) });
  assert.equal(level.height(1, 1.5), 5);
  assert.equal(level.height(1.5, 1.5), 6);
  assert.equal(level.height(1, 2), 0);
  assert.deepEqual([level.min_m, level.max_m], [0, 6]);
});

test('a patch keeps the lowest and the highest point up to date', () => {
  const ground = field((x, y) => x + 0.04 * y);
  const put = (column: number, row: number, ...heights: number[]) =>
    ground.patch({ column, row, columns: heights.length, rows: 1, heights_m: Float32Array.from(heights) });
  const range = () => [ground.min_m, ground.max_m].map((height) => Math.round(100 * height) / 100);
  assert.deepEqual(range(), [0, 20.6]);
  put(5, 5, 30, -2);
  assert.deepEqual(range(), [-2, 30]);
  put(5, 5, 1, -1);
  assert.deepEqual(range(), [-1, 20.6]);
  put(40, 30, 1);
  put(6, 5, 1);
  assert.deepEqual(range(), [0, 20.58]);
});
