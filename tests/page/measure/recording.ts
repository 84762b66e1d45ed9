/**
 * `npm run recording`: opens ten minutes of a drive, with the scans of a VLP-16 at 10 Hz, in the built page. Prints how long it takes until
 * a scan of it is seen, and what the page's process holds while it decides all of it again; fails beyond the limits.
 *
 * The file is written once, to `target/`, and has 1.3 GB. Memory is read from Linux' /proc.
 */

import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { chromium } from '@playwright/test';
import config from '../../../playwright.config.ts';
import { served } from './served.ts';

const FILE = resolve('target/ten-minutes.mcap');
/** How long it is watched after it was opened, and how often. */
const SECONDS = Number(process.env.SECONDS ?? 160);
const EVERY_S = 20;
const LIMITS = { seen_s: 5, grown_mb: 100 };

if (!existsSync(FILE)) {
  const cargo = ['run', '--release', '--package', 'mapless-recording', '--example', 'ten_minutes', '--', FILE];
  execFileSync('cargo', cargo, { stdio: 'inherit' });
}

await served(async (address) => {
  const browser = await chromium.launch(config.use?.launchOptions);
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  await page.goto(address);
  await page.waitForFunction(() => (window.mapless?.state()?.tick ?? 0) > 5);
  await page.evaluate(() => window.mapless?.pause());
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  const pids = processInfo.filter(({ type }) => type === 'renderer').map(({ id }) => id);
  /** Resident megabytes of the page's processes. */
  const resident_mb = () =>
    pids.reduce((sum, pid) => {
      const kilobytes = /VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))?.[1];
      return sum + Number(kilobytes) / 1000;
    }, 0);

  const began_ms = performance.now();
  await page.locator('#files').setInputFiles(FILE);
  await page.locator('.drive-now').getByText('s old').waitFor();
  const seen_s = (performance.now() - began_ms) / 1000;
  const opened_mb = resident_mb();
  const watched_mb: number[] = [];
  for (let second = EVERY_S; second <= SECONDS; second += EVERY_S) {
    await page.waitForTimeout(EVERY_S * 1000);
    watched_mb.push(resident_mb());
    const decided = await page.locator('.drive').textContent();
    process.stdout.write(
      `${second} s: ${watched_mb.at(-1)?.toFixed(0)} MB, ${/\d+ %|none of/.exec(decided ?? '')?.[0]}\n`,
    );
  }
  await browser.close();
  const grown_mb = Math.max(...watched_mb) - (watched_mb[0] ?? Number.NaN);
  process.stdout.write(
    `a scan is seen after ${seen_s.toFixed(1)} s, with ${opened_mb.toFixed(0)} MB; the most afterwards ` +
      `${Math.max(...watched_mb).toFixed(0)} MB, ${grown_mb.toFixed(0)} MB more than after ${EVERY_S} s\n`,
  );
  if (!(seen_s <= LIMITS.seen_s && grown_mb <= LIMITS.grown_mb)) process.exitCode = 1;
});
