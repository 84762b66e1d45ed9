import { expect, test } from '@playwright/test';

test('docs/page.png', async ({ page }) => {
  await page.goto('/');
  // Far enough for hills around it and a path behind it.
  await expect
    .poll(() => page.evaluate(() => window.mapless?.state()?.tick ?? 0), { timeout: 90_000 })
    .toBeGreaterThan(220);
  await page.screenshot({ path: 'docs/page.png' });
});

test('docs/page-thinking.png', async ({ page }) => {
  await page.goto('/');
  await expect
    .poll(() => page.evaluate(() => window.mapless?.state()?.tick ?? 0), { timeout: 90_000 })
    .toBeGreaterThan(150);
  await page.evaluate(() => window.mapless?.pause());
  await page.keyboard.press('x');
  const layers = page.locator('#layers');
  for (const name of [/Observed/, /Variance/, /Segments/]) await layers.getByRole('checkbox', { name }).check();
  await page.keyboard.press('Escape');
  await page.locator('.candidate').nth(1).click();
  await page.evaluate(() => window.mapless?.still());
  await page.screenshot({ path: 'docs/page-thinking.png' });
});
