/** What the page's tests share: opening it, and what is under the 3D view's pixels. */

import { test as base, expect, type Page } from '@playwright/test';
import type { MaplessApi, MaplessState } from '../../web/src/api.ts';
import type { Experiment } from '../../web/src/core/experiment.ts';

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

/** A page that fails its test when a script throws or a request leaves the page's own origin. */
export const test = base.extend<{ mapless: Page }>({
  mapless: async ({ page, baseURL }, use) => {
    const faults: string[] = [];
    page.on('pageerror', (error) => faults.push(String(error)));
    page.on('console', (message) => {
      if (message.type() === 'error') faults.push(message.text());
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

/** Waits until the first scenario is there. */
export async function loaded(page: Page): Promise<void> {
  await page.waitForFunction(() => window.mapless?.state() !== undefined);
}

export async function state(page: Asked): Promise<MaplessState> {
  const now = await page.evaluate(() => window.mapless?.state());
  if (!now) throw new Error('The page has no scenario.');
  return now;
}

/** Waits until what `read` gives passes `check`. */
export async function until(page: Asked, check: (now: MaplessState) => boolean, timeout = 60_000): Promise<void> {
  await expect.poll(async () => check(await state(page)), { timeout, intervals: [100] }).toBe(true);
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
  await until(page, (now) => now.tick >= tick || now.outcome !== 'running');
  await still(page);
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

/** Waits until the browser has kept the experiment for the next visit; returns it. */
export async function kept(page: Asked): Promise<Experiment | undefined> {
  const own = await page.evaluate(() => window.mapless?.experiment());
  const stored = () =>
    page.evaluate(
      () =>
        new Promise((resolve, reject) => {
          const opening = indexedDB.open('mapless', 1);
          opening.onerror = () => reject(opening.error);
          opening.onsuccess = () => {
            const reading = opening.result.transaction('experiments').objectStore('experiments').get('last');
            reading.onerror = () => reject(reading.error);
            reading.onsuccess = () => resolve(reading.result);
          };
        }),
    );
  await expect.poll(stored).toEqual(own);
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
