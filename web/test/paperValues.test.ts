import assert from 'node:assert/strict';
import { test } from 'node:test';
import { departures } from '../src/experiment/paperValues.ts';
import type { ParameterGroup } from '../src/experiment/parameters.ts';

const parameter = (name: string, value: number | string | boolean, paper: number | string | boolean | undefined) => ({
  ...({ name, unit: '', text: '', kind: 'number', range: undefined, choices: undefined, presets: [] } as const),
  value,
  paper,
});
const groups: readonly ParameterGroup[] = [
  {
    table: 'planner.perception.learning',
    title: 'Learning',
    parameters: [parameter('mode', 'fixed', 'every_scan'), parameter('isotropic', false, true)],
  },
  {
    table: 'sensor',
    title: 'Sensor',
    parameters: [parameter('columns', 1800, undefined), parameter('period_s', 0.1, 0.1)],
  },
];
const names = (overrides: object, learning: 'fixed' | 'every_scan') =>
  departures(groups, { overrides: { ...overrides }, learning }).map((one) => one.parameter.name);

test('what holds is compared with the paper where the paper says something', () => {
  assert.deepEqual(names({}, 'fixed'), ['mode', 'isotropic']);
  assert.deepEqual(names({ sensor: { period_s: 0.2, columns: 90 } }, 'every_scan'), ['isotropic', 'period_s']);
});
