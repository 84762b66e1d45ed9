import type { Page, Worker } from '@playwright/test';
import { changeFirstCore, drawnIn, expect, loaded, state, still, test, until } from './page.ts';

/** The name of the worker that draws the view. */
const PAINTER = 'mapless painter';

/** Has the painter run this first. */
async function beforePainting(page: Page, script: string): Promise<void> {
  await page.route('**/painterWorker-*.js', async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `{ ${script} }${await response.text()}` });
  });
}

async function painterOf(page: Page): Promise<Worker> {
  for (const worker of page.workers()) {
    if ((await worker.evaluate(() => self.name)) === PAINTER) return worker;
  }
  throw new Error('No worker draws the view.');
}

test('an unknown scenario is named in the message, and the old one goes on', async ({ mapless: page }) => {
  const message = await page.evaluate(() => window.mapless?.loadScenario('atlantis').catch((error) => error.message));
  expect(message).toContain('atlantis');
  const { tick } = await state(page);
  await until(page, (now) => now.tick > tick);
});

test('a lost graphics context is explained, and the view comes back', async ({ mapless: page }) => {
  const painter = await painterOf(page);
  // Its context is got hold of at the next picture.
  const context = await painter.evaluateHandle(
    () =>
      new Promise<WEBGL_lose_context | null>((resolve) => {
        const { clear } = WebGL2RenderingContext.prototype;
        WebGL2RenderingContext.prototype.clear = function (mask) {
          WebGL2RenderingContext.prototype.clear = clear;
          clear.call(this, mask);
          // The painter's own context refuses extensions.
          const extend = WebGL2RenderingContext.prototype.getExtension as (name: string) => WEBGL_lose_context | null;
          resolve(extend.call(this, 'WEBGL_lose_context'));
        };
      }),
  );
  await context.evaluate((lose) => lose?.loseContext());
  await expect(page.locator('#notice')).toContainText('3D view');
  await context.evaluate((lose) => lose?.restoreContext());
  await expect(page.locator('#notice')).toBeHidden();
  const { tick } = await state(page);
  await until(page, (now) => now.tick > tick + 3);
  await drawnIn(page, '#view', 500);
});

test('while the window changes its size the view is never empty', async ({ mapless: page }) => {
  await until(page, (now) => now.tick > 10);
  await still(page);
  await page.evaluate(() => window.mapless?.play());
  await page.evaluate(() => {
    const view = document.querySelector<HTMLCanvasElement>('#view');
    const copy = new OffscreenCanvas(16, 16).getContext('2d', { willReadFrequently: true });
    const look = () => {
      requestAnimationFrame(look);
      if (!view || !copy) return;
      copy.clearRect(0, 0, 16, 16);
      copy.drawImage(view, 0, 0, 16, 16);
      const drawn = copy.getImageData(0, 0, 16, 16).data.some((value) => value > 0);
      const seen = drawn ? 'pictures' : 'gaps';
      view.dataset[seen] = String(Number(view.dataset[seen] ?? 0) + 1);
    };
    look();
  });
  for (let width = 1440; width > 900; width -= 20) {
    await page.setViewportSize({ width, height: 900 - (width % 40) });
  }
  const view = page.locator('#view');
  await expect.poll(async () => Number(await view.getAttribute('data-pictures'))).toBeGreaterThan(20);
  await expect(view).not.toHaveAttribute('data-gaps');
});

test('until its first picture the view says that it is being drawn', async ({ page }) => {
  await beforePainting(
    page,
    'self.draw = self.requestAnimationFrame; self.requestAnimationFrame = (next) => { self.next = next; };',
  );
  await page.goto('/');
  await expect(page.getByRole('status').filter({ hasText: 'Drawing the view…' })).toBeVisible();
  await until(page, (now) => now.tick > 3);
  const painter = await painterOf(page);
  await painter.evaluate(() => {
    const held = self as unknown as { draw: typeof requestAnimationFrame; next: FrameRequestCallback };
    self.requestAnimationFrame = held.draw;
    requestAnimationFrame(held.next);
  });
  await expect(page.locator('#drawing')).toBeEmpty();
  await drawnIn(page, '#view', 500);
});

