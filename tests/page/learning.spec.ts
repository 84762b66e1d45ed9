/** Learned hyperparameters: what they do to a drive, and the sign that a tick takes long. */

import { DEVICES } from './axe.ts';
import { driveTo, expect, openLab, state, still, test, until } from './page.ts';

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);

    test('two presses show what learned hyperparameters do to a drive, beside a ghost with fixed ones', async ({
      mapless: page,
    }) => {
      const press = device === 'phone' ? 'tap' : 'click';
      // What is learned depends on the scan: with that of other moments it arrives all the same.
      await driveTo(page, 60);
      await page.evaluate(() => window.mapless?.seek(60));
      await still(page);
      await page.getByRole('button', { name: 'By hand' })[press]();
      await page.getByRole('button', { name: 'Learned…' })[press]();
      await until(page, (now) => now.thought === 'what_if');
      const climb = page.locator('.method-climb');
      await expect(climb).toContainText('Step');
      if (device === 'phone') {
        // Steps and image are in sight at once, under the view.
        const boxOf = async (part: string) => {
          const { y = Number.NaN, height = Number.NaN } = (await page.locator(part).boundingBox()) ?? {};
          return { top: y, bottom: y + height };
        };
        await expect.poll(async () => (await boxOf('.method-climb')).bottom).toBeLessThanOrEqual(844);
        expect((await boxOf('#seen-scroll')).top).toBeGreaterThan((await boxOf('#view')).bottom - 1);
      }
      await climb.getByRole('button', { name: 'Drive with these' })[press]();
      await until(page, (now) => now.outcome !== 'running');
      expect(await state(page)).toMatchObject({ outcome: 'no_subgoal', thought: 'run' });
      await expect(page.locator('#outcome')).toHaveText('Perception failed');
      await expect(page.locator('#reason')).toContainText('The Gaussian process has no solution for this scan');
      await openLab(page, 'Compare', press);
      await expect(page.getByRole('checkbox', { name: /^Fixed/ })).toBeChecked();
      const outcome = page.getByRole('row', { name: /^Outcome/ }).locator('td');
      if (device !== 'phone') {
        await expect(outcome.last()).toHaveText('Goal reached');
        return;
      }
      // No button of the camera is under the drawer.
      const drawer = await page.locator('.lab').boundingBox();
      await page.evaluate(() => window.scrollTo(0, 0));
      for (const button of await page.locator('.camera .round').all()) {
        const box = await button.boundingBox();
        expect((box?.y ?? 0) + (box?.height ?? 0)).toBeLessThanOrEqual(drawer?.y ?? 0);
      }
    });
  });
}

test('while a tick learns for long, a sign says so; it goes when the tick is done', async ({ mapless: page }) => {
  const sign = page.locator('#computing');
  await expect(sign).toBeHidden();
  // Fewer evaluations than there are by default, from the first tick on: this takes some seconds.
  const fewer = { planner: { perception: { learning: { evaluations_per_scan: 2 } } } };
  await page.evaluate(async (overrides) => {
    await window.mapless?.pause();
    const own = window.mapless?.experiment();
    await window.mapless?.openExperiment({ ...own, preset: 'paper', learning: 'every_scan', overrides });
  }, fewer);
  await page.evaluate(() => window.mapless?.play());
  await expect(sign).toBeVisible();
  await expect(sign).toHaveText(/^Learning hyperparameters, tick \d+( …|, \d+\ss)$/);
  await page.evaluate(() => window.mapless?.pause());
  await expect(sign).toBeHidden();
  expect((await state(page)).tick).toBeGreaterThan(0);
});
