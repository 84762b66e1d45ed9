import assert from 'node:assert/strict';
import { test } from 'node:test';
import { countOverrides, override, sectionsOf, withOverride } from '../src/experiment/overrides.ts';
import { complaintAbout, label, type ParameterGroup } from '../src/experiment/parameters.ts';
import { withMount } from '../src/lab/mount.ts';

test('a value is set, counted, found and taken away, and the record before stays as it was', () => {
  const none = {};
  const noise = withOverride(none, 'sensor', 'range_noise_m', 0.1);
  const both = withOverride(noise, 'planner.perception.kernel', 'length_scales_rad', [0.1, 0.2]);
  assert.deepEqual(none, {});
  assert.deepEqual(noise, { sensor: { range_noise_m: 0.1 } });
  assert.equal(countOverrides(both), 2);
  assert.deepEqual(override(both, 'planner.perception.kernel', 'length_scales_rad'), [0.1, 0.2]);
  assert.equal(override(both, 'planner.perception', 'kernel'), undefined);
  assert.equal(override(both, 'robot', 'width_m'), undefined);
  assert.deepEqual(withOverride(both, 'planner.perception.kernel', 'length_scales_rad', undefined), noise);
});

test('sections are written as a scenario file has them', () => {
  let overrides = withOverride({}, 'planner', 'period_s', 0.2);
  overrides = withOverride(overrides, 'planner.decision', 'cost_model', 'paper');
  overrides = withOverride(overrides, 'planner.perception.kernel', 'length_scales_rad', [0.1, 1e-7]);
  overrides = withOverride(overrides, 'planner.segments', 'subgoals_on_unknown', false);
  assert.equal(
    sectionsOf(overrides),
    [
      '[planner]',
      'period_s = 0.2',
      '',
      '[planner.decision]',
      'cost_model = "paper"',
      '',
      '[planner.perception.kernel]',
      'length_scales_rad = [0.1, 1e-7]',
      '',
      '[planner.segments]',
      'subgoals_on_unknown = false',
    ].join('\n'),
  );
});

test('a complaint of the core is brought to its field', () => {
  const number = {
    unit: '',
    text: '',
    value: 1,
    kind: 'number',
    range: [0, 1] as [number, number],
    choices: undefined,
    paper: undefined,
  } as const;
  const groups: ParameterGroup[] = [
    { table: 'planner.controller', title: '', parameters: [{ ...number, name: 'max_speed_m_s' }] },
    { table: 'robot', title: '', parameters: [{ ...number, name: 'max_speed_m_s' }] },
    { table: 'sensor', title: '', parameters: [{ ...number, name: 'columns' }] },
  ];
  const about = (message: string) => complaintAbout(message, groups);
  assert.equal(about('settings: robot.max_speed_m_s = 0: expected a finite number above 0'), 'robot.max_speed_m_s');
  assert.equal(about('sensor.columns = 1.5: invalid type: floating point `1.5`, expected usize'), 'sensor.columns');
  assert.equal(about('something else'), undefined);
});

test('names are plain words', () => {
  assert.equal(label('max_slope_rad'), 'max slope');
  assert.equal(label('max_acceleration_m_s2'), 'max acceleration');
  assert.equal(label('inducing_spacing_length_scales'), 'inducing spacing');
});

test('a mount takes the place of the one before and leaves the rest', () => {
  const before = { sensor: { rings: 32, height_m: 1.2, pitch_rad: 0.1 } };
  assert.deepEqual(withMount(before, { pitch_rad: -0.2618 }), { sensor: { rings: 32, pitch_rad: -0.2618 } });
  assert.deepEqual(withMount({ sensor: { left_m: 0.2 } }, {}), {});
});
