import assert from 'node:assert/strict';
import { test } from 'node:test';
import { rowsOf } from '../src/files/csv.ts';
import { campaignFile, trialsCsv } from '../src/trials/batchFiles.ts';
import { campaignRows } from '../src/trials/campaignRows.ts';
import { overridesWith, valuesIn } from '../src/trials/sweep.ts';

test('values are read as people write them, each once, or refused with the word that is none', () => {
  assert.deepEqual(valuesIn(' 0.5, 0.7;1e-3 0.5', false, 20), [0.5, 0.7, 0.001]);
  assert.throws(() => valuesIn('1, two', false, 20), /“two”: expected numbers with commas between/);
  assert.throws(() => valuesIn('1.5', true, 20), /“1.5”: expected whole numbers/);
  assert.throws(() => valuesIn(' ', false, 20), /expected numbers/);
  assert.throws(() => valuesIn('1 2 3', false, 2), /Values: 3: expected at most 2/);
});

test('a value is laid over what is set already', () => {
  const overrides = { planner: { perception: { variance_threshold: 0.2 } }, sensor: { columns: 900 } };
  assert.deepEqual(overridesWith({ overrides }, 'planner.perception.variance_threshold', 0.7), {
    planner: { perception: { variance_threshold: 0.7 } },
    sensor: { columns: 900 },
  });
});

test('a campaign says planner, route, seeds and values, numbers with their point', () => {
  const sweep = {
    planner: 'paper',
    route: 'ht',
    path: 'planner.goal_tolerance_m',
    whole: false,
    values: [1, 0.5],
    seeds: [1, 2],
  };
  const text = campaignFile(sweep, sweep);
  for (const line of ['planners = ["paper"]', 'routes = ["ht.toml"]', 'seeds = [1, 2]', 'values = [1.0, 0.5]']) {
    assert.ok(text.split('\n').includes(line), text);
  }
});

test('a table says with which parameters each trial was driven, as the page reads it back', () => {
  const metrics = {
    distance_m: 1,
    max_abs_roll_rad: 0,
    max_abs_pitch_rad: 0,
    mean_vibration_rad_s: 0,
    mean_elevation_rate_cm_s: 0,
    curvature_change_rad_m: 0,
  };
  const result = { planner: 'paper', seed: 3, outcome: 'reached', tick: 9, time_s: 0.9, metrics, digest: 'd' } as const;
  const overrides = {
    sensor: { columns: 900 },
    planner: { decision: { cost_model: 'paper' }, perception: { kernel: { length_scales_rad: [0.12, 0.05] } } },
  };
  const csv = trialsCsv('ht', [{ planner: 'paper', overrides, result }]);
  const [row] = campaignRows(rowsOf(csv), () => true);
  assert.deepEqual(row?.replay, { scenario: 'ht', preset: 'paper', overrides, seed: 3 });
  assert.equal(row?.digest, 'd');
  const underWay = { ...result, outcome: 'running' } as const;
  const [half] = rowsOf(trialsCsv('ht', [{ planner: 'paper', overrides, result: underWay }]));
  assert.deepEqual([half?.outcome, half?.digest], ['running', '']);
});
