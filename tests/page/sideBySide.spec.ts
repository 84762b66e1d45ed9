/** What stands beside each other in windows with little room: tools, drawer, large image and what is by hand. */

import type { Page } from '@playwright/test';
import { expect, openLab, still, test } from './page.ts';

/** Tools that cannot be seen whole, or that another control lies over. */
function hiddenTools(page: Page): Promise<string[]> {
  return page.evaluate(() =>
    [...document.querySelectorAll('.tools .tool')].flatMap((tool) => {
      const { left, top, width, height } = tool.getBoundingClientRect();
      const corners = [
        [left + 3, top + 3],
        [left + width - 3, top + height - 3],
      ];
      const seen = corners.every(([x = 0, y = 0]) => tool.contains(document.elementFromPoint(x, y)));
      return seen ? [] : [tool.textContent?.trim() ?? ''];
    }),
  );
}

/** How far the image reaches under the drawer, in pixels. */
async function overlap(page: Page): Promise<number> {
  const [image, drawer] = await Promise.all([
    page.locator('#variance').boundingBox(),
    page.locator('.lab').boundingBox(),
  ]);
  if (!image || !drawer) throw new Error('Image or drawer is not shown.');
  return image.x + image.width - drawer.x;
}

const hand = (page: Page) => page.getByRole('button', { name: 'By hand' });
const enlarge = (page: Page) => page.locator('#enlarge');
const app = (page: Page) => page.locator('.app');

test('every tool is in sight in windows of three sizes, and the drawer stands beside the large image', async ({
  mapless: page,
}) => {
  for (const [width, height] of [
    [1440, 900],
    [1280, 720],
    [1120, 760],
  ] as const) {
    await test.step(`${width} × ${height}`, async () => {
      await page.setViewportSize({ width, height });
      await still(page);
      expect(await hiddenTools(page)).toEqual([]);
      await enlarge(page).click();
      await expect(app(page)).toHaveAttribute('data-image', 'large');
      expect(await hiddenTools(page)).toEqual([]);
      await openLab(page, 'Parameters');
      expect(await overlap(page)).toBeLessThanOrEqual(0);
      expect(await hiddenTools(page)).toEqual([]);
      // Its own button is not under the drawer, nor the threshold's handle, which the largest images have.
      if (width >= 1280) await page.locator('.threshold-handle').click({ trial: true });
      await enlarge(page).click({ trial: true });
      await hand(page).click();
      await expect(page.locator('.method')).toBeVisible();
      expect(await overlap(page)).toBeLessThanOrEqual(0);
      expect(await hiddenTools(page)).toEqual([]);
      await page.getByRole('slider', { name: 'V_th' }).last().click({ trial: true });
      await page.locator('.lab-close').click();
      expect(await hiddenTools(page)).toEqual([]);
      await page.locator('.slice-canvas').first().click({ trial: true });
      // As it was before, for the next size.
      await hand(page).click();
      await enlarge(page).click();
      await expect(app(page)).toHaveAttribute('data-image', 'small');
    });
  }
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('a tap closes what is by hand, with the image as it was', async ({ mapless: page }) => {
    await hand(page).tap();
    await expect(app(page)).toHaveAttribute('data-image', 'large');
    await hand(page).tap();
    await expect(app(page)).toHaveAttribute('data-image', 'small');
  });
});
