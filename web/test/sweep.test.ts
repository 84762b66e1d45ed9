import assert from 'node:assert/strict';
import { test } from 'node:test';
import { overridesWith, valuesIn } from '../src/trials/sweep.ts';
import { campaignFile } from '../src/trials/sweepFiles.ts';

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
  const text = campaignFile(sweep);
  for (const line of ['planners = ["paper"]', 'routes = ["ht.toml"]', 'seeds = [1, 2]', 'values = [1.0, 0.5]']) {
    assert.ok(text.split('\n').includes(line), text);
  }
});
