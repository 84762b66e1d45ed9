import assert from 'node:assert/strict';
import { test } from 'node:test';
import { MountNotice } from '../src/notices/mountNotice.ts';
import { isSetAside, RETURN_KINDS } from '../src/protocol/simulationProtocol.ts';

test('the kinds of returns that the planner sets aside are told from the others by their numbers', () => {
  const aside = RETURN_KINDS.filter((_, number) => isSetAside(number));
  assert.deepEqual(aside, ['body', 'stray', 'overhead']);
  assert.equal(RETURN_KINDS.indexOf('stray'), 4);
  assert.equal(isSetAside(255), false);
});

test('a mount that does not fit is said once, and taken back when it fits', () => {
  const said: string[] = [];
  const notice = new MountNotice({
    tell: (message) => said.push(message),
    withdraw: (message) => said.push(`- ${message}`),
  });
  const misfit = 'the ground lies 1.7 m below the sensor';
  const frames = [undefined, misfit, misfit, undefined, undefined];
  for (const mount_misfit of frames) notice.show({ mount_misfit });
  const message = `Mount of the sensor: ${misfit}.`;
  assert.deepEqual(said, [message, `- ${message}`]);
});
