/** A robot's recording in the page: what the robot saw and decided at any moment, and why a file is none. */

import { readFileSync } from 'node:fs';
import type { Page } from '@playwright/test';
import { DEVICES, faults } from './axe.ts';
import { drag, drawnIn, expect, file, misplaced, state, test, within } from './page.ts';

const KEPT = readFileSync('crate/recording/tests/kept/drive.mcap');

const panel = (page: Page) => page.getByRole('region', { name: 'Recording' });
const now = (page: Page) => page.locator('#scrub-now');
const scrub = (page: Page) => page.locator('#scrub');
const close = (page: Page) => page.getByRole('button', { name: 'Close the recording' });

/** Opens a recording and waits until all of it was decided again. */
async function open(page: Page, name: string, content: Buffer): Promise<void> {
  await page.locator('#files').setInputFiles(file(name, content));
  await expect(panel(page)).toContainText('of the decisions differ');
}

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);

    test('a recording opens, is gone along, explains itself and gives the run back', async ({ mapless: page }) => {
      const phone = device === 'phone';
      const press = (name: string) => {
        const button = page.getByRole('button', { name, exact: true });
        return phone ? button.tap() : button.click();
      };
      await page.evaluate(() => window.mapless?.pause());
      const before = await state(page);
      const title = await page.locator('#scene-title').textContent();
      await open(page, 'drive.mcap', KEPT);
      await expect(page.locator('#scrub-end')).toHaveText('0:02.5');
      await expect(panel(page)).toContainText('none of the decisions differ');
      await expect(panel(page)).toContainText('the emergency stop is silent');
      await expect(page.locator('#setup')).toBeHidden();

      // By finger or mouse along the slider.
      const [from, to] = [await within(scrub(page), 0.02, 0.5), await within(scrub(page), 0.7, 0.5)];
      if (phone) await drag(page, [from, to]);
      else {
        await page.mouse.move(from.x, from.y);
        await page.mouse.down();
        await page.mouse.move(to.x, to.y, { steps: 4 });
        await page.mouse.up();
      }
      await expect(now(page)).toHaveText(/^0:01\.[5-9]$/);
      await expect(panel(page)).toContainText('driving');
      await expect(panel(page)).toContainText('decided on');
      await expect(page.locator('#reason')).toContainText(/^(Heads|Straight|The goal)/);
      await expect(page.locator('#candidate-count')).toContainText('candidate');
      await drawnIn(page, '#variance', 20);
      await drawnIn(page, '#view', 20);
      expect(await faults(page)).toEqual([]);
      expect(await misplaced(page, false)).toEqual([]);

      // From scan to scan, which are a tenth of a second apart.
      const there = await now(page).textContent();
      await press('To the next scan');
      await expect(panel(page)).toContainText('0.01 s old');
      await press('To the next scan');
      await expect(now(page)).not.toHaveText(there ?? '');
      await press('To the scan before');
      await expect(now(page)).toHaveText(there ?? '');

      // The emergency stop is pressed at 2.2 s.
      await press('0:02.2 Aborted: the emergency stop is pressed');
      await expect(page.locator('#reason')).toHaveText('Goal given up; the emergency stop is pressed.');

      await press('Close the recording');
      await expect(panel(page)).toHaveCount(0);
      await expect(page.locator('#scene-title')).toHaveText(title ?? '');
      expect(await state(page)).toEqual(before);
      await press('One tick');
      await expect.poll(async () => (await state(page)).tick).toBe(before.tick + 1);
    });
  });
}

test('by keyboard: play to the end, jump, step, arrow keys', async ({ mapless: page }) => {
  await open(page, 'drive.mcap', KEPT);
  await page.locator('#view').focus();
  await page.keyboard.press(' ');
  await expect(page.getByRole('button', { name: 'Pause' })).toBeVisible();
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible({ timeout: 60_000 });
  await expect(now(page)).toHaveText('0:02.5');
  await page.keyboard.press('j');
  await expect(now(page)).toHaveText('0:00.0');
  await page.keyboard.press('s');
  await expect(now(page)).not.toHaveText('0:00.0');
  await page.keyboard.press('k');
  await expect(now(page)).toHaveText('0:02.5');
  await scrub(page).focus();
  await page.keyboard.press('ArrowLeft');
  await expect(now(page)).toHaveText('0:02.4');
  // What changes a run does nothing.
  await page.locator('#view').focus();
  await page.keyboard.press('p');
  await page.keyboard.press('2');
  await expect(page.locator('#view')).toHaveAttribute('data-tool', 'look');
  await close(page).focus();
  await page.keyboard.press('Enter');
  await expect(panel(page)).toHaveCount(0);
});

test('a cut and a broken recording say why and play up to there', async ({ mapless: page }) => {
  await open(page, 'cut.mcap', KEPT.subarray(0, KEPT.length * 0.6));
  await expect(panel(page)).toContainText('The file is cut off: it ends within a record, at 0:01.');
  await page.keyboard.press('k');
  await expect(now(page)).toHaveText(/^0:01\.\d$/);

  const broken = Buffer.from(KEPT);
  const from = Math.floor(KEPT.length * 0.6);
  broken.fill(0xff, from, from + 64);
  await open(page, 'broken.mcap', broken);
  await expect(panel(page)).toContainText('The file cannot be read any further. broken.mcap: after message');
  await page.keyboard.press('k');
  await expect(now(page)).toHaveText(/^0:01\.\d$/);
});

test('what is no recording is refused, and the run stays as it is', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.pause());
  const before = await state(page);
  const text = page.locator('#notice-text');
  await page.locator('#files').setInputFiles(file('notes.mcap', 'no such thing'));
  await expect(text).toContainText('notes.mcap: ');
  await expect(text).toContainText('Expected an MCAP recording of mapless-node or of a robot (rosbag2)');
  expect(await state(page)).toEqual(before);
  await expect(panel(page)).toHaveCount(0);
});

test('opening a scenario closes the recording', async ({ mapless: page }) => {
  await open(page, 'drive.mcap', KEPT);
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await expect(panel(page)).toHaveCount(0);
  await expect(page.locator('#setup')).toBeVisible();
});
