import assert from 'node:assert/strict';
import { test } from 'node:test';
import { RecordedPast } from '../src/recorded/recordedPast.ts';
import type { Decided } from '../src/recorded/recordedProtocol.ts';

const DECIDED: Decided = {
  until_s: 1,
  end_s: 1,
  has_ended: true,
  fault: undefined,
  is_cut: false,
  answers: 0,
  different_answers: 0,
  different_ticks: 0,
  lost: 0,
  goals: 0,
  complaints: [],
};

/** Scans and places at these times, each place at x = its time. */
function past(...parts: number[][]): RecordedPast {
  const all = new RecordedPast();
  for (const times of parts) {
    all.add({
      decided: DECIDED,
      scans_s: Float64Array.from(times),
      differences_s: Float64Array.from(times.slice(1)),
      changes: [],
      trail_s: Float64Array.from(times),
      trail_m: Float32Array.from(times.flatMap((time) => [time, 0, 0])),
    });
  }
  return all;
}

test('the scan before or after a time is found, and the one at it is neither', () => {
  const known = past([0.125, 0.25], [0.5]);
  assert.equal(known.scanBeside(0, 1), 0.125);
  assert.equal(known.scanBeside(0.125, 1), 0.25);
  assert.equal(known.scanBeside(0.3, 1), 0.5);
  assert.equal(known.scanBeside(0.5, 1), undefined);
  assert.equal(known.scanBeside(0.5, -1), 0.25);
  assert.equal(known.scanBeside(0.3, -1), 0.25);
  assert.equal(known.scanBeside(0.125, -1), undefined);
  assert.equal(known.differenceBeside(0, 1), 0.25);
});

test('the trajectory grows with the news and is cut at any time', () => {
  const times = Array.from({ length: 3000 }, (_, index) => index / 8);
  const known = past(times.slice(0, 700), times.slice(700));
  assert.equal(known.places, 3000);
  assert.equal(known.placesUntil(1), 9);
  assert.equal(known.placesUntil(-1), 0);
  assert.deepEqual([...known.trail(699, 701)], [699 / 8, 0, 0, 700 / 8, 0, 0]);
});
