import type { Page } from '@playwright/test';
import { changeFirstCore, expect, loaded, state, test, trapAfterStart, until } from './page.ts';

// A small view leaves a processor without graphics card its time.
test.use({ viewport: { width: 720, height: 560 } });

test('a panic loses neither the ground, the start nor the goal', async ({ page }) => {
  const served = await trapAfterStart(page);
  await page.goto('/');
  await loaded(page);
  await page.evaluate(() => window.mapless?.pause());
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 9 }));
  const { start } = await state(page);
  const place = { x: start.x + 6, y: start.y + 1 };
  const height = () => page.evaluate((at) => window.mapless?.heightAt(at) ?? Number.NaN, place);
  const before = await height();
  const points_cm = [100 * place.x, 100 * place.y].map(Math.round);
  const stroke = { kind: 'raise', radius_m: 2, strength_m: 0.5, points_cm } as const;
  await page.evaluate((one) => window.mapless?.sculpt(one), stroke);
  await page.evaluate((at) => window.mapless?.setGoal(at), place);
  const moved = { x: start.x + 1, y: start.y, heading_rad: 1 };
  await page.evaluate((at) => window.mapless?.setStart(at), moved);
  const raised = await height();
  expect(raised).toBeGreaterThan(before + 0.2);
  await page.getByRole('button', { name: 'Play' }).click();
  await expect(page.locator('#notice-text')).toContainText('with your ground, start and goal');
  await expect.poll(served).toBe(2);
  await until(page, (now) => now.tick === 0);
  await expect.poll(height).toBe(raised);
  expect(await state(page)).toMatchObject({
    scenario: 'ht',
    seed: 9,
    tick: 0,
    playing: false,
    start: moved,
    goal: place,
  });
  await page.getByRole('button', { name: 'Play' }).click();
  await until(page, ({ tick }) => tick > 3);
});

test('after a panic the process by hand has the true skyline again', async ({ page }) => {
  await trapAfterStart(page);
  await page.goto('/');
  await loaded(page);
  await page.evaluate(() => window.mapless?.pause());
  const { start } = await state(page);
  await page.evaluate((at) => window.mapless?.setStart(at), start);
  await page.getByRole('button', { name: 'By hand' }).click();
  await expect(page.locator('.method')).toBeVisible();
  await page.getByRole('button', { name: 'Play' }).click();
  await expect(page.locator('#notice-text')).toContainText('with your ground, start and goal');
  await until(page, (now) => now.tick === 0);
  await page.getByRole('button', { name: 'Play' }).click();
  await until(page, ({ tick }) => tick > 3);
  await page.evaluate(() => window.mapless?.pause());
  await expect(page.locator('.method-error')).toContainText('Off the true skyline by');
});

/** The first worker's core never comes to an end with an experiment of other parameters. */
async function slowCore(page: Page): Promise<void> {
  await changeFirstCore(page, (script) =>
    script.replace(
      /\bconstructor\((\w+)\)\s*\{(?=[^}]*session_new)/,
      'constructor($1){if(Object.keys($1.overrides??{}).length>0)for(;;);',
    ),
  );
}

test('what takes long to open can be stopped, and the last experiment comes back', async ({ page }) => {
  await slowCore(page);
  await page.goto('/');
  await loaded(page);
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 9 }));
  const { start } = await state(page);
  const place = { x: start.x + 6, y: start.y + 1 };
  await page.evaluate((at) => window.mapless?.setGoal(at), place);
  const experiment = await page.evaluate(() => window.mapless?.experiment());
  const opening = page.evaluate(
    (other) => window.mapless?.openExperiment(other).catch((error: Error) => error.message),
    { ...experiment, name: 'slow', overrides: { sensor: { range_noise_m: 0.1 } } },
  );
  await expect(page.locator('#notice-text')).toContainText('Opening this takes long');
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
  expect(await opening).toContain('stopped');
  await until(page, (now) => now.tick === 0 && !now.playing);
  expect(await state(page)).toMatchObject({ scenario: 'ht', seed: 9, goal: place });
  expect(await page.evaluate(() => window.mapless?.experiment())).toEqual(experiment);
  await page.getByRole('button', { name: 'Play' }).click();
  await until(page, ({ tick }) => tick > 3);
});

