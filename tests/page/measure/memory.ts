/**
 * `npm run memory`: what the page's process holds while it is left open for ten minutes and drives from scenario to scenario,
 * every layer on. Prints megabytes a minute, and fails when the last minutes hold a tenth more than those after the start.
 *
 * The whole process counts, with its workers, their wasm and what the view draws from; it is read from Linux' /proc.
 */

import { readFileSync } from 'node:fs';
import { chromium } from '@playwright/test';
import config from '../../../playwright.config.ts';
import { served } from './served.ts';

const MINUTES = Number(process.env.MINUTES ?? 10);
/** Minutes in which everything is loaded once. */
const WARM = 2;
const GROWTH = 1.1;

/** Resident megabytes of the processes. */
function resident_mb(pids: readonly number[]): number {
  const kilobytes = pids.map((pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))?.[1]));
  return kilobytes.reduce((sum, kb) => sum + kb / 1000, 0);
}

const minutes_mb: number[] = [];
await served(async (address) => {
  const browser = await chromium.launch(config.use?.launchOptions);
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  await page.goto(address);
  await page.waitForFunction(() => (window.mapless?.state()?.tick ?? 0) > 5);
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  const pids = processInfo.filter(({ type }) => type === 'renderer').map(({ id }) => id);
  // Nobody touches it, so that it goes on to the next scenario by itself; the layers are switched without a click.
  await page.evaluate(() => {
    for (const box of document.querySelectorAll<HTMLInputElement>('#layers input[type=checkbox]')) {
      if (!box.checked) box.click();
    }
  });
  for (let minute = 1; minute <= MINUTES; minute += 1) {
    await page.waitForTimeout(60_000);
    minutes_mb.push(resident_mb(pids));
    const state = await page.evaluate(() => window.mapless?.state());
    process.stdout.write(
      `minute ${minute}: ${minutes_mb.at(-1)?.toFixed(0)} MB, ${state?.scenario} tick ${state?.tick}\n`,
    );
  }
  await browser.close();
});
const early_mb = Math.max(...minutes_mb.slice(0, WARM + 1));
const late_mb = Math.max(...minutes_mb.slice(-WARM));
process.stdout.write(`from ${early_mb.toFixed(0)} to ${late_mb.toFixed(0)} MB\n`);
if (!(late_mb <= GROWTH * early_mb)) process.exitCode = 1;
