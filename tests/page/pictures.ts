import { expect, type Page, test } from '@playwright/test';
import { loaded, still, until } from './page.ts';

/** Opens the page and stops the robot on its way, for hills around it and a path behind it. */
async function underWay(page: Page, address: string, tick: number): Promise<void> {
  await page.goto(address);
  await loaded(page);
  await until(page, (now) => now.tick > tick);
  await still(page);
}

test('docs/page.png', async ({ page }) => {
  await underWay(page, '/', 220);
  await page.screenshot({ path: 'docs/page.png' });
});

test('docs/page-thinking.png', async ({ page }) => {
  await underWay(page, '/', 150);
  await page.keyboard.press('x');
  const layers = page.locator('#layers');
  for (const name of [/Observed/, /Variance/, /Segments/]) await layers.getByRole('checkbox', { name }).check();
  await page.keyboard.press('Escape');
  await page.locator('.candidate').nth(1).click();
  await still(page);
  await page.screenshot({ path: 'docs/page-thinking.png' });
});

test.describe('in the dark', () => {
  test.use({ colorScheme: 'dark' });

  test('docs/page-dark.png', async ({ page }) => {
    await underWay(page, '/?scenario=gsb', 220);
    await page.locator('#plots').scrollIntoViewIfNeeded();
    await expect(page.locator('.plot-line')).toHaveCount(5);
    await page.screenshot({ path: 'docs/page-dark.png' });
  });
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });

  test('docs/page-phone.png', async ({ page }) => {
    await underWay(page, '/', 220);
    await page.locator('label.tool', { hasText: 'Raise' }).tap();
    await still(page);
    await page.screenshot({ path: 'docs/page-phone.png' });
  });
});
