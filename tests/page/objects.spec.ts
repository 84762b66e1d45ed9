/** Objects: placed, moved, turned, sized and deleted by mouse, finger and keyboard; the robot meets them; links keep them. */

import type { Page } from '@playwright/test';
import { unzipSync } from 'fflate';
import type { WorldObject } from '../../web/src/experiment/objects.ts';
import {
  download,
  drag,
  driveTo,
  elsewhere,
  expect,
  fits,
  kept,
  loaded,
  ownOf,
  press,
  shortCourse,
  state,
  still,
  tapIn,
  test,
  until,
  within,
} from './page.ts';

const view = (page: Page) => page.locator('#view');
const button = (page: Page, name: string) => page.getByRole('button', { name, exact: true });
const objectsOf = async (page: Page) => (await state(page)).objects;
const count = (page: Page, wanted: number) => until(page, ({ objects }) => objects.length === wanted);
/** Returns of the scan that stand this high above the ground: none without objects. */
const above = (page: Page, least_m: number) =>
  page.evaluate((least) => {
    const points = window.mapless?.scan() ?? [];
    let found = 0;
    for (let at = 0; at + 2 < points.length; at += 3) {
      const ground = window.mapless?.heightAt({ x: points[at] ?? 0, y: points[at + 1] ?? 0 }) ?? 0;
      if ((points[at + 2] ?? 0) - ground > least) found += 1;
    }
    return found;
  }, least_m);

/** A place ahead of the robot, and to its left. */
async function aheadOf(page: Page, ahead_m: number, left_m = 0): Promise<[number, number]> {
  const { x, y, yaw } = (await state(page)).pose;
  const [sin, cos] = [Math.sin(yaw), Math.cos(yaw)];
  return [x + ahead_m * cos - left_m * sin, y + ahead_m * sin + left_m * cos];
}

async function put(page: Page, ...objects: WorldObject[]): Promise<void> {
  await page.evaluate((list) => window.mapless?.setObjects(list), objects);
}

const placeOf = (object: WorldObject | undefined) => (object && 'at' in object ? object.at : undefined);

test.describe('with a mouse', () => {
  test('a box is placed, moved, turned, sized and deleted, and each of it is undone', async ({ mapless: page }) => {
    await shortCourse(page, 6);
    await still(page);
    expect(await above(page, 0.3)).toBe(0);
    await page.keyboard.press('a');
    await page.locator('.chip', { hasText: 'Box' }).click();
    const spot = await within(view(page), 0.5, 0.42);
    await page.mouse.click(spot.x, spot.y);
    await count(page, 1);
    await still(page);
    expect(await above(page, 0.3)).toBeGreaterThan(0);
    await expect(page.locator('#object-list')).toHaveValue('0');
    await expect(page.locator('#object-said')).toContainText('Box 1 placed at');
    const [placed] = await objectsOf(page);

    await page.mouse.move(spot.x, spot.y);
    await page.mouse.down();
    await page.mouse.move(spot.x + 40, spot.y, { steps: 4 });
    await page.mouse.move(spot.x + 120, spot.y + 20, { steps: 4 });
    await page.mouse.up();
    await until(page, ({ objects }) => JSON.stringify(placeOf(objects[0])) !== JSON.stringify(placeOf(placed)));
    const [dragged] = await objectsOf(page);

    await button(page, 'Turn').click();
    await until(page, ({ objects }) => objects[0]?.kind === 'box' && objects[0].yaw_rad !== yawOf(dragged));
    await button(page, 'Larger').click();
    await until(page, ({ objects }) => objects[0]?.kind === 'box' && objects[0].size_m[0] === 1.15);
    await button(page, 'Delete').click();
    await count(page, 0);
    await still(page);
    expect(await above(page, 0.3)).toBe(0);
    for (let step = 0; step < 3; step += 1) await page.evaluate(() => window.mapless?.undo());
    expect(await objectsOf(page)).toEqual([dragged]);
    await page.evaluate(() => window.mapless?.undo());
    expect(await objectsOf(page)).toEqual([placed]);
    await page.evaluate(() => window.mapless?.undo());
    await count(page, 0);
    await page.evaluate(() => window.mapless?.redo());
    expect(await objectsOf(page)).toEqual([placed]);
  });

  test('a wall is dragged from end to end, and one of its ends is moved', async ({ mapless: page }) => {
    await shortCourse(page, 6);
    await still(page);
    await page.keyboard.press('a');
    await page.locator('.chip', { hasText: 'Wall' }).click();
    const [left, right] = [await within(view(page), 0.4, 0.42), await within(view(page), 0.6, 0.42)];
    await page.mouse.move(left.x, left.y);
    await page.mouse.down();
    await page.mouse.move(right.x, right.y, { steps: 5 });
    await page.mouse.up();
    await count(page, 1);
    await still(page);
    const [wall] = await objectsOf(page);
    if (wall?.kind !== 'wall') throw new Error(`It is a ${wall?.kind}.`);
    expect(Math.hypot(wall.to[0] - wall.from[0], wall.to[1] - wall.from[1])).toBeGreaterThan(2);
    await page.mouse.move(right.x, right.y);
    await page.mouse.down();
    await page.mouse.move(right.x + 60, right.y + 10, { steps: 5 });
    await page.mouse.up();
    await until(page, ({ objects }) => objects[0]?.kind === 'wall' && objects[0].to[0] !== wall.to[0]);
    const [longer] = await objectsOf(page);
    expect(longer).toMatchObject({ kind: 'wall', from: wall.from });
  });
});

