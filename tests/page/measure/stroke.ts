/**
 * `npm run stroke`: how long a touch of the brush takes until the mesh shows it, on ground of 512 × 512 points, with the robot
 * standing and driving. Prints medians and the slow end, and fails when that is over the page's goal.
 */

import { chromium, type Page } from '@playwright/test';
import config from '../../../playwright.config.ts';
import { served } from './served.ts';

const GOAL_MS = 33;
const POINTS = 512;
const TOUCHES = 60;

/** An ESRI grid of low waves. */
function waves(): string {
  const heights = Array.from({ length: POINTS * POINTS }, (_, at) =>
    (0.4 * Math.sin((at % POINTS) / 40) * Math.cos(Math.floor(at / POINTS) / 40)).toFixed(3),
  );
  return `ncols ${POINTS}\nnrows ${POINTS}\ncellsize 0.2\n${heights.join(' ')}\n`;
}

/** Milliseconds from each touch to its mesh, in order of size. */
async function touches_ms(page: Page): Promise<number[]> {
  const times_ms = await page.evaluate(async (count) => {
    const times: number[] = [];
    for (let touch = 0; touch < count; touch += 1) {
      const points_cm = [3000 + 60 * touch, 5000];
      await new Promise((resolve) => setTimeout(resolve, 40));
      const began_ms = performance.now();
      await window.mapless?.sculpt({ kind: 'raise', radius_m: 3, strength_m: 0.05, points_cm });
      times.push(performance.now() - began_ms);
    }
    return times;
  }, TOUCHES);
  return times_ms.sort((a, b) => a - b);
}

await served(async (address) => {
  const browser = await chromium.launch(config.use?.launchOptions);
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  await page.goto(address);
  await page.waitForFunction(() => window.mapless?.state() !== undefined);
  await page
    .locator('#files')
    .setInputFiles({ name: 'waves.asc', mimeType: 'text/plain', buffer: Buffer.from(waves()) });
  await page.waitForFunction((points) => window.mapless?.state()?.ground.columns === points, POINTS);
  for (const how of ['standing', 'driving']) {
    await page.evaluate((drives) => (drives ? window.mapless?.play() : window.mapless?.pause()), how === 'driving');
    const times_ms = await touches_ms(page);
    const [median_ms = Number.NaN, slow_ms = Number.NaN] = [0.5, 0.95].map(
      (share) => times_ms[Math.floor(share * TOUCHES)],
    );
    process.stdout.write(
      `${how}: median ${median_ms.toFixed(1)} ms, 95 % within ${slow_ms.toFixed(1)} ms; goal ${GOAL_MS} ms\n`,
    );
    if (!(slow_ms <= GOAL_MS)) process.exitCode = 1;
  }
  await browser.close();
});
