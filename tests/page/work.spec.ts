/** Work is never lost: not by a reload, another tab, another scenario or Back. */

import type { Page } from '@playwright/test';
import { allKept, expect, kept, loaded, ownOf, state, test, until } from './page.ts';

test.use({ viewport: { width: 720, height: 560 } });

async function open(page: Page, address: string): Promise<void> {
  await page.goto(address);
  await loaded(page);
}

async function reload(page: Page): Promise<void> {
  await page.reload();
  await loaded(page);
}

/** Another goal, so far ahead of the start and to its left. */
async function otherGoal(page: Page, ahead_m: number): Promise<void> {
  const { start } = await state(page);
  await page.evaluate((goal) => window.mapless?.setGoal(goal), { x: start.x + ahead_m, y: start.y + 3 });
}

const query = (page: Page) => new URL(page.url()).search;

test('an edit of a scenario that the address asked for outlives a reload', async ({ page }) => {
  await open(page, '/?scenario=ht');
  await otherGoal(page, 6);
  await expect.poll(() => query(page)).toBe('');
  const own = await kept(page);
  await reload(page);
  expect(await ownOf(page)).toEqual(own);
});

test('two tabs keep their own work, and what was begun last is where another one begins', async ({ page, context }) => {
  await open(page, '/');
  await otherGoal(page, 6);
  const first = await kept(page);
  const other = await context.newPage();
  // It begins where the first tab is, and goes on by itself.
  await open(other, '/');
  expect(await ownOf(other)).toEqual(first);
  await otherGoal(other, 9);
  const second = await kept(other);
  expect(await allKept(page)).toEqual([first, second]);
  await reload(page);
  expect(await ownOf(page)).toEqual(first);
  await reload(other);
  expect(await ownOf(other)).toEqual(second);
  const third = await context.newPage();
  await open(third, '/');
  expect(await ownOf(third)).toEqual(second);
});

test('looking at scenarios takes the place of no work, and the address says which', async ({ page }) => {
  await open(page, '/');
  await otherGoal(page, 6);
  const own = await kept(page);
  await page.locator('#scenario').selectOption('ht');
  await until(page, (now) => now.scenario === 'ht');
  await expect.poll(() => query(page)).toBe('?scenario=ht');
  await page.locator('#preset').selectOption('paper');
  await until(page, (now) => now.preset === 'paper');
  await expect.poll(() => query(page)).toBe('?scenario=ht&preset=paper');
  await reload(page);
  expect(await state(page)).toMatchObject({ scenario: 'ht', preset: 'paper' });
  expect(await allKept(page)).toEqual([own]);
  await page.goto('about:blank');
  await open(page, '/');
  expect(await ownOf(page)).toEqual(own);
});

test('the address follows, and Back goes through what was opened', async ({ page }) => {
  await open(page, '/?scenario=ht&seed=7');
  for (const name of ['gsb', 'ml']) {
    await page.locator('#scenario').selectOption(name);
    await until(page, (now) => now.scenario === name);
    await expect.poll(() => query(page)).toBe(`?scenario=${name}`);
  }
  await otherGoal(page, 6);
  const own = await kept(page);
  await page.goBack();
  await until(page, (now) => now.scenario === 'gsb');
  expect(query(page)).toBe('?scenario=gsb');
  await page.goBack();
  await until(page, (now) => now.scenario === 'ht' && now.seed === 7);
  expect(query(page)).toBe('?scenario=ht&seed=7');
  await page.goForward();
  await until(page, (now) => now.scenario === 'gsb');
  await page.goForward();
  await until(page, (now) => now.scenario === 'ml');
  expect(await ownOf(page)).toEqual(own);
  // What was opened before a reload comes back by its address.
  await reload(page);
  await page.goBack();
  await page.waitForFunction(() => window.mapless?.state()?.scenario === 'gsb');
});

test('earlier work is listed with the terrains, and opens from there', async ({ page }) => {
  await open(page, '/');
  await otherGoal(page, 6);
  const own = await kept(page);
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await otherGoal(page, 4);
  await kept(page);
  await page.getByRole('button', { name: 'Terrains' }).click();
  const list = page.getByRole('list', { name: 'Your earlier work' });
  await expect(list.getByRole('button')).toHaveCount(2);
  await list.getByRole('button', { name: /A to D/ }).click();
  await until(page, (now) => now.scenario === 'cht-ad');
  expect(await ownOf(page)).toEqual(own);
});

test('a link stays in the address until something is changed, and is no work of one’s own before', async ({ page }) => {
  await open(page, '/');
  await otherGoal(page, 6);
  const own = await kept(page);
  const link = (await page.evaluate(() => window.mapless?.link())) ?? '';
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await otherGoal(page, 4);
  const newest = await kept(page);
  await page.goto('about:blank');
  await open(page, link);
  expect(page.url()).toBe(link);
  await reload(page);
  expect(await ownOf(page)).toEqual(own);
  expect(await allKept(page)).toEqual([own, newest]);
  await otherGoal(page, 9);
  await expect.poll(() => new URL(page.url()).hash).toBe('');
  const changed = await kept(page);
  expect(await allKept(page)).toEqual([own, newest, changed]);
});

test('a damaged link leaves the scenario that the address asks for', async ({ page }) => {
  await open(page, '/?scenario=ht#e=AAAA');
  await expect(page.locator('#notice-text')).toContainText('damaged or was cut short');
  expect(await state(page)).toMatchObject({ scenario: 'ht' });
});
