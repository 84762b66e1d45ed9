import type { Page } from '@playwright/test';
import type { MaplessState } from '../../web/src/app/windowApi.ts';
import { wrap } from '../../web/src/base/format.ts';
import { driveTo, expect, moved, shortCourse, state, still, test, until } from './page.ts';

/** Of the ground above height zero, in cubic metres. */
function volume(page: Page): Promise<number> {
  return page.evaluate(() => {
    const { columns = 0, rows = 0, cell_m = 1 } = window.mapless?.state()?.ground ?? {};
    let sum_m = 0;
    for (let row = 0; row < rows; row += 1) {
      for (let column = 0; column < columns; column += 1) {
        sum_m += window.mapless?.heightAt({ x: column * cell_m, y: row * cell_m }) ?? 0;
      }
    }
    return sum_m * cell_m * cell_m;
  });
}

test('a stroke of the brush raises the ground, and the next scan shows it', async ({ mapless: page }) => {
  await still(page);
  // Only handles leave the page: tens of thousands of numbers would take long to hand over and back.
  const before = await page.evaluateHandle(() => window.mapless?.scan() ?? new Float32Array());
  await page.keyboard.press('4');
  await expect(page.locator('#brush')).toBeVisible();
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('The view has no place.');
  // The view follows the robot: above its centre lies the ground ahead.
  const [x, y] = [box.x + box.width / 2, box.y + 0.36 * box.height];
  const level_m3 = await volume(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await expect(async () => {
    for (let step = 0; step < 12; step += 1) await page.mouse.move(x + 4 * step, y);
    expect((await volume(page)) - level_m3).toBeGreaterThan(3);
  }).toPass();
  await page.mouse.up();
  await expect.poll(() => page.evaluate(() => window.mapless?.experiment()?.strokes.length)).toBe(1);
  await still(page);
  const after = await page.evaluate(() => window.mapless?.state()?.returns);
  expect(after).toBeGreaterThan(1000);
  const changed = await page.evaluate((old) => {
    const scan = window.mapless?.scan() ?? new Float32Array();
    let moved = 0;
    for (let at = 2; at < Math.min(scan.length, old.length); at += 3) {
      if (Math.abs((scan[at] ?? 0) - (old[at] ?? 0)) > 0.1) moved += 1;
    }
    return moved;
  }, before);
  expect(changed).toBeGreaterThan(20);
});

test('raise, lower and smooth do what they say, where they say it, while the robot drives', async ({
  mapless: page,
}) => {
  const { pose } = await state(page);
  const place = { x: pose.x + 9 * Math.cos(pose.yaw), y: pose.y + 9 * Math.sin(pose.yaw) };
  const height = () => page.evaluate((at) => window.mapless?.heightAt(at) ?? Number.NaN, place);
  const dab = (kind: 'raise' | 'lower' | 'smooth', strength_m: number) =>
    page.evaluate((stroke) => window.mapless?.sculpt(stroke), {
      kind,
      radius_m: 1.5,
      strength_m,
      points_cm: [Math.round(100 * place.x), Math.round(100 * place.y)],
    });
  const level = await height();
  await dab('raise', 0.8);
  const raised = await height();
  expect(raised - level).toBeCloseTo(0.8, 1);
  for (let round = 0; round < 5; round += 1) await dab('smooth', 0.1);
  const smoothed = await height();
  expect(smoothed).toBeLessThan(raised);
  await dab('lower', 0.5);
  expect((await height()) - smoothed).toBeCloseTo(-0.5, 1);
  const { tick } = await state(page);
  await until(page, (now) => now.tick > tick + 3);
});

test('a click sets the goal, and a drag the start with its heading', async ({ mapless: page }) => {
  // The robot turns first, and the camera after it: what is still must not move with the next click.
  await driveTo(page, 12);
  const old = await state(page);
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('The view has no place.');
  const [x, y] = [box.x + 0.55 * box.width, box.y + 0.45 * box.height];
  await page.getByRole('radio', { name: 'Goal' }).check();
  await page.mouse.click(x, y);
  await until(page, (now) => moved(now.goal, old.goal));
  await still(page);
  const { goal, tick } = await state(page);
  expect(tick).toBe(old.tick);
  await page.getByRole('radio', { name: 'Start' }).check();
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 160, y, { steps: 4 });
  await page.mouse.up();
  await until(page, (now) => moved(now.start, old.start));
  await still(page);
  const now = await state(page);
  expect(Math.hypot(now.start.x - goal.x, now.start.y - goal.y)).toBeLessThan(0.03);
  expect(Math.hypot(now.pose.x - now.start.x, now.pose.y - now.start.y)).toBeLessThan(0.1);
  expect(now.tick).toBe(0);
});

