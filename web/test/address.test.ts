import assert from 'node:assert/strict';
import { test } from 'node:test';
import { askedFor, askingFor, momentIn } from '../src/experiment/address.ts';
import type { Experiment } from '../src/experiment/experiment.ts';
import { EXPERIMENT } from './example.ts';

const asked = (search: string) => askedFor(new URLSearchParams(search));

test('an address asks for a scenario, and for a trial of it', () => {
  const none = {
    scenario: 'gsb',
    preset: undefined,
    learning: undefined,
    seed: undefined,
    reality: undefined,
    moment_s: undefined,
  };
  assert.equal(asked('?embed'), undefined);
  assert.deepEqual(asked('?scenario=gsb'), none);
  assert.deepEqual(asked('?scenario=gsb&seed=0&preset=paper'), { ...none, preset: 'paper', seed: 0 });
  assert.deepEqual(asked('?scenario=gsb&reality=harsh'), { ...none, reality: 'harsh' });
  assert.deepEqual(asked('?scenario=gsb&learning=once'), { ...none, learning: 'once' });
  assert.equal(asked('?scenario=gsb&seed=4294967295')?.seed, 0xffff_ffff);
  assert.deepEqual(asked('?scenario=gsb&t=8.9'), { ...none, moment_s: 8.9 });
});

test('an address that makes no sense is refused in words', () => {
  for (const seed of ['', '-1', '1.5', '1e3', 'NaN', '4294967296']) {
    assert.throws(
      () => asked(`?scenario=gsb&seed=${seed}`),
      /\?seed = .*: expected a (whole )?number from 0 to 4294967295$/,
    );
  }
  assert.throws(() => asked('?scenario=gsb&preset=best'), /\?preset = "best": expected default or paper$/);
  assert.throws(() => asked('?scenario=gsb&reality=real'), /\?reality = "real": expected ideal or field or harsh$/);
  assert.throws(() => asked('?reality=field'), /\?scenario = absent: expected a name/);
  assert.throws(() => asked('?scenario=gsb&learning=on'), /\?learning = "on": expected fixed or once or every_scan$/);
  for (const t of ['', '-1', 'soon', '1e3', '3601']) {
    assert.throws(() => asked(`?scenario=gsb&t=${t}`), /^Error: t = .*: expected a number from 0 to 3600$/);
    assert.throws(() => momentIn(`#e=abc&t=${t}`), /expected a number from 0 to 3600$/);
  }
  assert.throws(() => asked('?t=8.9'), /\?scenario = absent: expected a name/);
  assert.throws(() => asked('?seed=7'), /\?scenario = absent: expected a name/);
});

test('an address asks for what is shown, where it can say all of it', () => {
  const scenario: Experiment = {
    ...EXPERIMENT,
    name: 'gsb',
    strokes: [],
    preset: 'default',
    learning: 'fixed',
    overrides: {},
  };
  const asking = (part: Partial<Experiment>) => askingFor({ ...scenario, ...part }, scenario)?.toString();
  assert.equal(asking({}), 'scenario=gsb');
  const trial: Partial<Experiment> = {
    seed: 77,
    preset: 'paper',
    learning: 'once',
    overrides: { reality: { preset: 'field' } },
  };
  assert.equal(asking(trial), 'scenario=gsb&preset=paper&learning=once&seed=77&reality=field');
  const { scenario: _name, ...said } = askedFor(new URLSearchParams(asking(trial))) ?? {};
  assert.deepEqual(said, { seed: 77, preset: 'paper', learning: 'once', reality: 'field', moment_s: undefined });
  for (const more of [
    { overrides: { sensor: { range_noise_m: 0.1 } } },
    { overrides: { reality: { preset: 'field', motion: { slip: 1 } } } },
    { goal: { x: 1, y: 2 } },
    { strokes: EXPERIMENT.strokes },
  ]) {
    assert.equal(asking(more), undefined, JSON.stringify(more));
  }
  assert.equal(askingFor(scenario, undefined), undefined);
});
