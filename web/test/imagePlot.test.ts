import assert from 'node:assert/strict';
import { test } from 'node:test';
import { layout } from '../src/inspector/imagePlot.ts';

test('a mark beyond the image stays at its edge and says on which side it lies', () => {
  const plot = layout(600, 200);
  const bottom = plot.top + plot.height;
  assert.deepEqual(plot.mark(0.1, 6), { y: plot.y(0.1), beyond: 0 });
  const lowest_rad = (-15 * Math.PI) / 180;
  assert.deepEqual(plot.mark(lowest_rad, 6), { y: bottom - 6, beyond: 0 });
  assert.deepEqual(plot.mark(0.4, 6), { y: plot.top + 6, beyond: 1 });
  assert.deepEqual(plot.mark(-0.4, 6), { y: bottom - 6, beyond: -1 });
});