test('a link that takes long to open can be stopped, and the page begins without it', async ({ page }) => {
  await page.goto('/');
  await loaded(page);
  await page.evaluate(() => window.mapless?.loadScenario('ml'));
  await page.evaluate(() => window.mapless?.setOverrides({ sensor: { range_noise_m: 0.1 } }));
  const link = await page.evaluate(() => window.mapless?.link());
  await slowCore(page);
  await page.goto('about:blank');
  await page.goto(link ?? '');
  await expect(page.locator('#notice-text')).toContainText('Opening this takes long');
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
  await loaded(page);
  await expect(page.locator('#notice-text')).toContainText('Opening it was stopped');
  await until(page, ({ tick }) => tick > 3);
});

test('a core that cannot start is no endless loop, and says so', async ({ page }) => {
  await page.route('**/simulationWorker-*.js', (route) =>
    route.fulfill({ contentType: 'text/javascript', body: 'throw 1' }),
  );
  await page.goto('/');
  await expect(page.locator('#notice-text')).toContainText('reload the page');
});

test('a hidden tab rests, and goes on where it was', async ({ mapless: page }) => {
  await until(page, ({ tick }) => tick > 2);
  const hide = (hidden: boolean) =>
    page.evaluate((value) => {
      Object.defineProperty(document, 'hidden', { value, configurable: true });
      document.dispatchEvent(new Event('visibilitychange'));
    }, hidden);
  await hide(true);
  // The worker carries one thing out after the other: now it knows that the tab is hidden.
  await page.evaluate(() => window.mapless?.setSpeed(1));
  const { tick } = await state(page);
  // It answers for as long as 25 ticks would take, and makes none of them.
  await page.evaluate(async () => {
    const end_ms = performance.now() + 2500;
    while (performance.now() < end_ms) await window.mapless?.setSpeed(1);
  });
  expect((await state(page)).tick).toBe(tick);
  const began_ms = await page.evaluate(() => performance.now());
  await hide(false);
  const next = await page.waitForFunction((last) => {
    const now = window.mapless?.state();
    return now && now.tick > last ? { tick: now.tick, playing: now.playing, now_ms: performance.now() } : undefined;
  }, tick);
  const now = (await next.jsonValue()) ?? { tick: 0, playing: false, now_ms: 0 };
  expect(now.playing).toBe(true);
  // It does not catch up on the time that nobody saw, but for a quarter of a second at most.
  expect(now.tick - tick).toBeLessThanOrEqual((now.now_ms - began_ms) / 100 + 3);
});

test('an unexpected error is shown', async ({ page }) => {
  await page.goto('/');
  await loaded(page);
  await page.evaluate(() => {
    setTimeout(() => {
      throw new Error('a test went wrong');
    });
  });
  await expect(page.locator('#notice-text')).toContainText('a test went wrong');
});

test('nothing on the page breaks its own policy', async ({ page }) => {
  await page.addInitScript(() => {
    const broken: string[] = [];
    Object.assign(window, { broken });
    document.addEventListener('securitypolicyviolation', (event) => {
      broken.push(`${event.violatedDirective}: ${event.blockedURI} ${event.sample}`);
    });
  });
  await page.goto('/');
  await loaded(page);
  for (const button of ['How it works, and keys', 'Enlarge the plots', 'Terrains', 'Share and save']) {
    await page.getByRole('button', { name: button }).click();
    await expect(page.locator('dialog[open]')).toBeVisible();
    await page.keyboard.press('Escape');
    await expect(page.locator('dialog[open]')).toBeHidden();
  }
  for (const id of ['save-csv', 'save-mcap', 'save-plots', 'save-picture']) {
    const waiting = page.waitForEvent('download');
    await page.locator(`#${id}`).click();
    await waiting;
  }
  await until(page, ({ tick }) => tick > 5);
  expect(await page.evaluate(() => (window as unknown as { broken: string[] }).broken)).toEqual([]);
});
