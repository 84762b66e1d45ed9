import assert from 'node:assert/strict';
import { test } from 'node:test';
import { clock, degrees, fixed, grouped, radians, wholeDegrees, wrap } from '../src/base/format.ts';

test('numbers have a real minus, no negative zero, and a dash for what is unknown', () => {
  assert.equal(fixed(-1.26, 1), '\u22121.3');
  assert.equal(fixed(-0.001, 2), '0.00');
  assert.equal(fixed(Number.NaN, 2), '–');
  assert.equal(degrees(-Math.PI / 6), '\u221230°');
});

test('the clock carries over', () => {
  assert.equal(clock(0), '0:00.0');
  assert.equal(clock(59.96), '1:00.0');
  assert.equal(clock(67.34), '1:07.3');
});

test('angles wrap to the half-open turn', () => {
  for (const turns of [-2, 0, 3]) {
    for (const angle of [-Math.PI, -1, 0, 2.5]) {
      assert.ok(Math.abs(wrap(angle + 2 * Math.PI * turns) - angle) < 1e-12);
    }
  }
  assert.equal(wrap(Math.PI), -Math.PI);
});

test('a field shows an angle in whole degrees of one turn', () => {
  assert.deepEqual([0, 90, 359.6, -90, -0.2, 720].map(radians).map(wholeDegrees), [0, 90, 0, 270, 0, 0]);
});

test('large counts have commas', () => {
  assert.deepEqual([0, 999, 1000, 28_800, 1_234_567].map(grouped), ['0', '999', '1,000', '28,800', '1,234,567']);
});
