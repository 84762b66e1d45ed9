import assert from 'node:assert/strict';
import { test } from 'node:test';
import { deflateRawSync } from 'node:zlib';
import { momentIn } from '../src/experiment/address.ts';
import type { Experiment } from '../src/experiment/experiment.ts';
import { carriesExperiment, experimentIn, linkTo, MAX_LINK_CHARACTERS } from '../src/experiment/link.ts';
import { EXPERIMENT, OBJECTS } from './example.ts';

const ADDRESS = 'https://example.org/mapless/#old';

function hashOf(link: string): string {
  return new URL(link).hash;
}

/** A link's fragment with anything in it. */
function holding(text: string | Uint8Array): string {
  return `#e=${deflateRawSync(text).toString('base64url')}`;
}

async function refused(hash: string, why: RegExp): Promise<void> {
  await assert.rejects(experimentIn(hash), (error: Error) => {
    assert.match(error.message, /^This link does not work, so nothing was changed\. /);
    assert.match(error.message, why);
    return true;
  });
}

test('a link gives the same experiment back', async () => {
  const link = await linkTo(ADDRESS, EXPERIMENT);
  assert.ok(link.startsWith('https://example.org/mapless/#e='));
  assert.ok(carriesExperiment(hashOf(link)));
  assert.deepEqual(await experimentIn(hashOf(link)), EXPERIMENT);
  const turned: Experiment = { ...EXPERIMENT, goal: { x: 14, y: 57, heading_rad: -1.571 } };
  assert.deepEqual(await experimentIn(hashOf(await linkTo(ADDRESS, turned))), turned);
  const furnished: Experiment = { ...EXPERIMENT, objects: OBJECTS };
  assert.deepEqual(await experimentIn(hashOf(await linkTo(ADDRESS, furnished))), furnished);
});

test('a link may hold a moment beside the experiment', async () => {
  const link = await linkTo(ADDRESS, EXPERIMENT, 0.1 + 0.2);
  assert.match(link, /&t=0\.3$/);
  assert.deepEqual(await experimentIn(hashOf(link)), EXPERIMENT);
  assert.equal(momentIn(hashOf(link)), 0.3);
  assert.equal(momentIn(hashOf(await linkTo(ADDRESS, EXPERIMENT))), undefined);
});

test('a recipe fits into a chat message, and so does an afternoon of sculpting', async () => {
  const bare = await linkTo(ADDRESS, { ...EXPERIMENT, strokes: [] });
  assert.ok(bare.length < 400, `${bare.length}`);
  // Twelve strokes of a hand that wanders: 500 touches.
  let state = 1;
  const step = () => {
    state = (state * 48_271) % 0x7fff_ffff;
    return (state % 31) - 15;
  };
  const strokes = Array.from({ length: 12 }, (_, index) => {
    const points_cm = [1000 + 300 * index, 2000];
    while (points_cm.length < 84) points_cm.push((points_cm.at(-2) ?? 0) + step(), (points_cm.at(-1) ?? 0) + step());
    return { kind: 'raise' as const, radius_m: 2, strength_m: 0.07, points_cm };
  });
  const sculpted: Experiment = { ...EXPERIMENT, strokes };
  const link = await linkTo(ADDRESS, sculpted);
  assert.ok(link.length < MAX_LINK_CHARACTERS, `${link.length}`);
  assert.deepEqual(await experimentIn(hashOf(link)), sculpted);
});

test('links cut short or damaged are refused in words', async () => {
  const whole = hashOf(await linkTo(ADDRESS, EXPERIMENT));
  for (let length = 3; length < whole.length; length += 7) await refused(whole.slice(0, length), /damaged/);
  await refused('#e=', /damaged/);
  await refused('#e=%00', /damaged/);
  await refused('#e=AAAA', /damaged|JSON/);
  for (let at = 3; at < whole.length; at += 5) {
    const other = whole[at] === 'A' ? 'B' : 'A';
    const flipped = whole.slice(0, at) + other + whole.slice(at + 1);
    const result: unknown = await experimentIn(flipped).catch((error: unknown) => error);
    // A flipped letter is refused, or gives another sound document.
    if (result instanceof Error) assert.match(result.message, /^This link does not work/);
    else assert.equal((result as { version?: number }).version, 1);
  }
});

test('hostile links are refused in words', async () => {
  await refused(holding('{"version":1'), /JSON/);
  await refused(holding('[]'), /version = absent/);
  await refused(holding('null'), /version = absent/);
  await refused(holding(JSON.stringify({ ...EXPERIMENT, version: 9 })), /version = 9/);
  await refused(holding(JSON.stringify({ ...EXPERIMENT, goal: { x: null, y: 0 } })), /goal\.x = null/);
  await refused(holding(JSON.stringify({ ...EXPERIMENT, strokes: [{ points_cm: ['a', {}] }] })), /strokes\[0\]/);
  await refused(holding(JSON.stringify({ ...EXPERIMENT, strokes: [null] })), /strokes\[0\] = null/);
  const huge = [0, 0, 1e308, 1e308, 1e308, 1e308];
  const far = { kind: 'raise', radius_m: 1, strength_m: 1, points_cm: huge };
  await refused(holding(JSON.stringify({ ...EXPERIMENT, strokes: [far] })), /points_cm/);
  await refused(holding(Uint8Array.of(0xff, 0xfe, 0xfd)), /holds no JSON/);
  await refused(holding(new Uint8Array(64 << 20)), /unpacks to more than 4 MB/);
  await refused(`#e=${'A'.repeat(200_001)}`, /200001 characters/);
});

test('prototypes stay untouched', async () => {
  await refused(holding(`{"__proto__":{"polluted":1},${JSON.stringify(EXPERIMENT).slice(1)}`), /__proto__/);
  const text = JSON.stringify(EXPERIMENT).replace('"sensor":{', '"sensor":{"__proto__":{"polluted":1},');
  const read = await experimentIn(holding(text)).catch(() => undefined);
  assert.equal(({} as { polluted?: number }).polluted, undefined);
  assert.ok(read === undefined || read.version === 1);
});
