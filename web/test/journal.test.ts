import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Journal } from '../src/core/journal.ts';
import type { Command } from '../src/core/protocol.ts';

const load: Command = {
  type: 'load',
  scenario: 'ht',
  setting: { preset: 'default', learning: 'fixed' },
  seed: 3,
};
const goal = (x: number): Command => ({ type: 'goal', goal: { x, y: 0 } });
const dab = (x: number): Command => ({
  type: 'sculpt',
  brush: { x, y: 0, radius_m: 1, strength_m: 1, kind: 'raise' },
});

test('the session is made again in order, and begins at its start', () => {
  const journal = new Journal();
  assert.deepEqual(journal.commands, []);
  for (const command of [load, goal(1), dab(2), goal(3), dab(4)]) journal.note(command);
  assert.deepEqual(journal.commands, [load, dab(2), goal(3), dab(4), { type: 'restart' }]);
});

test('playing leaves no trace, and loading leaves nothing of before', () => {
  const journal = new Journal();
  for (const command of [load, dab(1), { type: 'play', playing: true }, { type: 'step' }, load] as Command[]) {
    journal.note(command);
  }
  assert.deepEqual(journal.commands, [load]);
});
