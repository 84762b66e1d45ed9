/** The files that the page saves of a run open in the page again, as the run that they were saved from. */

import { readFileSync } from 'node:fs';
import type { Download, Page } from '@playwright/test';
import { driveTo, expect, file, state, test, until } from './page.ts';

/** What `press` saves, by the end of its name. */
async function saved(page: Page, press: string, end: string): Promise<Buffer> {
  const ours = (one: Download) => one.suggestedFilename().endsWith(end);
  const [download] = await Promise.all([page.waitForEvent('download', ours), page.locator(press).click()]);
  return readFileSync(await download.path());
}

/** Opens it while another run drives, and waits until it says what became of it. */
async function open(page: Page, name: string, bytes: Buffer, words: string): Promise<void> {
  await page.evaluate(() => window.mapless?.loadScenario('ml'));
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.tick > 3);
  await page.locator('#files').setInputFiles(file(name, bytes));
  await expect(page.locator('#notice-text')).toContainText(words, { timeout: 120_000 });
}

const SAME = 'Every decision is the same, to the bit';

test('MCAP, result and what is saved with the table open as the run, where it stood', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 5 }));
  await page.evaluate(() => window.mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } }));
  await driveTo(page, 15);
  const { tick, digest, seed, pose } = await state(page);
  const files: [name: string, bytes: Buffer][] = [
    ['run.mcap', await saved(page, '#save-mcap', 'run.mcap')],
    ['result.json', await saved(page, '#save-json', 'result.json')],
    ['beside.json', await saved(page, '#save-csv', 'trajectory.run.json')],
  ];
  for (const [name, bytes] of files) {
    await open(page, name, bytes, `${name}: the page drove this run again`);
    await expect(page.locator('#notice-text')).toContainText(SAME);
    expect(await state(page)).toMatchObject({ scenario: 'ht', tick, digest, seed, pose, playing: false });
  }
  // The slider goes to any moment of it, and it drives on from there.
  await page.locator('#scrub').fill('4');
  await expect.poll(async () => (await state(page)).tick).toBe(4);
  await page.locator('#scrub').fill(String(tick));
  await expect.poll(async () => (await state(page)).digest).toBe(digest);
  await page.evaluate(() => window.mapless?.step());
  expect((await state(page)).tick).toBe(tick + 1);

  const table = await saved(page, '#save-csv', 'trajectory.csv');
  await page.locator('#files').setInputFiles(file('trajectory.csv', table));
  const notice = page.locator('#notice-text');
  await expect(notice).toContainText('trajectory.csv: the trajectory of a run, which does not say what was run.');
  await expect(notice).toContainText('open its MCAP, its result (JSON) or the .run.json saved with it');
  expect((await state(page)).tick).toBe(tick + 1);
});

test('a run that was changed under way says so; a cut or broken file is refused', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await driveTo(page, 5);
  const { tick, pose } = await state(page);
  await page.evaluate(({ x, y }) => window.mapless?.setGoal({ x: x - 5, y: y - 5 }), pose);
  await page.evaluate(() => window.mapless?.play());
  await driveTo(page, tick + 8);
  const bytes = await saved(page, '#save-mcap', 'run.mcap');
  await open(page, 'run.mcap', bytes, `It was changed under way (tick ${tick}), which the file does not hold`);
  expect((await state(page)).scenario).toBe('ht');

  await open(page, 'cut.mcap', bytes.subarray(0, bytes.length - 40), 'cut.mcap: the file is cut off');
  const other = Buffer.from(bytes.toString('latin1').replaceAll('"version":1', '"version":7'), 'latin1');
  await open(page, 'other.mcap', other, 'other.mcap: version = 7: expected');
  expect((await state(page)).scenario).toBe('ml');
});
