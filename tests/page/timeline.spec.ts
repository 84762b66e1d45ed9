import type { Page } from '@playwright/test';
import { tidyPlace } from '../../web/src/experiment/experiment.ts';
import { expect, state, still, test, until } from './page.ts';

/** Restarts with a goal some metres ahead and drives there as fast as it goes; gives the last tick and the digest. */
async function driveAhead(page: Page, ahead_m: number): Promise<{ tick: number; digest: string }> {
  await page.evaluate(() => window.mapless?.pause());
  await page.evaluate(() => window.mapless?.restart());
  const { pose } = await state(page);
  const goal = { x: pose.x + ahead_m * Math.cos(pose.yaw), y: pose.y + ahead_m * Math.sin(pose.yaw) };
  await page.evaluate((place) => window.mapless?.setGoal(place), goal);
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome === 'reached');
  return state(page);
}

test('going back and on gives the digest of an uninterrupted run', async ({ mapless: page }) => {
  const { tick, digest } = await driveAhead(page, 5);
  expect(tick).toBeGreaterThan(40);
  for (const target of [Math.round(tick / 2), 7, tick - 3]) {
    await page.evaluate((to) => window.mapless?.seek(to), target);
    const there = await state(page);
    expect({ tick: there.tick, playing: there.playing, outcome: there.outcome }).toEqual({
      tick: target,
      playing: false,
      outcome: 'running',
    });
    expect(there.timeline).toEqual({ first: 0, end: tick, changes: [] });
  }
  await page.evaluate(() => window.mapless?.seek(11));
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome === 'reached');
  expect(await state(page)).toMatchObject({ tick, digest });
});

test('the slider goes along the run by keyboard, and buttons and keys too', async ({ mapless: page }) => {
  await until(page, (now) => now.tick >= 60);
  const slider = page.getByRole('slider', { name: 'Time of the run' });
  await slider.press('Home');
  await until(page, (now) => now.tick === 0 && !now.playing);
  await expect(slider).toHaveAttribute('aria-valuetext', /^0:00\.0 of 0:0\d\.\d$/);
  await slider.press('ArrowRight');
  await until(page, (now) => now.tick === 1);
  const { timeline } = await state(page);
  await page.getByRole('button', { name: 'Go to the end' }).click();
  await until(page, (now) => now.tick === timeline.end);
  await expect(page.getByRole('button', { name: 'Go to the end' })).toBeHidden();
  await page.keyboard.press('j');
  await until(page, (now) => now.tick === timeline.end - 50);
  await page.keyboard.press('k');
  await until(page, (now) => now.tick === timeline.end);
});

test('another goal in the past begins another future, and before it the old goal is back', async ({
  mapless: page,
}) => {
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await until(page, (now) => now.tick >= 45);
  const { goal, pose } = await state(page);
  await page.evaluate(() => window.mapless?.seek(30));
  expect((await state(page)).timeline.end).toBeGreaterThanOrEqual(45);
  const other = tidyPlace({ x: pose.x + 4, y: pose.y + 2 });
  await page.evaluate((place) => window.mapless?.setGoal(place), other);
  expect((await state(page)).timeline).toEqual({ first: 0, end: 30, changes: [30] });
  for (let ticks = 0; ticks < 4; ticks += 1) await page.evaluate(() => window.mapless?.step());
  const branch = await state(page);
  expect(branch).toMatchObject({ tick: 34, goal: other });
  await page.evaluate(() => window.mapless?.seek(20));
  await until(page, (now) => now.goal.x === goal.x && now.goal.y === goal.y);
  // Played again, what happened happens again: the goal changes where it was changed.
  await page.evaluate(() => window.mapless?.seek(34));
  expect(await state(page)).toMatchObject({ digest: branch.digest, goal: other });
  // What begins anew has the route of the experiment, wherever the timeline stands.
  await page.evaluate(() => window.mapless?.seek(20));
  await page.evaluate(() => window.mapless?.restart());
  expect(await state(page)).toMatchObject({ tick: 0, goal: other, disturbed: false });
});

test('waypoints are driven to in order, and cleared again', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.pause());
  await page.evaluate(() => window.mapless?.restart());
  const { pose } = await state(page);
  const at = (ahead_m: number, left_m: number) =>
    tidyPlace({
      x: pose.x + ahead_m * Math.cos(pose.yaw) - left_m * Math.sin(pose.yaw),
      y: pose.y + ahead_m * Math.sin(pose.yaw) + left_m * Math.cos(pose.yaw),
    });
  const route = [at(3, 0), at(4.5, 1.5)];
  const [waypoint, goal] = route;
  await page.evaluate(([first, last]) => first && last && window.mapless?.setGoal(last, [first]), [waypoint, goal]);
  expect(await state(page)).toMatchObject({ waypoints: [waypoint], goal, waypointsPassed: 0 });
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.waypointsPassed === 1);
  await until(page, (now) => now.outcome === 'reached');

  await page.evaluate(() => window.mapless?.pause());
  await page.evaluate(() => window.mapless?.restart());
  await page.getByRole('radio', { name: 'Goal' }).check();
  await page.getByLabel('Add waypoints').check();
  await still(page);
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('The view has no size.');
  await expect(page.locator('#tool-hint')).toContainText('each waypoint before the goal');
  const before = await state(page);
  // Two presses, the second before the first is carried out: waypoints, in their order, before the same goal.
  await page.mouse.click(box.x + 0.55 * box.width, box.y + 0.55 * box.height);
  await page.mouse.click(box.x + 0.45 * box.width, box.y + 0.6 * box.height);
  await until(page, (now) => now.waypoints.length === 3);
  const after = await state(page);
  expect(after.goal).toEqual(before.goal);
  expect(after.waypoints[0]).toEqual(waypoint);
  // In the view's chase camera what is farther to the left of the picture is farther to the robot's left.
  const left = ({ x = 0, y = 0 } = {}) => -Math.sin(pose.yaw) * (x - pose.x) + Math.cos(pose.yaw) * (y - pose.y);
  expect(left(after.waypoints[2])).toBeGreaterThan(left(after.waypoints[1]));
  await page.getByRole('button', { name: 'Clear waypoints' }).click();
  await until(page, (now) => now.waypoints.length === 0);
});
