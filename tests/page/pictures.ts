import { expect, test } from '@playwright/test';

test('docs/page.png', async ({ page }) => {
  await page.goto('/');
  // Far enough for hills around it and a path behind it.
  await expect
    .poll(() => page.evaluate(() => window.mapless?.state()?.tick ?? 0), { timeout: 90_000 })
    .toBeGreaterThan(220);
  await page.screenshot({ path: 'docs/page.png' });
});
