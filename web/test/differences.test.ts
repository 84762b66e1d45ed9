import assert from 'node:assert/strict';
import { test } from 'node:test';
import { differences } from '../src/experiment/differences.ts';
import type { Overrides } from '../src/experiment/overrides.ts';
import type { ParameterGroup } from '../src/experiment/parameters.ts';
import type { Learning, Preset } from '../src/experiment/setting.ts';

const parameter = (name: string, unit: string, value: number | string | boolean, field?: number) => ({
  ...({ name, unit, text: '', kind: 'number', range: undefined, choices: undefined, paper: undefined } as const),
  value,
  presets: field === undefined ? [] : [{ preset: 'field', value: field }],
});
const groups: readonly ParameterGroup[] = [
  { table: 'robot', title: 'Robot', parameters: [parameter('max_speed_m_s', 'm/s', 1)] },
  {
    table: 'sensor',
    title: 'Sensor',
    parameters: [parameter('range_noise_m', 'm', 0.02), parameter('wet', '', false)],
  },
  { table: 'reality', title: 'Reality', parameters: [parameter('preset', '', 'ideal')] },
  { table: 'reality.pose', title: 'Pose', parameters: [parameter('drift_m', 'm', 0, 0.3)] },
];
const setup = (overrides: Overrides, preset: Preset = 'default', learning: Learning = 'fixed') => ({
  preset,
  learning,
  overrides,
});
const words = (kept: ReturnType<typeof setup>, view: ReturnType<typeof setup>) => differences(kept, view, groups);

test('only values that differ are said, each with that in view', () => {
  const fast = setup({ robot: { max_speed_m_s: 2 }, sensor: { wet: true } });
  assert.deepEqual(words(fast, fast), []);
  assert.deepEqual(words(fast, setup({ sensor: { wet: true } })), ['max speed 2 m/s (1 m/s)']);
  assert.deepEqual(words(setup({}), fast), ['max speed 1 m/s (2 m/s)', 'wet off (on)']);
  // A value that is set to what holds anyway is no difference.
  assert.deepEqual(words(setup({ robot: { max_speed_m_s: 1 } }), setup({})), []);
});

test('planner and learning are said; what another planner has by itself is not known', () => {
  const paper = setup({}, 'paper', 'every_scan');
  assert.deepEqual(words(paper, setup({ robot: { max_speed_m_s: 2 } })), [
    'planner paper (default)',
    'learning every scan (fixed)',
    'max speed as its planner has it (2 m/s)',
  ]);
});

test('effects of reality are those of its preset where they are not set', () => {
  const drifting = setup({ reality: { preset: 'field', pose: { drift_m: 0.1 } } });
  assert.deepEqual(words(drifting, setup({ reality: { preset: 'field' } })), ['drift 0.1 m (0.3 m)']);
  assert.deepEqual(words(setup({ reality: { preset: 'field' } }), setup({})), ['reality field (ideal)']);
});