test('the robot ends with the heading of its goal, and turns to another one there', async ({ mapless: page }) => {
  await shortCourse(page, 3);
  const { pose, goal } = await state(page);
  const off = (now: MaplessState, to_rad: number) => Math.abs(wrap(now.pose.yaw - to_rad));
  for (const turn of [2, -1]) {
    const heading_rad = pose.yaw + turn;
    await page.evaluate((place) => window.mapless?.setGoal(place), { x: goal.x, y: goal.y, heading_rad });
    await page.evaluate(() => window.mapless?.play());
    await until(page, (now) => now.outcome === 'reached' && off(now, heading_rad) < 0.1);
  }
});

test('a goal off the terrain is refused in words', async ({ mapless: page }) => {
  const old = await state(page);
  const refusal = await page.evaluate(() => window.mapless?.setGoal({ x: -5, y: 3 }).catch((error) => error.message));
  expect(refusal).toContain('goal = (-5.000, 3.000)');
  const nowhere = { ...old.goal, heading_rad: Number.NaN };
  expect(await page.evaluate((to) => window.mapless?.setGoal(to).catch((error) => error.message), nowhere)).toContain(
    'goal.heading_rad = NaN',
  );
  expect((await state(page)).goal).toEqual(old.goal);
});

test('a press beside the ground says so, and the next one on it works', async ({ mapless: page }) => {
  await page.keyboard.press('o');
  await page.keyboard.press('2');
  await still(page);
  const old = await state(page);
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('The view has no place.');
  const hint = page.locator('#tool-hint');
  await page.mouse.click(box.x + 0.93 * box.width, box.y + 0.5 * box.height);
  await expect(hint).toHaveText('There is no ground: press the terrain');
  await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await until(page, (now) => moved(now.goal, old.goal));
  await expect(hint).toHaveText('Press for the goal, drag for a final heading');
});

test('a run that has ended stands still under a brush, gives no advice on the mount, and goes on by Play', async ({
  mapless: page,
}) => {
  await page.evaluate(() => window.mapless?.pause());
  await page.evaluate(() => window.mapless?.restart());
  const { start } = await state(page);
  const beside = (left_m: number) => [
    Math.round(100 * (start.x - left_m * Math.sin(start.heading_rad))),
    Math.round(100 * (start.y + left_m * Math.cos(start.heading_rad))),
  ];
  // One side of the robot stands on a steep hill.
  await page.evaluate(
    (points_cm) => window.mapless?.sculpt({ kind: 'raise', radius_m: 3, strength_m: 3, points_cm }),
    [...beside(1.5)],
  );
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome !== 'running');
  const ended = await state(page);
  expect(ended.outcome).toBe('tilt_limit');
  expect(ended.mountMisfit).toBeDefined();
  await expect(page.locator('#notice')).toBeHidden();
  await page.evaluate(
    (points_cm) => window.mapless?.sculpt({ kind: 'lower', radius_m: 3, strength_m: 3, points_cm }),
    [...beside(1.5)],
  );
  // Two ticks would have come by now.
  await page.waitForTimeout(300);
  expect(await state(page)).toMatchObject({ tick: ended.tick, playing: false, metrics: ended.metrics });
  await page.getByRole('button', { name: 'Play' }).click();
  await until(page, (now) => now.tick > ended.tick);
});
