import { drawnIn, expect, moved, state, test, until } from './page.ts';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });

test('fits a phone: no sideways scrolling, every control in reach of a thumb', async ({ mapless: page }) => {
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(width).toBe(390);
  for (const id of ['scenario', 'preset', 'help', 'play', 'step', 'restart', 'follow', 'overview']) {
    const box = await page.locator(`#${id}`).boundingBox();
    if (!box) throw new Error(`#${id} is not shown.`);
    expect(box.x, id).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width, id).toBeLessThanOrEqual(390);
    expect(box.y + box.height, id).toBeLessThanOrEqual(844);
    expect(Math.min(box.width, box.height), id).toBeGreaterThanOrEqual(40);
  }
  for (const name of ['Look', 'Goal', 'Start', 'Raise', 'Lower', 'Smooth', '½×', 'max']) {
    const box = await page.getByText(name, { exact: true }).first().boundingBox();
    expect(box && box.x >= 0 && box.x + box.width <= 390, name).toBe(true);
  }
  await until(page, (now) => now.tick > 5);
  await drawnIn(page, '#view', 300);
});

test('the measurements scroll under the view', async ({ mapless: page }) => {
  await page.locator('#digest').scrollIntoViewIfNeeded();
  await expect(page.locator('#digest')).toBeInViewport();
  await expect(page.locator('#play')).toBeInViewport();
});

test('a tap with a tool in hand sets the goal', async ({ mapless: page }) => {
  const old = await state(page);
  await page.getByRole('radio', { name: 'Goal' }).check();
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('The view has no place.');
  await page.touchscreen.tap(box.x + 0.5 * box.width, box.y + 0.35 * box.height);
  await until(page, (now) => moved(now.goal, old.goal));
});
