/** One parameter over values and seeds: a plot, a table to replay from, and files that the command line drives the same way. */

import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from '@playwright/test';
import { unzipSync } from 'fflate';
import { DEVICES, faults } from './axe.ts';
import { said } from './commandLine.ts';
import { expect, file, openLab, shortCourse, state, test, until } from './page.ts';

const tab = (page: Page) => page.getByRole('tabpanel', { name: 'Sweep' });
const PATH = 'planner.perception.variance_threshold';

/** The rows of a table with commas, by the names of its columns. */
function rows(csv: string): Record<string, string>[] {
  const [head = '', ...lines] = csv.trim().split('\n');
  const names = head.split(',');
  return lines.map((line) => Object.fromEntries(line.split(',').map((cell, at) => [names[at], cell])));
}

async function saved(page: Page, name: string, shown = tab(page)): Promise<Buffer> {
  const [file] = await Promise.all([page.waitForEvent('download'), shown.getByRole('button', { name }).click()]);
  return readFileSync(await file.path());
}

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);

    test('values are driven with seeds, plotted and replayed', async ({ mapless: page }) => {
      await shortCourse(page, 3);
      await openLab(page, 'Sweep', device === 'phone' ? 'tap' : 'click');
      await expect(tab(page).getByLabel('Parameter')).toHaveValue(PATH);
      await tab(page).getByLabel('Values').fill('0.3, 0.7');
      await tab(page).getByLabel('Seeds').fill('2');
      const run = tab(page).getByRole('button', { name: 'Run' });
      await (device === 'phone' ? run.tap() : run.click());
      await expect(tab(page).getByRole('status')).toHaveText('4 trials of Best. Press a value to see it driven.');
      const plots = tab(page).getByRole('img');
      await expect(plots).toHaveCount(2);
      await expect(plots.first()).toHaveAttribute('aria-label', '0.3: 100 %; 0.7: 100 %');
      await expect(plots.last()).toHaveAttribute('aria-label', /^0\.3: [23]\.\d; 0\.7: [23]\.\d$/);
      await tab(page).getByLabel('Metric').selectOption({ label: 'Largest roll' });
      await expect(plots.last()).toHaveAttribute('aria-label', /^0\.3: 0\.\d{3}; 0\.7: 0\.\d{3}$/);
      expect(await faults(page)).toEqual([]);
      const show = tab(page).getByRole('button', { name: 'Show 0.7 with seed 2' });
      await (device === 'phone' ? show.tap() : show.click());
      await until(page, (now) => now.seed === 2 && now.outcome === 'reached');
      expect((await state(page)).overrides).toEqual({ planner: { perception: { variance_threshold: 0.7 } } });
    });
  });
}

test('its campaign gives the same digests on the command line as its table says', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await shortCourse(page, 2);
  await page.evaluate(() => window.mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } }));
  await openLab(page, 'Sweep');
  await tab(page).getByLabel('Values').fill('0.3, 0.5');
  await tab(page).getByLabel('Seeds').fill('2');
  await tab(page).getByRole('button', { name: 'Run' }).click();
  await expect(tab(page).getByRole('status')).toHaveText(/^4 trials/);
  const table = rows((await saved(page, 'Save as CSV')).toString());
  const folder = test.info().outputPath();
  for (const [name, bytes] of Object.entries(unzipSync(await saved(page, 'Save as campaign')))) {
    writeFileSync(join(folder, name), bytes);
  }
  said('trials', join(folder, 'campaign.toml'), '--out', join(folder, 'results'));
  const native = rows(readFileSync(join(folder, 'results/trials.csv'), 'utf8'));
  const key = (row: Record<string, string>) =>
    `${Number(row.parameters?.split('=').at(-1))} ${row.seed} ${row.outcome} ${row.ticks} ${row.digest}`;
  expect(table.map(key).sort()).toEqual(native.map(key).sort());
  // The goal is not that of the route.
  expect(table.every(({ route }) => /^ht-changed-[0-9a-f]{8}$/.test(route ?? ''))).toBe(true);
  expect(table.every(({ planner }) => planner === 'default')).toBe(true);
  expect(table.every(({ parameters }) => parameters?.startsWith('sensor.range_noise_m=0.03 '))).toBe(true);
  // What was saved opens again: the course that was driven.
  const goal = (await state(page)).goal;
  await page.locator('#files').setInputFiles(file('swept.zip', await saved(page, 'Save as campaign')));
  await until(page, (now) => now.scenario === 'swept');
  expect((await state(page)).goal).toEqual(goal);
});

