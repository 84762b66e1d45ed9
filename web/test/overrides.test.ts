import assert from 'node:assert/strict';
import { test } from 'node:test';
import { countOverrides, override, sectionsOf, withOverride } from '../src/experiment/overrides.ts';
import { complaintAbout, label, type ParameterGroup, shown } from '../src/experiment/parameters.ts';
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
    presets: [],
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

test('angles are shown with four decimals at most, other values as they are', () => {
  assert.equal(shown(Math.PI, 'rad'), '3.1416');
  assert.equal(shown([-Math.PI, 0.05], 'rad'), '-3.1416, 0.05');
  assert.equal(shown(0.00001234, 'm'), '0.00001234');
});

/** The group of a scenario whose own mount is this. */
function mountGroup(values: Record<string, number>): ParameterGroup {
  const parameters = Object.entries(values).map(([name, value]) => ({
    name,
    value,
    kind: 'number',
    unit: '',
    text: '',
  }));
  return { table: 'sensor', title: 'Sensor mount', parameters } as ParameterGroup;
}

test('a mount takes the place of the one before and leaves the rest', () => {
  const own = mountGroup({ height_m: 0.6, left_m: 0, roll_rad: 0, pitch_rad: 0 });
  const before = { sensor: { rings: 32, height_m: 1.2, roll_rad: 3 } };
  const down = { roll_rad: 0, pitch_rad: -0.2618 };
  assert.deepEqual(withMount(before, down, own), { sensor: { rings: 32, pitch_rad: -0.2618 } });
  assert.deepEqual(withMount({ sensor: { left_m: 0.2 } }, { roll_rad: 0, pitch_rad: 0 }, own), {});
});

test('a level mount is level where that of the scenario is tilted', () => {
  const own = mountGroup({ roll_rad: 0, pitch_rad: -0.3 });
  assert.deepEqual(withMount({}, { roll_rad: 0, pitch_rad: 0 }, own), { sensor: { pitch_rad: 0 } });
  assert.deepEqual(withMount({ sensor: { roll_rad: 1 } }, { roll_rad: 0, pitch_rad: -0.3 }, own), {});
});
