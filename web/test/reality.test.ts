import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { ParameterGroup } from '../src/experiment/parameters.ts';
import { inIdealWorld, isEffects, isOn, realityPresets, withReality } from '../src/experiment/reality.ts';

const BEFORE = { sensor: { rings: 32 }, reality: { preset: 'field', motion: { friction: 0.4 } } };

test('a preset takes the place of every effect and leaves the rest', () => {
  assert.deepEqual(withReality(BEFORE, 'harsh'), { sensor: { rings: 32 }, reality: { preset: 'harsh' } });
  assert.deepEqual(withReality({}, 'field'), { reality: { preset: 'field' } });
  // The ideal world is what holds without a word.
  assert.deepEqual(withReality(BEFORE, 'ideal'), { sensor: { rings: 32 } });
  assert.deepEqual(inIdealWorld(BEFORE), { sensor: { rings: 32 } });
});

test('the presets are those that the core names', () => {
  const preset = { name: 'preset', choices: ['ideal', 'field', 'muddy'] };
  // What a parameter means, and its unit, name no preset.
  const groups = [
    { table: 'sensor', parameters: [] },
    { table: 'reality', parameters: [preset] },
    { table: 'reality.pose', parameters: [] },
  ] as unknown as ParameterGroup[];
  assert.deepEqual(realityPresets(groups), preset.choices);
  assert.deepEqual(groups.map(isEffects), [false, false, true]);
});

test('an effect is on where its value is not the ideal one', () => {
  const presets = [
    { preset: 'ideal', value: 2 },
    { preset: 'field', value: 0.9 },
  ];
  assert.deepEqual(
    [2, 0.9, 0.3].map((value) => isOn({ presets }, value)),
    [false, true, true],
  );
  assert.equal(isOn({ presets: [] }, 7), false, 'no effect at all');
});
