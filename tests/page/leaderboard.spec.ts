/** The table of a campaign, as the command line writes it: standings, and each trial to be driven in the view. */

import { readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import type { Page } from '@playwright/test';
import { rowsOf } from '../../web/src/files/csv.ts';
import { DEVICES, faults } from './axe.ts';
import { said } from './commandLine.ts';
import { expect, file, runToEnd, state, test, until } from './page.ts';

/** The tables of a campaign of two planners on a short scenario. */
function campaign(): { csv: string; parquet: Buffer } {
  const folder = test.info().outputPath();
  const scenario = resolve('terrains/scenarios/ht.toml');
  const text = `planners = ["default", "direct"]\nroutes = ["${scenario}"]\nseeds = [3, 4]\n`;
  writeFileSync(join(folder, 'small.toml'), text);
  said('trials', join(folder, 'small.toml'), '--out', join(folder, 'results'));
  return {
    csv: readFileSync(join(folder, 'results/trials.csv'), 'utf8'),
    parquet: readFileSync(join(folder, 'results/trials.parquet')),
  };
}

let csv = '';
let parquet: Buffer = Buffer.of();
test.beforeAll(() => {
  ({ csv, parquet } = campaign());
});

const sheet = (page: Page) => page.getByRole('dialog', { name: /^Trials of trials\.(csv|parquet)$/ });
const open = (page: Page, content: string) => page.locator('#files').setInputFiles(file('trials.csv', content));

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);

    test('standings, filters and a trial that drives', async ({ mapless: page }) => {
      await open(page, csv);
      const standings = sheet(page).getByRole('table', { name: 'Standings' });
      await expect(standings.getByRole('row', { name: /^default 2 100\.0 % \(34\.2 to 100\.0\)/ })).toBeVisible();
      await expect(standings.getByRole('row', { name: /^direct 2 / })).toBeVisible();
      const trials = sheet(page).getByRole('table', { name: 'Trials' });
      await expect(trials.locator('tbody tr')).toHaveCount(4);
      expect(await faults(page)).toEqual([]);
      await expect(trials.getByRole('button', { name: 'Drive ht, 3 with direct' })).toBeDisabled();
      await expect(sheet(page).getByRole('status').last()).toHaveText(
        /^4 trials\. What cannot be pressed: The view drives the planners default and paper;/,
      );
      await sheet(page).getByLabel('On route').selectOption('ht');
      await expect(trials.locator('tbody tr')).toHaveCount(4);
      await sheet(page).getByLabel('Planner').selectOption('default');
      await expect(trials.locator('tbody tr')).toHaveCount(2);
      await expect(sheet(page).getByRole('status').last()).toHaveText('2 trials.');
      const drive = trials.getByRole('button', { name: 'Drive ht, 4 with default' });
      await (device === 'phone' ? drive.tap() : drive.click());
      await expect(sheet(page)).toHaveCount(0);
      await until(page, (now) => now.scenario === 'ht' && now.seed === 4 && now.playing);
      // On a phone it is driven by the same core.
      if (device === 'phone') return;
      await test.step('with the digest of its row', async () => {
        const row = rowsOf(csv).find(({ planner, seed }) => planner === 'default' && seed === '4');
        expect((await runToEnd(page)).digest).toBe(row?.digest);
      });
    });
  });
}

test('Parquet has the same standings and trials; what is damaged is refused with its name', async ({
  mapless: page,
}) => {
  const tables = async () => {
    await expect(sheet(page).locator('.standings tbody tr')).toHaveCount(6);
    return sheet(page).locator('.standings').allInnerTexts();
  };
  await open(page, csv);
  const asCsv = await tables();
  await sheet(page).getByRole('button', { name: 'Close' }).click();
  await page.locator('#files').setInputFiles(file('trials.parquet', parquet));
  await expect(sheet(page)).toHaveAccessibleName('Trials of trials.parquet');
  expect(await tables()).toEqual(asCsv);
  await sheet(page).getByRole('button', { name: 'Close' }).click();
  await page.locator('#files').setInputFiles(file('trials.parquet', parquet.subarray(0, 900)));
  await expect(page.locator('#notice-text')).toContainText('trials.parquet: damaged (');
});

