/** What the page's tests share: opening it, and what is under the 3D view's pixels. */

import { readFileSync } from 'node:fs';
import { type Browser, test as base, errors, expect, type Locator, type Page } from '@playwright/test';
import type { MaplessApi, MaplessState } from '../../web/src/app/windowApi.ts';
import type { Experiment } from '../../web/src/experiment/experiment.ts';

declare global {
  interface Window {
    mapless?: MaplessApi;
  }
}

/** A page that answers: Playwright's, or one in Firefox. */
export interface Asked {
  evaluate<Result>(work: () => Result | Promise<Result>): Promise<Result>;
  evaluate<Result, Argument>(
    work: (argument: Argument) => Result | Promise<Result>,
    argument: Argument,
  ): Promise<Result>;
}

/** A page that fails its test when a script throws, three.js warns or a request leaves the page's own origin. */
export const test = base.extend<{ mapless: Page }>({
  mapless: async ({ page, baseURL }, use) => {
    const faults: string[] = [];
    page.on('pageerror', (error) => faults.push(String(error)));
    page.on('console', (message) => {
      const [type, text] = [message.type(), message.text()];
      if (type === 'error' || (type === 'warning' && text.startsWith('THREE.'))) faults.push(text);
    });
    page.on('request', (request) => {
      const { origin, protocol } = new URL(request.url());
      const local = origin === new URL(baseURL ?? '').origin || protocol === 'blob:' || protocol === 'data:';
      if (!local) faults.push(`request to ${request.url()}`);
    });
    await page.goto('/');
    await loaded(page);
    await use(page);
    expect(faults).toEqual([]);
  },
});

export { expect };

/** A page opens within seconds, on a busy machine within a minute. */
const OPENING_MS = 150_000;

/** Waits until the first scenario is there. A browser may fail to open a page: that is told, and it is loaded once more. */
export async function loaded(page: Page): Promise<void> {
  if (await opens(page)) return;
  process.stderr.write(`The page did not open and is loaded once more. ${await standstill(page)}\n`);
  await page.reload();
  if (!(await opens(page))) throw new Error(`The page does not open. ${await standstill(page)}`);
}

async function opens(page: Page): Promise<boolean> {
  // Not by animation frames, which a browser may withhold.
  const wait = { polling: 100, timeout: OPENING_MS };
  return page
    .waitForFunction(() => window.mapless?.state() !== undefined, undefined, wait)
    .then(
      () => true,
      (error: unknown) => {
        if (error instanceof errors.TimeoutError) return false;
        throw error;
      },
    );
}

/** How far a page came that does not open, and what it says. */
async function standstill(page: Page): Promise<string> {
  const inTime = <T>(answer: Promise<T>) =>
    Promise.race([answer, new Promise<string>((resolve) => setTimeout(resolve, 5000, 'no answer'))]).catch(String);
  const shown = page.evaluate(() => ({
    document: document.readyState,
    scripts: window.mapless ? 'all run' : 'not all run',
    said: document.getElementById('notice')?.innerText,
    fetched: performance.getEntriesByType('resource').map(({ name }) => new URL(name).pathname),
  }));
  const workers = page.workers().map(async (worker) => [worker.url(), await inTime(worker.evaluate(() => self.name))]);
  return JSON.stringify({ page: await inTime(shown), workers: await Promise.all(workers) }, undefined, 1);
}

export async function state(page: Asked): Promise<MaplessState> {
  const now = await page.evaluate(() => window.mapless?.state());
  if (!now) throw new Error('The page has no scenario.');
  return now;
}

/** A run may take so long on a busy machine. */
const RUN_MS = 900_000;

/** Waits until the page's state passes `check`. */
export async function until(page: Asked, check: (now: MaplessState) => boolean): Promise<void> {
  await expect.poll(async () => check(await state(page)), { timeout: RUN_MS, intervals: [100] }).toBe(true);
}

/** Notes each text that an element shows from now on: on a busy machine, what stands only for a moment may be over before a test looks. */
export async function textsOf(page: Page, selector: string): Promise<() => Promise<string[]>> {
  const noted = await page.locator(selector).evaluateHandle((element) => {
    const texts: string[] = [];
    new MutationObserver(() => texts.push(element.textContent ?? '')).observe(element, {
      characterData: true,
      childList: true,
      subtree: true,
    });
    return texts;
  });
  return () => noted.jsonValue();
}

/** Whether a place is another one; one coordinate alone may be the same by chance. */
export function moved(now: { x: number; y: number }, before: { x: number; y: number }): boolean {
  return now.x !== before.x || now.y !== before.y;
}

/** Pauses and waits until nothing changes any more, neither state nor view. */
export async function still(page: Asked): Promise<void> {
  await page.evaluate(() => window.mapless?.still());
}

/** Drives on as fast as it goes, to this tick at least, and stands there. */
export async function driveTo(page: Asked, tick: number): Promise<void> {
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await unwatched(page, () => until(page, (now) => now.tick >= tick || now.outcome !== 'running'));
  await still(page);
}

