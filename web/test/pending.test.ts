import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Pending } from '../src/base/pending.ts';

test('settled once, when all is done, whichever ends last', async () => {
  const pending = new Pending();
  let settled = 0;
  const ends: (() => void)[] = [];
  const work = () => new Promise<void>((resolve) => ends.push(resolve));
  const both = [work(), work()].map((one) =>
    pending.add(one, () => {
      settled += 1;
    }),
  );
  ends[1]?.();
  await both[1];
  assert.deepEqual([pending.any, settled], [true, 0]);
  ends[0]?.();
  await both[0];
  assert.deepEqual([pending.any, settled], [false, 1]);
});
