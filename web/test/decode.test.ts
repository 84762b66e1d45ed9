import assert from 'node:assert/strict';
import { test } from 'node:test';
import { decodeSegments, decodeSubgoals, kindOf, named, STATUS } from '../src/bindings/decode.ts';

test('segments get their names and their verdict', () => {
  const [one, two] = decodeSegments(new Float64Array([3, 3.4, -0.1, 0.2, 2.8, 0, 1, 1.1, NaN, NaN, 0.7, 3]));
  assert.deepEqual(one, {
    begin_rad: 3,
    end_rad: 3.4,
    elevation_rad: -0.1,
    height_m: 0.2,
    width_m: 2.8,
    verdict: 'valid',
  });
  assert.equal(two?.verdict, 'unknown');
  assert.ok(Number.isNaN(two?.height_m));
});

test('subgoals carry their segment, forecast and terms, and the goal itself none of them', () => {
  const candidate = [0.5, -0.1, 1, 2, 3, 1, 0, 4, 6.5, 0.2, 0.1, 0.15, 2, 0.1, 0.2, 0.3, 0, 0];
  const refused = [0.6, -0.1, 1, 2, 3, 0, 1, 0, 0.5, 0.9, 0.5, 0.1, 1, ...Array(5).fill(Number.NaN)];
  const goal = [0.7, -0.1, 1, 2, 3, 0, 0, -1, ...Array(10).fill(Number.NaN)];
  const [first, second, third] = decodeSubgoals(new Float64Array([...candidate, ...refused, ...goal]));
  assert.equal(first?.chosen, true);
  assert.equal(first?.segment, 4);
  assert.deepEqual(first?.forecast, {
    reach_m: 6.5,
    mean_risk: 0.2,
    max_roll_rad: 0.1,
    max_pitch_rad: 0.15,
    end: 'unseen',
  });
  assert.deepEqual(first?.terms, [0.1, 0.2, 0.3, 0, 0]);
  assert.ok(Math.abs((first?.total ?? 0) - 0.6) < 1e-12);
  assert.equal(second?.refusal, 'tilt');
  assert.equal(second?.forecast?.end, 'tilt');
  assert.equal(second?.terms, undefined);
  assert.equal(third?.segment, undefined);
  assert.equal(third?.forecast, undefined);
});

test('what does not fit the protocol is refused, not guessed', () => {
  assert.throws(() => decodeSegments(new Float64Array(7)), /groups of 6/);
  assert.throws(() => decodeSegments(new Float64Array([0, 0, 0, 0, 0, 9])), /unknown code 9/);
  assert.throws(() => named(STATUS, new Float64Array(2)), /expects 20/);
  assert.throws(() => kindOf(undefined), /ground, unknown, wall/);
});
