/** Parameter sets that are kept drive as ghosts beside the robot in view. */

import type { Page } from '@playwright/test';
import { DEVICES, faults } from './axe.ts';
import { expect, loaded, openLab, shortCourse, state, test, until } from './page.ts';

const tab = (page: Page) => page.getByRole('tabpanel', { name: 'Compare' });
const keep = (page: Page, name: string) => tab(page).getByRole('button', { name: `Keep these parameters as ${name}` });
const box = (page: Page, name: 'A' | 'B') => tab(page).getByRole('checkbox', { name: new RegExp(`^${name}( |$)`) });
const use = (page: Page, name: string) => tab(page).getByRole('button', { name: `Use the parameters of ${name}` });
/** Of the ghosts, in the order of their columns; the robot in view has the first cell. */
const cell = (page: Page, row: string, column: number) =>
  tab(page)
    .getByRole('row', { name: new RegExp(`^${row}`) })
    .locator('td')
    .nth(column);

const SLOW = { robot: { max_speed_m_s: 0.5 } };

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);
    const phone = device === 'phone';
    const press = phone ? 'tap' : 'click';

    test(`two sets are kept and given back${phone ? '' : ', and drive beside the robot by the same metrics'}`, async ({
      mapless: page,
    }) => {
      await shortCourse(page, 3);
      await openLab(page, 'Compare', press);
      await expect(box(page, 'A')).toBeHidden();
      await keep(page, 'A')[press]();
      await expect(box(page, 'A')).toBeChecked();
      await expect(box(page, 'A')).toHaveAccessibleName('A the parameters in view');
      await page.evaluate((slow) => window.mapless?.setOverrides(slow), SLOW);
      await expect(box(page, 'A')).toHaveAccessibleName(/^A max speed \S+ m\/s \(0\.5 m\/s\)$/);
      await keep(page, 'B')[press]();
      await expect(box(page, 'B')).toHaveAccessibleName('B the parameters in view');
      expect(await faults(page)).toEqual([]);
      if (phone) {
        await use(page, 'A')[press]();
        await until(page, (now) => Object.keys(now.overrides).length === 0);
        return;
      }
      await page.evaluate(() => window.mapless?.play());
      await until(page, (now) => now.outcome === 'reached');
      const { digest } = await state(page);
      await expect(cell(page, 'Outcome', 2)).toHaveText('Goal reached');
      await expect(cell(page, 'Outcome', 1)).toHaveText('Goal reached');
      // B drives as the robot in view does; A, which is faster, does not.
      for (const row of ['Distance', 'Largest roll', 'Vibration'])
        await expect(cell(page, row, 2)).toHaveText(/\(0\.0+\)$/);
      await expect(cell(page, 'Time', 1)).not.toHaveText((await cell(page, 'Time', 0).textContent()) ?? '');

      // The robot gets the parameters of A back.
      await use(page, 'A')[press]();
      await until(page, (now) => Object.keys(now.overrides).length === 0);
      await expect(box(page, 'B')).toHaveAccessibleName(/^B max speed 0\.5 m\/s \(/);
      await until(page, (now) => now.outcome === 'reached');
      expect((await state(page)).digest).not.toBe(digest);
      for (const row of ['Distance', 'Vibration']) await expect(cell(page, row, 1)).toHaveText(/\(0\.0+\)$/);
    });
  });
}

test('by keyboard alone; what was kept outlasts a reload, not in links', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.setOverrides({ planner: { decision: { cost_model: 'paper' } } }));
  await page.keyboard.press('p');
  await expect(page.getByRole('tab', { name: 'Parameters' })).toBeFocused();
  await page.keyboard.press('ArrowRight');
  await keep(page, 'A').focus();
  await page.keyboard.press('Enter');
  await expect(box(page, 'A')).toBeChecked();
  await box(page, 'A').focus();
  await page.keyboard.press('Space');
  await expect(box(page, 'A')).not.toBeChecked();
  expect(await page.evaluate(() => Object.keys(window.mapless?.experiment() ?? {}))).not.toContain('kept');
  await page.evaluate(() => window.mapless?.setOverrides({}));
  await page.reload();
  await loaded(page);
  await openLab(page, 'Compare');
  await expect(box(page, 'A')).toHaveAccessibleName('A cost model paper (forecast)');
  await expect(box(page, 'A')).not.toBeChecked();
  await expect(box(page, 'B')).toBeHidden();
});

test('other parameters in view begin only those anew that drive with them', async ({ mapless: page }) => {
  const begun: string[] = [];
  page.on('worker', (worker) => {
    if (worker.url().includes('trialsWorker')) begun.push(worker.url());
  });
  await shortCourse(page, 3);
  await openLab(page, 'Compare');
  const direct = tab(page).getByRole('checkbox', { name: /^Direct/ });
  await direct.check();
  await keep(page, 'A').click();
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome === 'reached');
  await expect(cell(page, 'Outcome', 1)).toHaveText('Goal reached');
  await expect(cell(page, 'Outcome', 2)).toHaveText('Goal reached');
  const [fast, kept] = [await cell(page, 'Time', 1).textContent(), await cell(page, 'Time', 2).textContent()];

  await page.evaluate((slow) => window.mapless?.setOverrides(slow), SLOW);
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome === 'reached');
  await expect(cell(page, 'Outcome', 1)).toHaveText('Goal reached');
  const time_s = (words: string | null) => Number.parseFloat(words?.replace(/^.*:/, '') ?? '');
  expect(time_s(await cell(page, 'Time', 1).textContent())).toBeGreaterThan(1.2 * time_s(fast));
  expect(time_s(await cell(page, 'Time', 2).textContent())).toBe(time_s(kept));
  // One worker for all: it drives on with A, and has Direct begin anew.
  expect(begun).toHaveLength(1);

  // Another course is another matter.
  await page.evaluate(() => window.mapless?.restart());
  await shortCourse(page, 2);
  await expect.poll(() => begun.length).toBe(2);
});

test('a set that the core refuses says why, and the others drive', async ({ mapless: page }) => {
  await shortCourse(page, 3);
  await page.evaluate(() =>
    window.sessionStorage.setItem(
      'mapless-kept-parameters',
      JSON.stringify({
        'set A': { preset: 'default', learning: 'fixed', overrides: { robot: { max_speed_m_s: -3 } } },
      }),
    ),
  );
  await page.reload();
  await loaded(page);
  await openLab(page, 'Compare');
  await tab(page)
    .getByRole('checkbox', { name: /^Direct/ })
    .check();
  await box(page, 'A').check();
  await expect(tab(page).getByRole('alert').first()).toContainText('A: ');
  await expect(tab(page).getByRole('alert').first()).toContainText('robot.max_speed_m_s = -3');
  await expect(cell(page, 'Time', 1)).not.toHaveText('–');
});