test('the map has each planner’s path, driven again with the digest of its row', async ({ mapless: page }) => {
  await page.locator('#files').setInputFiles(file('trials.parquet', parquet));
  await sheet(page).getByRole('button', { name: 'Draw the paths' }).click();
  const ways = sheet(page).locator('.paths-legend li');
  await expect(ways).toHaveCount(2);
  await expect(ways.filter({ hasText: 'default, seed 3' })).toHaveText(/reached, as in the table$/);
  await expect(ways.filter({ hasText: 'direct, seed 3' })).toHaveText(/, as in the table$/);
  // The view has the route, and stands still beside it.
  expect(await state(page)).toMatchObject({ scenario: 'ht', playing: false });
  const lengths = await sheet(page)
    .locator('.paths-line')
    .evaluateAll((lines) => lines.map((line) => (line as SVGPolylineElement).getTotalLength()));
  // In metres: the longer way is that which reached the goal.
  expect(Math.max(...lengths)).toBeGreaterThan(20);
  expect(await faults(page)).toEqual([]);
});

test.describe('on a phone', () => {
  test.use(DEVICES.phone);

  test('a tap has the paths drawn, on a map that axe finds nothing serious in', async ({ mapless: page }) => {
    await page.locator('#files').setInputFiles(file('trials.parquet', parquet));
    await sheet(page).getByRole('button', { name: 'Draw the paths' }).tap();
    await expect(sheet(page).locator('.paths-legend li')).toHaveCount(2);
    // Each has begun.
    await expect(sheet(page).locator('.paths-line[points]')).toHaveCount(2);
    expect(await state(page)).toMatchObject({ scenario: 'ht', playing: false });
    expect(await faults(page)).toEqual([]);
  });
});

test('a row is driven by keyboard; another table says what it lacks', async ({ mapless: page }) => {
  await open(page, csv);
  await sheet(page).getByLabel('Planner').selectOption('default');
  await sheet(page).getByRole('button', { name: 'Drive ht, 3 with default' }).focus();
  await page.keyboard.press('Enter');
  await until(page, (now) => now.scenario === 'ht' && now.seed === 3);
  await open(page, 'time_s,x_m\n0,1\n');
  await expect(page.locator('#notice-text')).toContainText('trials.csv: no column planner, route, seed, outcome');
});

test('every row of a long table is reached, and a filter begins with its first ones', async ({ mapless: page }) => {
  const [names = '', line = ''] = csv.split('\n');
  const at = names.split(',').indexOf('seed');
  const lines = Array.from({ length: 450 }, (_, seed) => line.split(',').with(at, String(seed)).join(','));
  await open(page, [names, ...lines, ''].join('\n'));
  const trials = sheet(page).getByRole('table', { name: 'Trials' });
  await expect(trials.locator('tbody tr')).toHaveCount(200);
  await expect(sheet(page).getByRole('status').last()).toHaveText(/^The first 200 of 450 trials\./);
  await sheet(page).getByRole('button', { name: 'Show 200 more' }).click();
  await expect(trials.locator('tbody tr')).toHaveCount(400);
  await sheet(page).getByRole('button', { name: 'Show 50 more' }).focus();
  await page.keyboard.press('Enter');
  await expect(trials.locator('tbody tr').last()).toContainText(', 449');
  await expect(sheet(page).getByRole('status').last()).toHaveText(/^450 trials\./);
  await expect(sheet(page).getByRole('button', { name: /more$/ })).toBeHidden();
  await sheet(page).getByLabel('Outcome').selectOption('reached');
  await expect(trials.locator('tbody tr')).toHaveCount(200);
});
