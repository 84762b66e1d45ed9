import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Trail } from '../src/simulation/trail.ts';

test('a trail grows, is walked again and is cut', () => {
  const trail = new Trail();
  trail.begin(5, 5, 0, 0);
  for (let tick = 6; tick <= 3000; tick += 1) trail.put(tick, tick, 1, 2);
  assert.deepEqual([...trail.part(2999, 3000)], [2999, 1, 2, 3000, 1, 2]);
  assert.equal(trail.part(0, 7).length, 9);
  assert.equal(trail.part(8, 7).length, 0);
  assert.deepEqual([...trail.after(3000)], [3000, 1, 2]);
  trail.put(10, 99, 99, 99);
  assert.equal(trail.after(5).length, 3 * 2996);
  trail.cut(10);
  assert.deepEqual([...trail.after(10)], [99, 99, 99]);
  trail.put(11, 1, 1, 1);
  assert.throws(() => trail.put(13, 0, 0, 0), /does not follow/);
});
