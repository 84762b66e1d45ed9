import assert from 'node:assert/strict';
import { test } from 'node:test';
import { errorWords, skylineError } from '../src/method/skylineError.ts';

test('the error is the mean over the columns that have both, in degrees and at the edge of the occupancy', () => {
  const [profile, truth] = [Float32Array.of(0.02, Number.NaN, 0.01), Float32Array.of(0, 0, Number.NaN)];
  const error = skylineError(profile, truth);
  assert.ok(error && Math.abs(error.mean_rad - 0.02) < 1e-6);
  assert.equal(error.columns, 1);
  assert.equal(errorWords(error, 7), '1.15° (14 cm at 7 m)');
  assert.equal(errorWords(error, 4.5), '1.15° (9 cm at 4.5 m)');
  assert.equal(skylineError(profile, Float32Array.of(Number.NaN, 0, Number.NaN)), undefined);
});