test('a value that is none is said at once, one that is refused when it is driven; by keyboard', async ({
  mapless: page,
}) => {
  await shortCourse(page, 3);
  await page.keyboard.press('p');
  await expect(page.getByRole('tab', { name: 'Parameters' })).toBeFocused();
  for (let tabs = 0; tabs < 3; tabs += 1) await page.keyboard.press('ArrowRight');
  await expect(page.getByRole('tab', { name: 'Sweep' })).toBeFocused();
  // The button that closes the drawer, the planner, the parameter, the values.
  for (let tabs = 0; tabs < 4; tabs += 1) await page.keyboard.press('Tab');
  await expect(tab(page).getByLabel('Values')).toBeFocused();
  await page.keyboard.press('Control+A');
  // With letters that are keys of the page elsewhere.
  await page.keyboard.type('0.5, much');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await expect(tab(page).getByRole('alert')).toHaveText(/“much”: expected numbers with commas between/);
  await expect(tab(page).getByLabel('Values')).toBeFocused();
  await page.keyboard.press('Control+A');
  await page.keyboard.type('-1');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await expect(tab(page).getByRole('alert')).toHaveText(new RegExp(`^${PATH.replaceAll('.', '\\.')} = -1: `));
  await expect(tab(page).getByRole('status')).toHaveText('');
});

test('a sweep is cancelled, and an edited course takes no replay', async ({ mapless: page }) => {
  await shortCourse(page, 3);
  await openLab(page, 'Sweep');
  await tab(page).getByLabel('Seeds').fill('100');
  await tab(page).getByRole('button', { name: 'Run' }).click();
  const first = tab(page)
    .getByRole('button', { name: /^Show .* with seed/ })
    .first();
  await expect(first).toBeEnabled();
  await tab(page).getByRole('button', { name: 'Cancel' }).click();
  await expect(tab(page).getByRole('status')).toHaveText(/^Cancelled after \d+ trials\.$/);
  const { start } = await state(page);
  await page.evaluate((goal) => window.mapless?.setGoal(goal), { x: start.x + 5, y: start.y });
  await expect(first).toBeDisabled();
});

test('many seeds are saved as a table and as a campaign that gives the same digests', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht', { preset: 'paper' }));
  await shortCourse(page, 2);
  await page.evaluate(() => window.mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } }));
  await openLab(page, 'Seeds');
  const seeds = page.getByRole('tabpanel', { name: 'Seeds' });
  await seeds.getByLabel('How many').fill('2');
  await seeds.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(seeds.getByRole('status')).toHaveText(/^2 trials/);
  const table = rows((await saved(page, 'Save as CSV', seeds)).toString());
  expect(table.map(({ seed }) => seed)).toEqual(['1', '2']);
  expect(table[0]).toMatchObject({ planner: 'paper', parameters: 'sensor.range_noise_m=0.03' });
  const folder = test.info().outputPath();
  for (const [name, bytes] of Object.entries(unzipSync(await saved(page, 'Save as campaign', seeds)))) {
    writeFileSync(join(folder, name), bytes);
  }
  said('trials', join(folder, 'campaign.toml'), '--out', join(folder, 'results'));
  const native = rows(readFileSync(join(folder, 'results/trials.csv'), 'utf8'));
  const key = ({ seed, outcome, ticks, digest }: Record<string, string>) => [seed, outcome, ticks, digest].join(' ');
  expect(table.map(key).sort()).toEqual(native.map(key).sort());
});

test('another planner drives a batch, which says so; a trial of it is seen as a ghost', async ({ mapless: page }) => {
  await shortCourse(page, 2);
  await openLab(page, 'Seeds');
  const seeds = page.getByRole('tabpanel', { name: 'Seeds' });
  await expect(seeds.getByLabel('Planner').locator('option').first()).toHaveText('the one in view: Best');
  await seeds.getByLabel('Planner').selectOption('direct');
  await seeds.getByLabel('How many').fill('2');
  await seeds.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(seeds.getByRole('status')).toHaveText(
    '2 trials of Direct. Press a seed to see it driven as a ghost beside the robot in view.',
  );
  const table = rows((await saved(page, 'Save as CSV', seeds)).toString());
  expect(table.map(({ planner }) => planner)).toEqual(['direct', 'direct']);
  const time = await seeds.locator('.trials-table tbody tr').nth(1).getByRole('cell').nth(1).textContent();
  await seeds.getByRole('button', { name: 'Show seed 2' }).click();
  await until(page, (now) => now.seed === 2 && now.outcome === 'reached');
  await page.getByRole('tab', { name: 'Compare' }).click();
  await expect(page.getByRole('checkbox', { name: /^Direct/ })).toBeChecked();
  const compared = page.getByRole('tabpanel', { name: 'Compare' }).getByRole('row', { name: /^Time/ });
  await expect(compared.locator('td').last()).toHaveText(time ?? '');
});

