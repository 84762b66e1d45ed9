import assert from 'node:assert/strict';
import { test } from 'node:test';
import { isSetAside, RETURN_KINDS } from '../src/protocol/simulationProtocol.ts';

test('the kinds of returns that the planner sets aside are told from the others by their numbers', () => {
  const aside = RETURN_KINDS.filter((_, number) => isSetAside(number));
  assert.deepEqual(aside, ['body', 'stray', 'overhead']);
  assert.equal(RETURN_KINDS.indexOf('stray'), 4);
  assert.equal(isSetAside(255), false);
});