test('drawing the view begins with few questions to a busy graphics process', async ({ page }) => {
  const questions = ['getExtension', 'getProgramInfoLog', 'getShaderInfoLog'];
  await beforePainting(
    page,
    `self.asked = 0;
    for (const name of ${JSON.stringify(questions)}) {
      const ask = WebGL2RenderingContext.prototype[name];
      WebGL2RenderingContext.prototype[name] = function (...about) {
        self.asked += 1;
        return ask.apply(this, about);
      };
    }`,
  );
  await page.goto('/');
  await loaded(page);
  await drawnIn(page, '#view', 500);
  await still(page);
  const painter = await painterOf(page);
  // Whether a processor draws.
  expect(await painter.evaluate(() => (self as unknown as { asked: number }).asked)).toBeLessThanOrEqual(1);
});

test('what a graphics driver refuses to draw is told, and the rest is drawn', async ({ page }) => {
  await beforePainting(
    page,
    `const { shaderSource } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.shaderSource = function (shader, source) {
      // Of the points of the returns.
      shaderSource.call(this, shader, source.replace('gl_PointCoord', 'gl_PointCoordinate'));
    };`,
  );
  await page.goto('/');
  await loaded(page);
  await expect(page.locator('#notice-text')).toContainText('refused to draw a part of the 3D view');
  await expect(page.locator('#drawing')).toBeEmpty();
  await drawnIn(page, '#view', 500);
  const { tick } = await state(page);
  await until(page, (now) => now.tick > tick + 3);
});

test('without WebGL the view stays empty, and all else works', async ({ page }) => {
  await beforePainting(page, 'OffscreenCanvas.prototype.getContext = () => null;');
  await page.goto('/');
  await loaded(page);
  await expect(page.locator('#no-view')).toContainText('WebGL');
  await expect(page.locator('#drawing')).toBeEmpty();
  await until(page, (now) => now.tick > 3);
  await page.evaluate(() => window.mapless?.still());
  await page.locator('#save-picture').click();
  await expect(page.locator('#notice-text')).toContainText('view.png could not be made: there is no 3D view');
});

test('an error in drawing is explained, ends a film with what it has, and all else works', async ({ page }) => {
  await page.goto('/');
  await loaded(page);
  await page.locator('#save-film').click();
  // From now on the film has something.
  await expect(page.locator('#save-film')).toHaveText('Stop the film');
  const film = page.waitForEvent('download');
  const painter = await painterOf(page);
  await painter.evaluate(() => {
    WebGL2RenderingContext.prototype.clear = () => {
      throw new Error('no more paint');
    };
  });
  await expect(page.locator('#notice-text')).toContainText('no more paint');
  expect((await film).suggestedFilename()).toMatch(/film\.webm$/);
  await expect(page.locator('#save-film')).toHaveText('Film (WebM)');
  const { tick } = await state(page);
  await until(page, (now) => now.tick > tick);
});

test('the policy of the page allows its own origin only, and to fetch data', async ({ mapless: page }) => {
  const policy = await page.locator('meta[http-equiv="Content-Security-Policy"]').getAttribute('content');
  expect(policy).toContain("default-src 'none'");
  // From an address that somebody gives; nothing that is run.
  expect(policy).toContain("connect-src 'self' https:;");
  expect(policy?.replace('https:', '')).not.toMatch(/https?:|\*|unsafe-inline|unsafe-eval'(?<!wasm-unsafe-eval')/);
});

test('a damaged wasm file is explained', async ({ page }) => {
  await page.route('**/*.wasm', (route) => route.fulfill({ contentType: 'application/wasm', body: 'not wasm' }));
  await page.goto('/');
  await expect(page.locator('#notice')).toBeVisible();
  await expect(page.locator('#notice-text')).toContainText('simulation');
});

test('after a panic in the core the simulation starts anew, and says why', async ({ page }) => {
  // The first worker gets a core whose fifth decision traps.
  const trap =
    'if((globalThis.ticks=(globalThis.ticks??0)+1)===5){throw new WebAssembly.RuntimeError("panicked at the fifth tick")}';
  await changeFirstCore(page, (script) => script.replace(/\btick\(\)\s*\{/, `tick(){${trap}`));
  await page.goto('/');
  await loaded(page);
  await expect(page.locator('#notice-text')).toContainText('panicked at the fifth tick');
  await until(page, (now) => now.tick === 0 && !now.playing);
  await page.locator('#notice-close').click();
  await page.getByRole('button', { name: 'Play' }).click();
  await until(page, (now) => now.tick > 8);
});
