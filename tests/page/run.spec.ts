import type { Page } from '@playwright/test';
import { drawnIn, expect, state, still, test, textsOf, until } from './page.ts';

test('opens running: the robot moves without a click, and both views show it', async ({ mapless: page }) => {
  const { pose } = await state(page);
  await until(page, (now) => now.tick >= 15 && Math.hypot(now.pose.x - pose.x, now.pose.y - pose.y) > 0.3);
  await expect(page.locator('#outcome')).toHaveText('Driving');
  await expect(page.locator('#reason')).not.toBeEmpty();
  await drawnIn(page, '#view', 500);
  await drawnIn(page, '#variance', 50);
});

test('reaches a goal, says so, and stays there', async ({ mapless: page }) => {
  await still(page);
  const { pose } = await state(page);
  const goal = { x: pose.x + 3 * Math.cos(pose.yaw), y: pose.y + 3 * Math.sin(pose.yaw) };
  await page.evaluate((place) => window.mapless?.setGoal(place), goal);
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome === 'reached');
  await expect(page.locator('#result')).toBeVisible();
  await expect(page.locator('#result-words')).toHaveText('Goal reached');
  await expect(page.locator('#announcement')).toContainText('Goal reached');
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible();
  const { pose: end, metrics } = await state(page);
  expect(Math.hypot(end.x - goal.x, end.y - goal.y)).toBeLessThan(1);
  expect(metrics.distance_m).toBeGreaterThan(1.5);
});

/** Has the worker drive at another speed without a touch of the page, as which even setting the speed there counts. */
async function setPace(page: Page, speed: number): Promise<void> {
  const worker = page.workers().find((one) => one.url().includes('simulationWorker'));
  if (!worker) throw new Error('No worker simulates.');
  await worker.evaluate((wanted) => {
    const data = { type: 'request', id: -1, command: { type: 'speed', speed: wanted } };
    self.dispatchEvent(new MessageEvent('message', { data }));
  }, speed);
}

test('goes on to the next scenario when nobody touches the page', async ({ mapless: page }) => {
  const { scenario } = await state(page);
  const [results, countdown] = [await textsOf(page, '#result-words'), await textsOf(page, '#countdown')];
  await setPace(page, Number.POSITIVE_INFINITY);
  await until(page, (now) => now.outcome === 'reached');
  // The next scenario is not to end before it is seen.
  await setPace(page, 1);
  await until(page, (now) => now.scenario !== scenario && now.playing && now.tick > 0);
  expect(await results()).toContain('Goal reached');
  expect((await countdown()).filter((text) => text !== '')[0]).toMatch(/^in \d+ s$/);
  await expect(page.locator('#result')).toBeHidden();
});

test('steps, restarts and repeats itself bit by bit', async ({ mapless: page }) => {
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.evaluate(() => window.mapless?.restart());
  expect((await state(page)).tick).toBe(0);
  for (let tick = 1; tick <= 3; tick += 1) {
    await page.getByRole('button', { name: 'One tick' }).click();
    await until(page, (now) => now.tick === tick);
  }
  const { digest } = await state(page);
  await page.evaluate(() => window.mapless?.restart());
  for (let tick = 1; tick <= 3; tick += 1) await page.evaluate(() => window.mapless?.step());
  expect((await state(page)).digest).toBe(digest);
});

test('goes faster and slower', async ({ mapless: page }) => {
  /** Milliseconds that three seconds of the run take. */
  const took_ms = async () => {
    const { tick } = await state(page);
    const began_ms = performance.now();
    await until(page, (now) => now.tick >= tick + 30);
    return performance.now() - began_ms;
  };
  await page.getByRole('radio', { name: '½×' }).check();
  await until(page, (now) => now.speed === 0.5);
  const slow_ms = await took_ms();
  await page.getByRole('radio', { name: 'max' }).check();
  await until(page, (now) => now.speed > 4);
  // Slower machines take longer, none less than six seconds but for what was under way.
  expect(slow_ms).toBeGreaterThan(4500);
  expect(await took_ms()).toBeLessThan(slow_ms);
});

test('another scenario, planner and seed are loaded from the bar', async ({ mapless: page }) => {
  await page.locator('#scenario').selectOption('ht');
  await until(page, (now) => now.scenario === 'ht' && now.playing);
  await page.locator('#preset').selectOption('paper');
  await until(page, (now) => now.preset === 'paper');
  await page.locator('#learning').selectOption('once');
  await until(page, (now) => now.learning === 'once' && now.preset === 'paper' && now.tick > 0);
  await page.locator('#seed').fill('42');
  await page.locator('#seed').press('Enter');
  await until(page, (now) => now.seed === 42 && now.scenario === 'ht' && now.preset === 'paper');
});

test('zoomed all the way in or out, the view comes to rest wherever it is turned', async ({ mapless: page }) => {
  await page.locator('#view').focus();
  await page.locator('#view').hover();
  for (const zoom of [-240, 240]) {
    for (let wheel = 0; wheel < 40; wheel++) await page.mouse.wheel(0, zoom);
    for (let turn = 0; turn < 8; turn++) {
      await page.keyboard.press('ArrowLeft');
      // Resolves once nothing in the view moves.
      await still(page);
    }
  }
});
