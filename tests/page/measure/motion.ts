/**
 * `npm run motion`: how long after the navigation the robot first moves, with the processor slowed down four times, cold.
 * Prints the times of a few visits and fails when the median is over the page's goal.
 */

import { chromium } from '@playwright/test';
import config from '../../../playwright.config.ts';
import { served } from './served.ts';

const GOAL_MS = 1500;
const THROTTLE = 4;
const VISITS = 5;

const times_ms: number[] = [];
await served(async (address) => {
  const browser = await chromium.launch(config.use?.launchOptions);
  for (let visit = 0; visit < VISITS; visit += 1) {
    const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
    const page = await context.newPage();
    const session = await context.newCDPSession(page);
    await session.send('Emulation.setCPUThrottlingRate', { rate: THROTTLE });
    await page.goto(address);
    // The clock of the page starts with its navigation.
    const moved = await page.waitForFunction(() => {
      const state = window.mapless?.state();
      return state && state.metrics.distance_m > 0 ? performance.now() : false;
    });
    times_ms.push(Number(await moved.jsonValue()));
    await context.close();
  }
  await browser.close();
});
times_ms.sort((a, b) => a - b);
const median_ms = times_ms[VISITS >> 1] ?? Number.NaN;
process.stdout.write(`first motion: ${times_ms.map((time) => time.toFixed(0)).join(', ')} ms; goal ${GOAL_MS} ms\n`);
if (!(median_ms <= GOAL_MS)) process.exitCode = 1;