/** Does something with the image out of sight, for which a third of the work of a drive would be done, and puts it back. */
async function unwatched(page: Asked, work: () => Promise<void>): Promise<void> {
  await page.evaluate(() => document.getElementById('variance')?.style.setProperty('translate', '-10000px'));
  await work();
  await page.evaluate(async () => {
    document.getElementById('variance')?.style.removeProperty('translate');
    // The page sees that it is in sight with the next picture, and asks for what it shows.
    for (let frame = 0; frame < 2; frame += 1) await new Promise((next) => requestAnimationFrame(next));
    await new Promise((next) => setTimeout(next));
  });
}

/** Drives on to the end at the highest speed; how the run ended. */
export async function runToEnd(page: Asked) {
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.play());
  await unwatched(page, () => until(page, (now) => now.outcome !== 'running'));
  const { outcome, tick, digest } = await state(page);
  return { outcome, ticks: tick, digest };
}

/** A page of somebody else: with a memory of its own. */
export async function elsewhere(browser: Browser, baseURL: string | undefined): Promise<Page> {
  return (await browser.newContext(baseURL ? { baseURL } : {})).newPage();
}

/** A short course, at tick 0. */
export async function shortCourse(page: Asked, ahead_m: number, left_m = 0): Promise<void> {
  await page.evaluate(() => window.mapless?.pause());
  await page.evaluate(() => window.mapless?.restart());
  const { pose } = await state(page);
  const goal = {
    x: pose.x + ahead_m * Math.cos(pose.yaw) - left_m * Math.sin(pose.yaw),
    y: pose.y + ahead_m * Math.sin(pose.yaw) + left_m * Math.cos(pose.yaw),
  };
  await page.evaluate((place) => window.mapless?.setGoal(place), goal);
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
}

/** In pixels of the page. */
interface Point {
  x: number;
  y: number;
}

/** A place within an element, in shares of its width and height. */
export async function within(part: Locator, across: number, down: number): Promise<Point> {
  const box = await part.boundingBox();
  if (!box) throw new Error('It is not shown.');
  return { x: box.x + across * box.width, y: box.y + down * box.height };
}

export async function tapIn(part: Locator, across: number, down: number): Promise<void> {
  const { x, y } = await within(part, across, down);
  await part.page().touchscreen.tap(x, y);
}

/** Fingers that go along these ways at the same time. */
export async function drag(page: Page, ...ways: [from: Point, to: Point][]): Promise<void> {
  const session = await page.context().newCDPSession(page);
  for (let step = 0; step <= 5; step += 1) {
    const touchPoints = ways.map(([from, to], id) => ({
      x: from.x + (step / 5) * (to.x - from.x),
      y: from.y + (step / 5) * (to.y - from.y),
      id,
    }));
    await session.send('Input.dispatchTouchEvent', { type: step ? 'touchMove' : 'touchStart', touchPoints });
  }
  await session.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  await session.detach();
}

/** Opens the drawer of parameters, comparison and seeds at one of its pages. */
export async function openLab(page: Page, tab: string, press: 'click' | 'tap' = 'click'): Promise<void> {
  await page.getByRole('button', { name: /^Parameters, comparison/ })[press]();
  await page.getByRole('tab', { name: tab })[press]();
}

