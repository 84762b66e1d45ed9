/**
 * `npm run inside`: how long the core's worker takes for what looks inside a decision, and for thinking again, from the
 * question's arrival to its answer, while the robot stands; and whether such questions hold up a run at normal speed.
 * Prints medians and the slow end, and fails where they are over the page's goals.
 */

import { chromium, type Page, type Worker } from '@playwright/test';
import config from '../../../playwright.config.ts';
import type { Command, FromSimulation } from '../../../web/src/protocol/simulationProtocol.ts';
import { served } from './served.ts';

/** 95 % of what looks inside; half of what thinks again. */
const GOALS_MS = { inside: 50, again: 100 };
/** Ticks of the run at which it is asked. */
const PLACES = [20, 120, 220, 320, 420];
/** Each question so often at each of them. */
const TIMES = 12;
/** How long the run drives with questions, and how often one comes. */
const DRIVE_MS = 15_000;
const EVERY_MS = 50;
/** Share of the ticks that a run may lose to them. */
const MOST_LOST = 0.02;

/** What is asked at each place; `time` counts how often it was. */
const QUESTIONS: Readonly<Record<string, (time: number) => Command>> = {
  'the process of the scan': () => ({ type: 'inside', question: { without: [] } }),
  'one inducing input less': (time) => ({ type: 'inside', question: { without: [5 * time] } }),
  'inputs on the lattice': (time) => ({ type: 'inside', question: { placement: 'lattice', without: [time] } }),
  'farthest points': (time) => ({ type: 'inside', question: { placement: 'farthest_points', without: [time] } }),
  'every nth return': (time) => ({ type: 'inside', question: { placement: 'strided', without: [time] } }),
  'kernel at the pointer': (time) => ({ type: 'kernel', column: 29 * time, row: 10 + time }),
};

function withThreshold(variance_threshold: number): Command {
  const perception = { variance_threshold };
  return { type: 'think', setup: { preset: 'default', learning: 'fixed', overrides: { planner: { perception } } } };
}

type Times = Record<string, number[]>;

/** Has the worker note how long each of these questions takes, and answer the page no more than before. */
async function instrument(worker: Worker): Promise<void> {
  // tsx has functions keep their names by a helper that the worker does not have.
  await worker.evaluate('globalThis.__name = (one) => one');
  await worker.evaluate(() => {
    const waiting = new Map<number, (message: FromSimulation) => void>();
    const post = self.postMessage.bind(self);
    let id = 1e9;
    Object.assign(self, {
      postMessage: (message: FromSimulation, options?: StructuredSerializeOptions) => {
        const answered = 'id' in message && message.id !== undefined && waiting.get(message.id);
        if (answered) answered(message);
        else post(message, options);
      },
      ask: (command: Command) =>
        new Promise<number>((resolve, reject) => {
          id += 1;
          const began_ms = performance.now();
          waiting.set(id, (message) => {
            if (message.type === 'failed') reject(new Error(message.message));
            else resolve(performance.now() - began_ms);
          });
          self.onmessage?.(new MessageEvent('message', { data: { type: 'request', id, command } }));
        }),
    });
  });
}

function ask(worker: Worker, command: Command): Promise<number> {
  return worker.evaluate(
    (given) => (Reflect.get(self, 'ask') as (one: Command) => Promise<number>)(JSON.parse(given)),
    JSON.stringify(command),
  );
}

/** The share of the values that are within this one. */
function quantile(values: readonly number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? Number.NaN;
}

function tickOf(page: Page): Promise<number> {
  return page.evaluate(() => window.mapless?.state()?.tick ?? 0);
}

/** Times of each question, and of thinking again with another threshold. */
async function standing(page: Page, worker: Worker): Promise<{ inside: Times; again: number[] }> {
  const [inside, again]: [Times, number[]] = [{}, []];
  for (const tick of PLACES) {
    await page.evaluate((to) => window.mapless?.seek(to), tick);
    await page.evaluate(() => window.mapless?.still());
    const { x, y } = await page.evaluate(() => window.mapless?.state()?.pose ?? { x: 0, y: 0 });
    const around = (time: number): Command => {
      const place = { x: x + 4 * Math.cos(0.52 * time), y: y + 4 * Math.sin(0.52 * time) };
      return { type: 'place', place };
    };
    for (const [name, question] of [...Object.entries(QUESTIONS), ['Why not there?', around] as const]) {
      const noted = inside[name] ?? [];
      inside[name] = noted;
      for (let time = 0; time < TIMES; time += 1) noted.push(await ask(worker, question(time)));
    }
    for (let time = 0; time < TIMES; time += 1) again.push(await ask(worker, withThreshold(0.4 + 0.04 * time)));
    await ask(worker, { type: 'think', setup: { preset: 'default', learning: 'fixed', overrides: {} } });
  }
  return { inside, again };
}

/** Ticks that a run drives, with or without questions on the way. */
async function driven(page: Page, worker: Worker, asks: boolean): Promise<number> {
  await page.evaluate(() => window.mapless?.restart());
  await page.evaluate(() => window.mapless?.play());
  await page.waitForFunction(() => (window.mapless?.state()?.tick ?? 0) > 10);
  const [began, until_ms] = [await tickOf(page), performance.now() + DRIVE_MS];
  const questions = Object.values(QUESTIONS);
  for (let time = 0; performance.now() < until_ms; time += 1) {
    const question = questions[time % questions.length]?.(time % TIMES);
    if (asks && question) await ask(worker, question);
    await page.waitForTimeout(EVERY_MS);
  }
  return (await tickOf(page)) - began;
}

await served(async (address) => {
  const browser = await chromium.launch(config.use?.launchOptions);
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  await page.goto(address);
  await page.waitForFunction(() => window.mapless?.state() !== undefined);
  const worker = page.workers().find((one) => one.url().includes('simulationWorker'));
  if (!worker) throw new Error('The page has no worker of the core.');
  await instrument(worker);
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.play());
  await page.waitForFunction((tick) => (window.mapless?.state()?.tick ?? 0) > tick, PLACES.at(-1) ?? 0);
  await page.evaluate(() => window.mapless?.pause());
  await page.keyboard.press('m');
  const { inside, again } = await standing(page, worker);
  const whole = Object.values(inside).flat();
  for (const [name, values] of [
    ...Object.entries(inside),
    ['all of these', whole],
    ['thinking again', again],
  ] as const) {
    const [median_ms, slow_ms, most_ms] = [0.5, 0.95, 1].map((share) => quantile(values, share).toFixed(1));
    process.stdout.write(`${name}: median ${median_ms} ms, 95 % within ${slow_ms} ms, most ${most_ms} ms\n`);
  }
  const within = quantile(whole, 0.95) <= GOALS_MS.inside && quantile(again, 0.5) <= GOALS_MS.again;
  process.stdout.write(
    `goals: 95 % inside within ${GOALS_MS.inside} ms, half of thinking again within ${GOALS_MS.again} ms\n`,
  );
  if (!within) process.exitCode = 1;
  await page.evaluate(() => window.mapless?.setSpeed(1));
  const [free, asked] = [await driven(page, worker, false), await driven(page, worker, true)];
  process.stdout.write(
    `ticks in ${DRIVE_MS / 1000} s: ${free} without questions, ${asked} with one every ${EVERY_MS} ms\n`,
  );
  if (asked < (1 - MOST_LOST) * free) process.exitCode = 1;
  await browser.close();
});