const yawOf = (object: WorldObject | undefined) => (object?.kind === 'box' ? object.yaw_rad : undefined);

test('by keyboard, an object is placed, put down, taken up, moved and deleted', async ({ mapless: page }) => {
  await shortCourse(page, 6);
  await view(page).focus();
  await page.keyboard.press('a');
  await page.keyboard.press('Shift+ArrowUp');
  await page.keyboard.press('Enter');
  await count(page, 1);
  await expect(page.locator('#object-said')).toContainText('Post 1 placed');
  const [post] = await objectsOf(page);
  await page.keyboard.press('ArrowLeft');
  await until(page, ({ objects }) => placeOf(objects[0])?.[0] !== placeOf(post)?.[0]);
  await page.keyboard.press('+');
  await until(page, ({ objects }) => objects[0]?.kind === 'post' && objects[0].height_m === 1.38);
  await page.keyboard.press('Escape');
  await expect(page.locator('#object-list')).toHaveValue('');
  await expect(page.locator('#view')).toHaveAttribute('data-tool', 'objects');
  await page.locator('#object-list').selectOption('0');
  await expect(button(page, 'Turn')).toBeDisabled();
  await view(page).focus();
  await page.keyboard.press('Delete');
  await count(page, 0);
  await expect(page.locator('#object-said')).toHaveText('Post 1 deleted');
  // A person: from here to there.
  await page.locator('.chip', { hasText: 'Person' }).click();
  await view(page).focus();
  await page.keyboard.press('Shift+ArrowUp');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Shift+ArrowLeft');
  await page.keyboard.press('Enter');
  await until(page, ({ objects }) => objects[0]?.kind === 'post' && objects[0].walk?.path.length === 1);
  await page.keyboard.press('Escape');
  await page.keyboard.press('Escape');
  await expect(page.locator('#view')).toHaveAttribute('data-tool', 'look');
});

test('a wall before the robot sends it another way', async ({ mapless: page }) => {
  const drives = async () => {
    await page.evaluate(() => window.mapless?.play());
    await driveTo(page, 1000);
    return state(page);
  };
  await shortCourse(page, 6);
  const free = await drives();
  expect(free.outcome).toBe('reached');
  await page.evaluate(() => window.mapless?.restart());
  const [from, to] = [await aheadOf(page, 3, -1.5), await aheadOf(page, 3, 1.5)];
  await put(page, { kind: 'wall', from, to, height_m: 1 });
  const walled = await drives();
  expect(walled.outcome).not.toBe('running');
  expect(walled.metrics.distance_m).not.toBeCloseTo(free.metrics.distance_m, 1);
});

