/** A phone in the hand: running, measuring, sharing, and what goes wrong, by taps and fingers. */

import type { Page } from '@playwright/test';
import { clock } from '../../web/src/base/format.ts';
import {
  download,
  drag,
  driveTo,
  elsewhere,
  expect,
  file,
  fits,
  kept,
  loaded,
  moved,
  openLab,
  ownOf,
  press,
  readAndClose,
  shortCourse,
  state,
  still,
  tapIn,
  test,
  textsOf,
  trapAfterStart,
  until,
  within,
} from './page.ts';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

const button = (page: Page, name: string) => page.getByRole('button', { name, exact: true });
const tool = (page: Page, name: string) => page.locator('label.tool', { hasText: name });

test('taps pause, step, set the speed, play and restart', async ({ mapless: page }) => {
  await press(button(page, 'Pause'));
  await expect(page.locator('#outcome')).toHaveText('Paused');
  await still(page);
  const { tick } = await state(page);
  await press(button(page, 'One tick'));
  await expect(page.locator('#time')).toHaveText(clock((tick + 1) / 10));
  await press(page.locator('.speeds label', { hasText: 'max' }));
  await press(button(page, 'Play'));
  await until(page, (now) => now.playing && now.speed > 4 && now.tick > tick + 80);
  await press(page.locator('.speeds label', { hasText: '½×' }));
  const times = await textsOf(page, '#time');
  await press(button(page, 'Restart'));
  await expect.poll(times).toContain('0:00.0');
  await until(page, (now) => now.playing && now.speed === 0.5);
});

test('a finger goes back along the run, and another goal there begins another future', async ({ mapless: page }) => {
  await driveTo(page, 40);
  const { end } = (await state(page)).timeline;
  const [scrub, now] = [page.locator('#scrub'), page.locator('#scrub-now')];
  await drag(page, [await within(scrub, 0.97, 0.5), await within(scrub, 0.5, 0.5)]);
  await until(page, ({ tick }) => Math.abs(tick - end / 2) < 0.05 * end);
  await expect(async () => expect(await now.textContent()).toBe(clock((await state(page)).tick / 10))).toPass();
  await press(button(page, 'Go to the end'));
  await expect(now).toHaveText(clock(end / 10));
  await tapIn(scrub, 0.3, 0.5);
  await until(page, ({ tick }) => Math.abs(tick - 0.3 * end) < 0.1 * end);
  await still(page);
  const there = await state(page);
  await press(tool(page, 'Goal'));
  await tapIn(page.locator('#view'), 0.55, 0.4);
  await until(page, ({ goal }) => moved(goal, there.goal));
  await expect(page.locator('#scrub-end')).toHaveText(clock(there.tick / 10));
  await press(button(page, 'Play'));
  await until(page, ({ tick }) => tick > there.tick + 3);
  expect((await state(page)).timeline.changes).toEqual([there.tick]);
  await expect(page.locator('#scrub-marks line')).toHaveCount(1);
});

test('a goal and a waypoint, set by taps, are driven to', async ({ mapless: page }) => {
  await shortCourse(page, 2);
  await still(page);
  const { goal: old } = await state(page);
  await press(tool(page, 'Goal'));
  await tapIn(page.locator('#view'), 0.5, 0.4);
  await until(page, (now) => moved(now.goal, old));
  const { goal } = await state(page);
  await press(page.locator('label', { hasText: 'Add waypoints' }));
  await expect(page.locator('#tool-hint')).toContainText('each waypoint before the goal');
  await tapIn(page.locator('#view'), 0.5, 0.46);
  await until(page, (now) => now.waypoints.length === 1);
  expect(await state(page)).toMatchObject({ goal, waypointsPassed: 0 });
  await expect(button(page, 'Clear waypoints')).toBeVisible();
  await press(button(page, 'Play'));
  await expect(page.locator('#result-words')).toHaveText('Goal reached');
  expect((await page.locator('#next').boundingBox())?.height, 'a target for a finger').toBeGreaterThanOrEqual(44);
  expect((await state(page)).waypointsPassed).toBe(1);
});

test('a parameter is set in the drawer and reset', async ({ mapless: page }) => {
  await openLab(page, 'Parameters', 'tap');
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill('on unknown');
  const field = page.locator('.parameter:visible');
  await expect(field).toHaveCount(1);
  await fits(field);
  const unknown = field.getByRole('checkbox');
  const before = await unknown.isChecked();
  await unknown.tap();
  await until(page, ({ overrides }) => JSON.stringify(overrides).includes(`"subgoals_on_unknown":${!before}`));
  await expect(page.locator('#lab-count')).toHaveText('1');
  await press(field.getByRole('button', { name: /^Reset/ }));
  await until(page, ({ overrides }) => Object.keys(overrides).length === 0);
  expect(await unknown.isChecked()).toBe(before);
  await expect(page.locator('#lab-count')).toBeHidden();
  await press(page.locator('.lab-close'));
  await expect(page.locator('.lab')).toBeHidden();
});

