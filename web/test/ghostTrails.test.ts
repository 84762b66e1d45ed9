import assert from 'node:assert/strict';
import { test } from 'node:test';
import { GhostTrails } from '../src/lab/ghostTrails.ts';
import { GhostRun } from '../src/trials/ghostRun.ts';
import { ROW, type TrialResult } from '../src/trials/trialsProtocol.ts';

/** A run that is at x = tick after each of so many ticks. */
function driven(ticks: number): GhostRun {
  const rows = new Float64Array(ROW.length * ticks);
  for (let tick = 0; tick < ticks; tick += 1) rows[ROW.length * tick + ROW.indexOf('x')] = tick;
  return new GhostRun(rows, {} as TrialResult);
}

const xs = (path: Float32Array) => Array.from(path).filter((_, index) => index % 3 === 0);

test('a ghost’s trail goes on from step to step, and begins anew after a jump back', () => {
  const trails = new GhostTrails();
  trails.set([driven(6)]);
  const step = (tick: number) => {
    const [only] = trails.steps([tick]);
    return only && { at: only.pose?.x, path: xs(only.path), anew: only.anew };
  };
  assert.deepEqual(step(2), { at: 2, path: [0, 1, 2], anew: false });
  assert.deepEqual(step(2), { at: 2, path: [], anew: false });
  assert.deepEqual(step(4), { at: 4, path: [3, 4], anew: false });
  assert.deepEqual(step(1), { at: 1, path: [0, 1], anew: true });
  assert.deepEqual(step(2), { at: 2, path: [2], anew: false });
});

test('what takes the place of other ghosts begins at its start', () => {
  const trails = new GhostTrails();
  trails.set([driven(4)]);
  trails.steps([3]);
  trails.set([driven(4), driven(4)]);
  assert.deepEqual(
    trails.steps([1, 0]).map(({ path, anew }) => [xs(path), anew]),
    [
      [[0, 1], false],
      [[0], false],
    ],
  );
});