test('what the robot runs into is named', async ({ mapless: page }) => {
  await shortCourse(page, 6);
  // Too low to be noticed, too high to climb.
  await put(page, { kind: 'post', at: await aheadOf(page, 1), radius_m: 0.05, height_m: 0.25 });
  await page.evaluate(() => window.mapless?.play());
  await until(page, ({ outcome }) => outcome !== 'running');
  await expect(page.locator('#result-words')).toHaveText(/Collided|High-centred|Stopped by a step/);
  await expect(page.locator('#reason')).toContainText(/post 1 at \(/);
});

test('a link, the next visit and files keep them', async ({ mapless: page, browser, baseURL }) => {
  await shortCourse(page, 6);
  const [at, end] = [await aheadOf(page, 4, 1), await aheadOf(page, 4, -1)];
  await put(
    page,
    { kind: 'rock', at, radius_m: 0.4, sunk_m: 0.1 },
    { kind: 'post', at: end, radius_m: 0.25, height_m: 1.7, walk: { path: [at], speed_m_s: 0.5 } },
  );
  const own = await ownOf(page);
  expect(own?.objects).toHaveLength(2);
  expect(await kept(page)).toEqual(own);
  const link = await page.evaluate(() => window.mapless?.link());
  const other = await elsewhere(browser, baseURL);
  await other.goto(link ?? '');
  await loaded(other);
  expect(await ownOf(other)).toEqual(own);
  expect(await objectsOf(other)).toEqual(own?.objects);
  await other.context().close();
  await page.locator('#share').click();
  const { bytes } = await download(page, 'save-scenario');
  const scenario = new TextDecoder().decode(unzipSync(bytes)['scenario.toml']);
  expect(scenario).toContain('[[objects]]\nkind = "rock"');
  await page.getByRole('button', { name: 'Close' }).click();
  await page.reload();
  await loaded(page);
  expect(await objectsOf(page)).toEqual(own?.objects);
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  expect(await objectsOf(page)).toEqual([]);
  await page.locator('#terrains').click();
  await page.setInputFiles('#files', { name: 'it.zip', mimeType: 'application/zip', buffer: bytes });
  await until(page, ({ objects }) => objects.length === 2);
  expect(await objectsOf(page)).toEqual(own?.objects);
});

test.describe('with a finger', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('a rock is placed by a tap, sized, deleted, brought back and dragged', async ({ mapless: page }) => {
    await shortCourse(page, 6);
    await still(page);
    await press(page.locator('label.tool', { hasText: 'Objects' }));
    await fits(page.locator('.in-hand > *'));
    for (const part of await page.locator('.chip, .in-hand > *').all()) {
      const box = await part.boundingBox();
      expect(Math.min(box?.width ?? 0, box?.height ?? 0)).toBeGreaterThanOrEqual(44);
    }
    await press(page.locator('.chip', { hasText: 'Rock' }));
    await tapIn(view(page), 0.5, 0.48);
    await count(page, 1);
    await still(page);
    await press(button(page, 'Smaller'));
    await until(page, ({ objects }) => objects[0]?.kind === 'rock' && objects[0].radius_m < 0.5);
    await press(button(page, 'Delete'));
    await count(page, 0);
    await press(button(page, 'Undo'));
    await count(page, 1);
    await still(page);
    const [rock] = await objectsOf(page);
    // The last of all: the browser may take a tap right after a drag for the end of a fling.
    await drag(page, [await within(view(page), 0.5, 0.48), await within(view(page), 0.7, 0.52)]);
    await until(page, ({ objects }) => placeOf(objects[0])?.[0] !== placeOf(rock)?.[0]);
  });
});
