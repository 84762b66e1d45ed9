/**
 * Measures what the page costs the main thread while the robot drives for a minute with every layer on: script for each
 * picture, and tasks that would be felt. `npm run measure` on the built page; `SECONDS=10` for a short run.
 *
 * Times are those of the thread's own clock, so that other programs on the machine do not count.
 */

import { existsSync } from 'node:fs';
import { chromium, type Page } from '@playwright/test';
import { served } from './served.ts';

const SECONDS = Number(process.env.SECONDS ?? 60);
const BUDGET = { script_p95_ms: 6, task_ms: 50 };

interface TraceEvent {
  readonly name: string;
  readonly ph: string;
  readonly ts: number;
  readonly dur?: number;
  readonly tdur?: number;
  readonly pid: number;
  readonly tid: number;
  readonly args?: { readonly name?: string };
}

/** Script that the browser runs for one reason: for a picture, a message from the worker, a timer, an event. */
const SCRIPT = new Set([
  'FireAnimationFrame',
  'FunctionCall',
  'EvaluateScript',
  'TimerFire',
  'HandlePostMessage',
  'EventDispatch',
]);

async function showEverything(page: Page): Promise<void> {
  await page.goto('.');
  await page.waitForFunction(() => (window.mapless?.state()?.tick ?? 0) > 5);
  await page.keyboard.press('x');
  for (const box of await page.locator('#layers').getByRole('checkbox').all()) await box.check();
  await page.locator('#layers').getByRole('combobox', { name: 'Point cloud by' }).selectOption('ring');
  await page.keyboard.press('Escape');
  await page.keyboard.press('v');
}

/** What the browser noted during `SECONDS` of play. */
async function trace(page: Page): Promise<TraceEvent[]> {
  const session = await page.context().newCDPSession(page);
  const events: TraceEvent[] = [];
  session.on('Tracing.dataCollected', ({ value }) => events.push(...(value as unknown as TraceEvent[])));
  const complete = new Promise((resolve) => session.once('Tracing.tracingComplete', resolve));
  const categories = ['devtools.timeline', 'toplevel', 'blink.user_timing', '__metadata'].join(',');
  await session.send('Tracing.start', { categories, transferMode: 'ReportEvents' });
  await page.waitForTimeout(SECONDS * 1000);
  await session.send('Tracing.end');
  await complete;
  return events;
}

/** Megabytes that the page's script holds after everything unused is gone. */
async function heap_mb(page: Page): Promise<number> {
  const session = await page.context().newCDPSession(page);
  await session.send('HeapProfiler.collectGarbage');
  const { usedSize } = await session.send('Runtime.getHeapUsage');
  return usedSize / 1e6;
}

/** The page's main thread: of those by that name the one that fires animation frames. */
function mainThread(events: readonly TraceEvent[]): TraceEvent[] {
  const fires = new Set(
    events.filter(({ name }) => name === 'FireAnimationFrame').map(({ pid, tid }) => `${pid} ${tid}`),
  );
  const main = events.find(
    ({ name, args, pid, tid }) =>
      name === 'thread_name' && args?.name === 'CrRendererMain' && fires.has(`${pid} ${tid}`),
  );
  if (!main) throw new Error('No picture was drawn while measuring.');
  const own = events.filter(({ pid, tid, ph }) => pid === main.pid && tid === main.tid && ph === 'X');
  return own.sort((a, b) => a.ts - b.ts);
}

/** Script in milliseconds from each picture to the next: the picture's own, and what came in between. */
function scriptPerFrame(events: readonly TraceEvent[]): number[] {
  const frames: number[] = [];
  let end = 0;
  for (const { name, ts, dur = 0, tdur = dur } of events) {
    if (!SCRIPT.has(name) || ts < end) continue;
    end = ts + dur;
    if (name === 'FireAnimationFrame') frames.push(0);
    if (frames.length > 0) frames[frames.length - 1] = (frames.at(-1) ?? 0) + tdur / 1000;
  }
  return frames;
}

function quantile(values: readonly number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? Number.NaN;
}

const report = await served(async (url) => {
  const executablePath = [process.env.CHROME, '/usr/bin/chromium'].find((path) => path && existsSync(path));
  const args = ['--no-sandbox', '--enable-unsafe-swiftshader'];
  const browser = await chromium.launch({ ...(executablePath ? { executablePath } : {}), args });
  try {
    const page = await browser.newPage({ viewport: { width: 1440, height: 900 }, baseURL: url });
    await showEverything(page);
    const began = await page.evaluate(() => window.mapless?.state()?.tick ?? 0);
    const before_mb = await heap_mb(page);
    const events = mainThread(await trace(page));
    const ticks = (await page.evaluate(() => window.mapless?.state()?.tick ?? 0)) - began;
    const script_ms = scriptPerFrame(events);
    const tasks_ms = events.filter(({ name }) => /RunTask$/.test(name)).map(({ dur = 0, tdur = dur }) => tdur / 1000);
    return {
      seconds: SECONDS,
      heap_mb: { before: before_mb, after: await heap_mb(page) },
      ticks,
      frames: script_ms.length,
      script_per_frame_ms: {
        median: quantile(script_ms, 0.5),
        p95: quantile(script_ms, 0.95),
        most: Math.max(...script_ms),
      },
      longest_task_ms: Math.max(0, ...tasks_ms),
      long_tasks: tasks_ms.filter((ms) => ms > BUDGET.task_ms).length,
    };
  } finally {
    await browser.close();
  }
});
process.stdout.write(`${JSON.stringify(report, undefined, 2)}\n`);
if (report.script_per_frame_ms.p95 >= BUDGET.script_p95_ms || report.long_tasks > 0) process.exitCode = 1;
