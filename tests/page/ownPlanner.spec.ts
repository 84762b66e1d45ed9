/** Somebody's own planner drives beside the robot of the page, and whatever is wrong with it harms nothing. */

import { readFileSync } from 'node:fs';
import type { Page } from '@playwright/test';
import { DEVICES, faults } from './axe.ts';
import { expect, file, openLab, shortCourse, state, test, until } from './page.ts';

const tab = (page: Page) => page.getByRole('tabpanel', { name: 'Compare' });
const code = (page: Page) => tab(page).getByLabel('Your planner, in JavaScript');
const cell = (page: Page, row: string, column: number) =>
  tab(page)
    .getByRole('row', { name: new RegExp(`^${row}`) })
    .locator('td')
    .nth(column);
/** The robot in view has the first column. */
const OWN = 1;

async function card(page: Page, press: 'click' | 'tap' = 'click'): Promise<void> {
  await openLab(page, 'Compare', press);
  await tab(page).getByText('Your own planner', { exact: true })[press]();
}

async function drive(page: Page, source: string, press: 'click' | 'tap' = 'click'): Promise<void> {
  await code(page).fill(source);
  await tab(page).getByRole('button', { name: 'Drive it' })[press]();
}

/** Straight at the goal, with a line of its own in each decision. */
const straight = (line: string) => `export default ({ pose, goal, time_s }) => {
  ${line}
  const bearing = Math.atan2(goal.y - pose.y, goal.x - pose.x) - pose.yaw;
  return { linear_m_s: 0.8, angular_rad_s: Math.atan2(Math.sin(bearing), Math.cos(bearing)) };
};`;

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);
    const press = device === 'phone' ? 'tap' : 'click';

    test('the example drives to the goal, by the same metrics', async ({ mapless: page }) => {
      await shortCourse(page, 4);
      await card(page, press);
      await tab(page).getByRole('button', { name: 'Drive it' })[press]();
      await expect(tab(page).getByRole('checkbox', { name: /^Yours/ })).toBeChecked();
      await page.evaluate(() => window.mapless?.play());
      await until(page, (now) => now.outcome === 'reached');
      await expect(cell(page, 'Outcome', OWN)).toHaveText('Goal reached');
      await expect(cell(page, 'Path length', OWN)).toHaveText(/^3\.\d+ \([+-]?\d\.\d+\)$/);
      await expect(tab(page).getByRole('status').last()).toHaveText(/^planner\.js takes \d+\.\d ms for a decision\.$/);
      expect(await faults(page)).toEqual([]);
      await page.screenshot({ path: `test-results/own-planner-${device}.png` });
    });

    test('what is wrong with it is said, and the run goes on', async ({ mapless: page }) => {
      await shortCourse(page, 4);
      await card(page, press);
      const alert = tab(page).locator('.own-planner').getByRole('alert');
      for (const [line, said] of [
        ['if (time_s > 0.35) throw new RangeError("no way");', /^planner\.js at 0\.4 s: RangeError: no way \(line 2\)$/],
        ['return { linear_m_s: 0 / 0, angular_rad_s: 0 };', /at 0\.0 s: linear_m_s = NaN: expected a finite number/],
        ['return { linear_m_s: 1 };', /at 0\.0 s: angular_rad_s = absent: expected a finite number/],
        ['return 7;', /at 0\.0 s: linear_m_s = absent: expected a finite number/],
        ['return { linear_m_s: () => 1, angular_rad_s: 0 };', /at 0\.0 s: DataCloneError/],
        ['for (;;);', /at 0\.0 s: a decision took longer than 5 s: it was stopped/],
      ] as const) {
        await drive(page, straight(line), press);
        await page.evaluate(() => window.mapless?.restart());
        await page.evaluate(() => window.mapless?.play());
        await expect(alert).toHaveText(said);
        await until(page, (now) => now.outcome === 'reached');
        await expect(cell(page, 'Outcome', OWN)).toHaveText('Broke off');
      }
      for (const [source, said] of [
        ['export const planner = 1;', /no default export: expected a class with decide\(\), or a function/],
        ['export default (', /SyntaxError/],
        ['import "https://example.org/planner.js";', /Failed to fetch|TypeError/],
      ] as const) {
        await drive(page, source, press);
        await expect(alert).toHaveText(said);
      }
      // Mended, it drives.
      await drive(page, straight(''), press);
      await expect(alert).toBeHidden();
      await expect(cell(page, 'Outcome', OWN)).toHaveText('Goal reached');
    });
  });
}
