import assert from 'node:assert/strict';
import { test } from 'node:test';
import { counterpart } from '../src/lab/inStep.ts';
import type { Metrics } from '../src/protocol/simulationProtocol.ts';
import { ROW, RunRecord } from '../src/run/record.ts';

/** A run that has driven a metre at each tick. */
function driven(ticks: number): RunRecord {
  const record = new RunRecord();
  for (let tick = 0; tick < ticks; tick += 1) {
    const row = new Float64Array(ROW.length);
    row[ROW.indexOf('tick')] = tick;
    row[ROW.indexOf('distance_m')] = tick;
    record.add(row);
  }
  return record;
}

test('a ghost is compared at the last tick that both have, and what has ended as it ended', () => {
  const frame = { tick: 50, metrics: { distance_m: 50 } as Metrics };
  const own = (outcome: 'running' | 'reached', tick: number) =>
    counterpart({ outcome, tick }, frame, driven(50))?.distance_m;
  assert.equal(own('running', 12), 12);
  assert.equal(own('running', 50), 50);
  assert.equal(own('running', 80), 50);
  assert.equal(own('reached', 12), 50);
});
