import assert from 'node:assert/strict';
import { test } from 'node:test';
import { askedFor } from '../src/experiment/address.ts';

const asked = (search: string) => askedFor(new URLSearchParams(search));

test('an address asks for a scenario, and for a trial of it', () => {
  const none = { scenario: 'gsb', preset: undefined, seed: undefined, reality: undefined };
  assert.equal(asked('?embed'), undefined);
  assert.deepEqual(asked('?scenario=gsb'), none);
  assert.deepEqual(asked('?scenario=gsb&seed=0&preset=paper'), { ...none, preset: 'paper', seed: 0 });
  assert.deepEqual(asked('?scenario=gsb&reality=harsh'), { ...none, reality: 'harsh' });
  assert.equal(asked('?scenario=gsb&seed=4294967295')?.seed, 0xffff_ffff);
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
  assert.throws(() => asked('?seed=7'), /\?scenario = absent: expected a name/);
});