test('somebody’s own planner drives seeds and values; where it breaks off is told', async ({ mapless: page }) => {
  await shortCourse(page, 2);
  await openLab(page, 'Compare');
  await page.getByRole('heading', { name: 'Your own planner' }).click();
  await page.getByLabel('Your planner, in JavaScript').fill(`export default ({ pose, goal }) => {
  const bearing = Math.atan2(goal.y - pose.y, goal.x - pose.x) - pose.yaw;
  return { linear_m_s: 0.8, angular_rad_s: Math.atan2(Math.sin(bearing), Math.cos(bearing)) };
};`);
  await page.getByRole('tab', { name: 'Seeds' }).click();
  const seeds = page.getByRole('tabpanel', { name: 'Seeds' });
  await seeds.getByLabel('Planner').selectOption('own');
  await seeds.getByLabel('How many').fill('3');
  await seeds.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(seeds.getByRole('status')).toHaveText(
    /^3 trials of your planner\.js\. .* there is no campaign to save\.$/,
  );
  await expect(seeds.locator('.seeds-summary')).toContainText('3 of 3');
  await expect(seeds.getByRole('button', { name: 'Save as campaign' })).toBeHidden();
  await page.getByRole('tab', { name: 'Sweep' }).click();
  await tab(page).getByLabel('Planner').selectOption('own');
  await tab(page).getByLabel('Parameter').selectOption('sensor.range_noise_m');
  await tab(page).getByLabel('Values').fill('0.01, 0.1');
  await tab(page).getByLabel('Seeds').fill('1');
  await tab(page).getByRole('button', { name: 'Run' }).click();
  await expect(tab(page).getByRole('status')).toHaveText(/^2 trials of your planner\.js\./);
  await tab(page).getByRole('button', { name: 'Show 0.1 with seed 1' }).click();
  await until(page, (now) => now.outcome === 'reached');
  await page.getByRole('tab', { name: 'Compare' }).click();
  await expect(page.getByRole('checkbox', { name: /^Yours/ })).toBeChecked();
  await page.getByLabel('Your planner, in JavaScript').fill('export default () => { throw new Error("no way"); };');
  await page.getByRole('tab', { name: 'Seeds' }).click();
  await seeds.getByLabel('How many').fill('2');
  await seeds.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(seeds.getByRole('alert')).toContainText(/Seed 1: planner\.js at 0\.0 s: .*no way/);
  await expect(seeds.getByRole('alert')).toContainText('Seed 2: planner.js');
});

test('the table of a comparison is saved, with parameters and digests of each', async ({ mapless: page }) => {
  await shortCourse(page, 2);
  await page.evaluate(() => window.mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } }));
  await openLab(page, 'Compare');
  const compare = page.getByRole('tabpanel', { name: 'Compare' });
  await expect(compare.getByRole('button', { name: 'Save as CSV' })).toBeHidden();
  await page.getByRole('checkbox', { name: /^Best/ }).check();
  await page.getByRole('checkbox', { name: /^Direct/ }).check();
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome === 'reached');
  await expect(compare.getByRole('row', { name: 'Outcome' }).getByText('Goal reached')).toHaveCount(3);
  const [own, best, direct] = rows((await saved(page, 'Save as CSV', compare)).toString());
  const { digest, seed, tick } = await state(page);
  expect(own).toMatchObject({
    planner: 'default',
    seed: String(seed),
    outcome: 'reached',
    ticks: String(tick),
    digest,
  });
  expect(own?.parameters).toBe('sensor.range_noise_m=0.03');
  expect(best).toEqual(own);
  expect(direct).toMatchObject({ planner: 'direct', parameters: 'sensor.range_noise_m=0.03', outcome: 'reached' });
  expect(direct?.digest).not.toBe(digest);
});