test('a ghost is chosen: it stands in the view, and its numbers fit beside the robot’s', async ({ mapless: page }) => {
  await driveTo(page, 30);
  const picture = async () => {
    await press(page.locator('.lab-close'));
    await still(page);
    return page.locator('#view').screenshot();
  };
  const direct = page.locator('.rival', { hasText: 'Direct' });
  await openLab(page, 'Compare', 'tap');
  const alone = await picture();
  await openLab(page, 'Compare', 'tap');
  await press(direct);
  const table = page.getByRole('table', { name: 'Metrics, and the difference' });
  const ghost = (name: string) => table.getByRole('row', { name }).getByRole('cell').nth(1);
  // It has caught up.
  await expect(ghost('Time')).toHaveText(clock((await state(page)).time_s));
  await expect(ghost('Distance')).toHaveText(/^\d+\.\d \([−+]?\d+\.\d\)$/);
  await fits(table);
  expect((await picture()).equals(alone)).toBe(false);
  await openLab(page, 'Compare', 'tap');
  await press(direct);
  expect((await picture()).equals(alone)).toBe(true);
});

test('many seeds, cancelled half-way: what they found stays, and one is shown', async ({ mapless: page }) => {
  await shortCourse(page, 3);
  await openLab(page, 'Seeds', 'tap');
  await page.getByLabel('How many').fill('200');
  await press(button(page, 'Run'));
  const rows = page.locator('.trials-table tbody tr');
  await expect(rows.first()).toBeVisible();
  await press(button(page, 'Cancel'));
  await expect(page.getByRole('status').filter({ hasText: /^Cancelled after \d+ of 200/ })).toBeVisible();
  await expect(page.locator('.seeds-summary')).toContainText('Goal reached');
  await fits(page.locator('.seeds-summary:visible, .trials-table:visible'));
  const show = rows.first().getByRole('button');
  const seed = (await show.textContent()) ?? '';
  await press(show);
  await until(page, (now) => String(now.seed) === seed && now.playing);
  await expect(page.locator('#seed')).toHaveValue(seed);
});

test('the plots open, zoom by two fingers, and take the run to where they are tapped', async ({ mapless: page }) => {
  await driveTo(page, 60);
  await press(page.locator('#plots-enlarge'));
  const sheet = page.getByRole('dialog', { name: 'Over time' });
  await fits(sheet);
  await expect(sheet.locator('.plot-line')).toHaveCount(5);
  const [plots, times] = [sheet.getByRole('slider'), () => sheet.locator('.plot-axis text').allTextContents()];
  const whole = await times();
  // Fingers that come while the sheet still moves miss the plots, and come again.
  await expect(async () => {
    const [left, right] = [await within(plots, 0.45, 0.3), await within(plots, 0.55, 0.3)];
    await drag(page, [left, await within(plots, 0.2, 0.3)], [right, await within(plots, 0.9, 0.3)]);
    await expect.poll(times, { timeout: 5000 }).not.toEqual(whole);
  }).toPass({ timeout: 120_000 });
  await press(sheet.getByRole('button', { name: 'Show all of the run' }));
  expect(await times()).toEqual(whole);
  await tapIn(plots, 0.3, 0.5);
  const tick = Math.round(10 * Number(await plots.getAttribute('aria-valuenow')));
  await until(page, (now) => now.tick === tick);
  expect(Math.abs(tick / (await state(page)).timeline.end - 0.25)).toBeLessThan(0.1);
  await press(sheet.getByRole('button', { name: 'Close' }));
  await expect(page.locator('#scrub-now')).toHaveText(clock(tick / 10));
  await expect(page.locator('#scrub')).toHaveValue(String(tick));
});

test('a copied link shows the same experiment on another phone', async ({ mapless: page, browser, baseURL }) => {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 3 }));
  const { x, y } = (await state(page)).start;
  await page.evaluate((goal) => window.mapless?.setGoal(goal, [{ x: goal.x, y: goal.y - 4 }]), { x: x + 6, y: y + 6 });
  await page.evaluate(() => window.mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } }));
  await press(button(page, 'Share and save'));
  await fits(page.locator('#link'));
  await press(button(page, 'Copy link'));
  await expect(page.locator('#share-state')).toHaveText('Copied.');
  const link = await page.evaluate(() => navigator.clipboard.readText());
  const other = await elsewhere(browser, baseURL);
  await other.goto(link);
  await loaded(other);
  expect(await other.evaluate(() => innerWidth)).toBe(390);
  expect(await ownOf(other)).toEqual(await ownOf(page));
  await expect(other.locator('#seed')).toHaveValue('3');
  await expect(other.locator('#lab-count')).toHaveText('1');
  await expect(other.locator('#scene-title')).toHaveText((await page.locator('#scene-title').textContent()) ?? '');
  await other.context().close();
});

