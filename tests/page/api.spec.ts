import { readFileSync } from 'node:fs';
import { expect, state, test } from './page.ts';

const DOC = readFileSync('docs/API.md', 'utf8');

test('the example of docs/API.md works in the console', async ({ mapless: page }) => {
  const [, whole = ''] = /```js\n([\s\S]*?)```/.exec(DOC) ?? [];
  // A part of the minute is enough.
  const example = whole.replace('time_s < 60', 'time_s < 8');
  expect(example).not.toBe(whole);
  const said: string[] = [];
  // The browser and libraries warn there, too, whenever the view is first drawn.
  page.on('console', (message) => {
    if (message.type() === 'log') said.push(message.text());
  });
  await page.evaluate(`(async () => { ${example} })()`);
  const now = await state(page);
  expect(now).toMatchObject({ scenario: 'ht', seed: 7, playing: false, disturbed: false });
  expect(now.outcome !== 'running' || now.time_s >= 8).toBe(true);
  expect(said.join()).toMatch(/^(reached|running) .*#e=/);
});

test('every part of the state is named in docs/API.md', async ({ mapless: page }) => {
  const row = DOC.split('\n').find((line) => line.startsWith('| `state()`')) ?? '';
  for (const name of Object.keys(await state(page))) expect(row).toContain(`\`${name}\``);
});

test('what the API cannot carry out is rejected with the value and what was expected', async ({ mapless: page }) => {
  const said = await page.evaluate(async () => {
    const { mapless } = window;
    const calls = [
      () => mapless?.setSpeed(-1),
      () => mapless?.setSpeed(Number.NaN),
      () => mapless?.seek(Number.NaN),
      () => mapless?.setGoal({ x: Number.NaN, y: 1 }),
      () => mapless?.setGoal({ x: 10, y: 10 }, [{ x: -5, y: 1 }]),
      () => mapless?.setStart({ x: 1e9, y: 1, heading_rad: 0 }),
      () => mapless?.setOverrides({ sensor: { range_noise: 1 } }),
      () => mapless?.openExperiment({ version: 7 }),
      () => mapless?.sculpt({ kind: 'raise', radius_m: -1, strength_m: 1, points_cm: [1, 2] }),
    ];
    const messages: string[] = [];
    for (const call of calls) {
      await call()?.then(
        () => messages.push('done'),
        (error: unknown) => messages.push(error instanceof Error ? error.message : 'no error'),
      );
    }
    return messages;
  });
  expect(said).toHaveLength(9);
  for (const message of said) expect(message).toMatch(/expected|terrain/);
});
