import { readFileSync } from 'node:fs';
import { expect, loaded, state, test, until } from './page.ts';

test('after the first visit the page opens and drives without a network', async ({ mapless: page, context }) => {
  await page.evaluate(() => navigator.serviceWorker.ready);
  await context.setOffline(true);
  await page.goto('/?again');
  await loaded(page);
  await until(page, (now) => now.tick > 3);
  // What is loaded only when it is asked for is there, too.
  await page.evaluate(() => window.mapless?.loadScenario('vta'));
  expect((await state(page)).scenario).toBe('vta');
  const waiting = page.waitForEvent('download');
  await page.locator('#save-mcap').click();
  expect((await waiting).suggestedFilename()).toMatch(/\.mcap$/);
});

test('a new version is offered, and starts when asked for', async ({ mapless: page, context }) => {
  await page.evaluate(() => navigator.serviceWorker.ready);
  const old = await page.evaluate(() => caches.keys());
  // Another build: the same files under another version.
  const worker = readFileSync('dist/sw.js', 'utf8').replace(/VERSION = "[0-9a-f]+"/, 'VERSION = "another"');
  await context.route('**/sw.js', (route) => route.fulfill({ contentType: 'text/javascript', body: worker }));
  await page.reload();
  await loaded(page);
  await expect(page.locator('#notice-text')).toHaveText('A new version of this page is ready.');
  expect(await page.evaluate(() => caches.keys())).toEqual(expect.arrayContaining(old));
  await Promise.all([page.waitForEvent('load'), page.getByRole('button', { name: 'Reload' }).click()]);
  await loaded(page);
  await expect.poll(() => page.evaluate(() => caches.keys())).toEqual(['mapless-another']);
});