test('six metrics stand beside the paper’s; the trajectory and pictures are saved', async ({ mapless: page }) => {
  await driveTo(page, 12);
  const shown = page.locator('#metrics .metric');
  await expect(shown).toHaveText(new Array(6).fill(/\d .*paper \d/));
  await fits(shown);
  const { metrics } = await state(page);
  await expect(shown.first()).toContainText(`${metrics.distance_m.toFixed(1)} m`);
  const csv = (await download(page, 'save-csv', 'tap')).bytes.toString().trim().split('\n');
  // A head, the start, and a line for each tick.
  expect(csv).toHaveLength((await state(page)).tick + 2);
  const { name, bytes } = await download(page, 'save-picture', 'tap');
  expect(name).toMatch(/\.png$/);
  // Every pixel of the screen.
  expect(bytes.readUInt32BE(16)).toBe(await page.evaluate(() => window.innerWidth * window.devicePixelRatio));
  expect(bytes.length).toBeGreaterThan(20_000);
  expect((await download(page, 'save-plots', 'tap')).bytes.toString()).toContain('Curvature');
});

test('a file is opened and driven; a broken one says why and changes nothing', async ({ mapless: page }) => {
  const level = ['ncols 31', 'nrows 31', 'cellsize 1', ...new Array(31).fill('0 '.repeat(31))].join('\n');
  const open = async (name: string, content: string) => {
    await press(button(page, 'Terrains'));
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), press(button(page, 'Open files…'))]);
    await chooser.setFiles(file(name, content));
  };
  await open('level.asc', level);
  await until(page, (now) => now.scenario === 'level' && now.tick > 3);
  await expect(page.locator('#scene-title')).toContainText('level');
  const own = await ownOf(page);
  await open('a-file-with-a-rather-long-name-that-was-cut-short.asc', level.slice(0, 900));
  await readAndClose(page, 'it ends after');
  expect(await ownOf(page)).toEqual(own);
  const { tick } = await state(page);
  await until(page, (now) => now.tick > tick || now.outcome === 'reached');
});

test('a broken link says so, and one’s own work is there', async ({ page }) => {
  await page.goto('/');
  await loaded(page);
  await press(tool(page, 'Goal'));
  const before = await ownOf(page);
  await tapIn(page.locator('#view'), 0.5, 0.35);
  // The robot has its goal a little sooner than the experiment that is kept.
  await expect.poll(() => ownOf(page)).not.toEqual(before);
  const own = await kept(page);
  for (const [link, words] of [
    ['#e=AAAA', 'damaged or was cut short'],
    ['?scenario=hard-1-7', 'expected the name of a generated task'],
  ] as const) {
    await page.goto('about:blank');
    await page.goto(`/${link}`);
    await readAndClose(page, words);
    expect(await ownOf(page)).toEqual(own);
  }
});

test('after a panic the message can be read, and a tap drives from the start that was set', async ({ page }) => {
  await trapAfterStart(page);
  await page.goto('/');
  await loaded(page);
  await press(tool(page, 'Start'));
  const { start } = await state(page);
  await tapIn(page.locator('#view'), 0.5, 0.5);
  await readAndClose(page, 'with your ground, start and goal');
  await until(page, (now) => now.tick === 0 && !now.playing && moved(now.start, start));
  await press(button(page, 'Play'));
  await until(page, (now) => now.tick > 3);
});

test('a finger that holds Raise keeps to where it is; decisions are large enough for it', async ({ mapless: page }) => {
  await still(page);
  await press(tool(page, 'Raise'));
  // Beside the robot, which the view follows when it rises.
  const from = await within(page.locator('#view'), 0.3, 0.5);
  const before = (await ownOf(page))?.strokes.length ?? 0;
  // Small movements of a finger that rests, for as long as a hill needs to grow.
  const session = await page.context().newCDPSession(page);
  const send = (type: 'touchStart' | 'touchMove' | 'touchEnd', dx = 0) =>
    session.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: type === 'touchEnd' ? [] : [{ x: from.x + dx, y: from.y, id: 0 }],
    });
  await send('touchStart');
  const began = Date.now();
  for (let move = 0; Date.now() - began < 2500; move += 1) await send('touchMove', move % 2);
  await send('touchEnd');
  await session.detach();
  await expect.poll(async () => (await ownOf(page))?.strokes.length).toBe(before + 1);
  const points = (await ownOf(page))?.strokes.at(-1)?.points_cm ?? [];
  expect(points.length).toBeGreaterThan(10);
  const away = points.map((value, at) => Math.abs(value - (points[at % 2] ?? 0)));
  // A pixel is some centimetres of ground.
  expect(Math.max(...away)).toBeLessThan(60);
  const row = await page.locator('.candidate').first().boundingBox();
  expect(row?.height).toBeGreaterThanOrEqual(40);
});

test('that no object is in hand can be read on a phone', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('movers-1-0001'));
  await still(page);
  await press(tool(page, 'Objects'));
  const list = page.locator('#object-list');
  await expect(list.locator('option:checked')).toHaveText('None');
  const room = await list.evaluate((select: HTMLSelectElement) => {
    const free = select.cloneNode(true) as HTMLSelectElement;
    free.replaceChildren(new Option('None'));
    free.style.cssText = 'position:fixed;flex:none;width:auto;min-width:0;max-width:none';
    document.body.append(free);
    const needed = free.offsetWidth;
    free.remove();
    return select.offsetWidth - needed;
  });
  expect(room).toBeGreaterThanOrEqual(0);
});
