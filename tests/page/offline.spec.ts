import { expect, file, loaded, state, test, until } from './page.ts';

// A small view leaves a processor without graphics card its time.
test.use({ viewport: { width: 720, height: 560 }, serviceWorkers: 'allow' });

test('after the first visit the page opens and drives without a network', async ({ mapless: page, context }) => {
  await page.evaluate(() => navigator.serviceWorker.ready);
  await context.setOffline(true);
  await page.goto('/?again');
  await loaded(page);
  await until(page, (now) => now.tick > 3);
  // What is loaded only when it is asked for is there, too.
  await page.evaluate(() => window.mapless?.loadScenario('vta'));
  expect((await state(page)).scenario).toBe('vta');
  const heights = `ncols 60\nnrows 60\ncellsize 0.5\n${`${'0 '.repeat(60)}\n`.repeat(60)}`;
  await page.locator('#files').setInputFiles([file('flat.asc', heights)]);
  await until(page, (now) => now.scenario === 'flat');
  const waiting = page.waitForEvent('download');
  await page.locator('#save-mcap').click();
  expect((await waiting).suggestedFilename()).toMatch(/\.mcap$/);
});

test('a new version is offered, and starts when asked for', async ({ mapless: page }) => {
  await page.evaluate(() => navigator.serviceWorker.ready);
  await page.addInitScript(() => {
    const { register } = ServiceWorkerContainer.prototype;
    ServiceWorkerContainer.prototype.register = async function (...asked) {
      const registration = await register.apply(this, asked);
      document.documentElement.dataset.registered = 'yes';
      return registration;
    };
  });
  await page.reload();
  await loaded(page);
  // The page looks for a new version some seconds after it has opened.
  await page.waitForSelector('[data-registered]');
  // To the browser, another address is another version.
  await page.evaluate(() => navigator.serviceWorker.register('./sw.js?new').then(() => undefined));
  await expect(page.locator('#notice-text')).toHaveText('A new version of this page is ready.');
  const controller = () => page.evaluate(() => navigator.serviceWorker.controller?.scriptURL);
  expect(await controller()).toMatch(/sw\.js$/);
  await Promise.all([page.waitForEvent('load'), page.getByRole('button', { name: 'Reload' }).click()]);
  await loaded(page);
  expect(await controller()).toMatch(/sw\.js\?new$/);
});