/** Presses a button that saves something and returns the file. */
export async function download(
  page: Page,
  id: string,
  press: 'click' | 'tap' = 'click',
): Promise<{ name: string; bytes: Buffer }> {
  const waiting = page.waitForEvent('download');
  await page.locator(`#${id}`)[press]();
  const file = await waiting;
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

/** A file for the page to open. */
export function file(name: string, content: string | Buffer) {
  return { name, mimeType: 'application/octet-stream', buffer: Buffer.from(content) };
}

/** The first worker gets another script of the core, all later ones the right one; says how many have got one. */
export async function changeFirstCore(
  page: Page,
  change: (script: string) => string,
  scripts = '**/mapless_wasm*.js',
): Promise<() => number> {
  let served = 0;
  await page.route(scripts, async (route) => {
    const response = await route.fetch();
    const script = await response.text();
    const changed = change(script);
    expect(changed).not.toBe(script);
    served += 1;
    await route.fulfill({ response, body: served === 1 ? changed : script });
  });
  return () => served;
}

/** The first worker's core traps in its first decision after a start was set; says how many workers there have been. */
export function trapAfterStart(page: Page): Promise<() => number> {
  return changeFirstCore(page, (script) => {
    const broken = script
      .replace(/\bset_start\(([\w$,\s]+)\)\s*\{/, 'set_start($1){globalThis.armed=true;')
      .replace(/\btick\(\)\s*\{/, 'tick(){if(globalThis.armed)throw new WebAssembly.RuntimeError("unreachable");');
    expect(broken.length).toBeGreaterThan(script.length + 90);
    return broken;
  });
}

/** Expects all of it within the width of the window. */
export async function fits(parts: Locator): Promise<void> {
  const width = parts.page().viewportSize()?.width ?? 0;
  for (const part of await parts.all()) {
    const box = await part.boundingBox();
    expect(box && box.x >= 0 && box.x + box.width <= width, String(part)).toBe(true);
  }
}

/** How many lines of a text are cut off, scrolled away or behind something else. */
function hiddenLines(text: Locator): Promise<number> {
  return text.evaluate((one) => {
    const range = document.createRange();
    range.selectNodeContents(one);
    const seen = (x: number, y: number) => document.elementFromPoint(x, y) === one;
    return [...range.getClientRects()].filter(
      ({ left, right, y, height }) => !seen(left + 1, y + height / 2) || !seen(right - 1, y + height / 2),
    ).length;
  });
}

/** Presses what is large enough for a thumb. */
export async function press(part: Locator): Promise<void> {
  const box = await part.boundingBox();
  expect(Math.min(box?.width ?? 0, box?.height ?? 0), String(part)).toBeGreaterThanOrEqual(40);
  await part.tap();
}

/** Expects a message over the view of which every line can be read, with nothing before it, and closes it. */
export async function readAndClose(page: Page, words: string): Promise<void> {
  const text = page.locator('#notice-text');
  await expect(text).toContainText(words);
  expect(await hiddenLines(text)).toBe(0);
  await press(page.locator('#notice-close'));
  await expect(text).toBeHidden();
}

/** What the page would share and keep. */
export function ownOf(page: Asked): Promise<Experiment | undefined> {
  return page.evaluate(() => window.mapless?.experiment());
}

/** The pieces of work that the browser has kept, the newest last. */
export function allKept(page: Asked): Promise<Experiment[]> {
  return page.evaluate(
    () =>
      new Promise((resolve, reject) => {
        const opening = indexedDB.open('mapless', 1);
        opening.onupgradeneeded = () => opening.result.createObjectStore('experiments');
        opening.onerror = () => reject(opening.error);
        opening.onsuccess = () => {
          const reading = opening.result.transaction('experiments').objectStore('experiments').getAll();
          reading.onerror = () => reject(reading.error);
          reading.onsuccess = () => resolve(reading.result as Experiment[]);
        };
      }),
  );
}

/** Waits until the browser has kept the experiment for the next visit; returns it. */
export async function kept(page: Asked): Promise<Experiment | undefined> {
  const own = await ownOf(page);
  await expect.poll(async () => (await allKept(page)).at(-1)).toEqual(own);
  return own;
}

/** Waits until an element's drawing has more than so many different colours: a blank one has one or a few. */
export async function drawnIn(page: Page, selector: string, least: number): Promise<void> {
  await expect.poll(() => colours(page, selector)).toBeGreaterThan(least);
}

/** Number of different colours in a screenshot of an element. */
async function colours(page: Page, selector: string): Promise<number> {
  const png = await page.locator(selector).screenshot();
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context?.drawImage(image, 0, 0);
    const { data } = context?.getImageData(0, 0, image.width, image.height) ?? { data: [] };
    const seen = new Set<number>();
    for (let at = 0; at < data.length; at += 4 * 7) {
      seen.add(((data[at] ?? 0) << 16) | ((data[at + 1] ?? 0) << 8) | (data[at + 2] ?? 0));
    }
    return seen.size;
  }, png.toString('base64'));
}

/** What is wrong with where controls and messages are: two that overlap, or one that is cut off. */
export function misplaced(page: Page, wholly: boolean): Promise<string[]> {
  return page.evaluate((wholly) => {
    window.scrollTo(0, 0);
    const parts = '.bar, .stage, .timeline';
    const things =
      ':is(button, select, a, label, .scrub, .scene-caption, .brush, .detail, .result, .notice, .view-key)';
    const name = ({ id, className, textContent }: Element) => id || textContent?.trim() || className;
    const shown = [...document.querySelectorAll(`:is(${parts}) ${things}`)].flatMap((one) => {
      // A label stands for its control; what is scrolled out of the row of tools is out of the way.
      if (one.matches('.field') || !one.checkVisibility({ visibilityProperty: true })) return [];
      const { left, top, right, bottom } = one.getBoundingClientRect();
      const row = one.closest('.tools')?.getBoundingClientRect();
      const box = {
        left: Math.max(left, row?.left ?? left),
        top: Math.max(top, row?.top ?? top),
        right: Math.min(right, row?.right ?? right),
        bottom: Math.min(bottom, row?.bottom ?? bottom),
      };
      return box.right > box.left && box.bottom > box.top ? [{ one, ...box }] : [];
    });
    const { clientWidth, clientHeight } = document.documentElement;
    const cut = shown
      .filter(({ left, right, bottom }) => left < 0 || right > clientWidth || (wholly && bottom > clientHeight))
      .map(({ one }) => `${name(one)} is cut off`);
    const overlapping = shown.flatMap((a, index) =>
      shown
        .slice(index + 1)
        .filter((b) => !a.one.contains(b.one) && !b.one.contains(a.one))
        .filter((b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1)
        .filter((b) => Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1)
        .map((b) => `${name(a.one)} and ${name(b.one)}`),
    );
    return [...cut, ...overlapping];
  }, wholly);
}
