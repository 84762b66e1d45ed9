import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test as base, expect } from '@playwright/test';
import { preview } from 'vite';
import { driven } from './commandLine.ts';
import { FIREFOX, Firefox } from './firefox.ts';
import { kept, runToEnd, shortCourse, state, until } from './page.ts';

/** Opens an address and waits for the first scenario. */
async function opened(address: string): Promise<Firefox> {
  const firefox = await Firefox.open(FIREFOX ?? '', address);
  await loaded(firefox);
  return firefox;
}

function loaded(firefox: Firefox): Promise<void> {
  return expect.poll(() => firefox.evaluate(() => window.mapless?.state() !== undefined)).toBe(true);
}

/** The page, in a Firefox of its own; the test fails when a script throws. */
const test = base.extend<{ firefox: Firefox }>({
  firefox: async ({ baseURL }, use) => {
    const firefox = await opened(baseURL ?? '');
    try {
      await use(firefox);
      expect(firefox.faults).toEqual([]);
    } finally {
      await firefox.close();
    }
  },
});

test.describe('in Firefox', () => {
  test.skip(!FIREFOX, 'No Firefox was found: install it, or name it in the environment variable FIREFOX.');

  test('a run has the digest and the trajectory of the command line', async ({ firefox }) => {
    await firefox.evaluate(() => window.mapless?.loadScenario('ht', { seed: 3 }));
    const { outcome, digest } = await runToEnd(firefox);
    const out = test.info().outputPath();
    const run = driven('terrains/scenarios/ht.toml', '--seed', '3', '--out', out);
    expect({ outcome, digest }).toEqual({ outcome: run.outcome, digest: run.digest });
    await firefox.click('#save-csv');
    const csv = await firefox.saved('mapless-ht-seed3-trajectory.csv');
    expect(csv).toBe(readFileSync(join(out, 'trajectory.csv'), 'utf8'));
  });

  test('ground and goal change, are undone, and the page says what it cannot do', async ({ firefox }) => {
    await firefox.evaluate(() => window.mapless?.pause());
    const height = () => firefox.evaluate(() => window.mapless?.heightAt({ x: 30, y: 30 }) ?? Number.NaN);
    const before = await height();
    const stroke = { kind: 'raise', radius_m: 2, strength_m: 0.5, points_cm: [3000, 3000] } as const;
    await firefox.evaluate((one) => window.mapless?.sculpt(one), stroke);
    expect(await height()).toBeCloseTo(before + 0.5, 3);
    await firefox.evaluate(() => window.mapless?.undo());
    expect(await height()).toBe(before);
    await firefox.evaluate(() => window.mapless?.setGoal({ x: 30, y: 31 }));
    expect((await state(firefox)).goal).toEqual({ x: 30, y: 31 });
    // Where nothing draws WebGL, as in a Firefox without a screen, the view says so; and nothing else is amiss.
    const graphics = () => document.createElement('canvas').getContext('webgl2') !== null;
    const missing = () => getComputedStyle(document.getElementById('no-view') as Element).display !== 'none';
    await expect.poll(() => firefox.evaluate(missing)).toBe(!(await firefox.evaluate(graphics)));
    expect(await firefox.evaluate(() => document.getElementById('notice')?.hidden)).toBe(true);
  });

  test('it drives, stands, goes back in time, and the plots follow', async ({ firefox }) => {
    await until(firefox, ({ tick }) => tick > 20);
    await firefox.click('#play');
    await until(firefox, ({ playing }) => !playing);
    // A frame may be on its way.
    await firefox.evaluate(() => window.mapless?.pause());
    const { tick } = await state(firefox);
    await firefox.evaluate(() => window.mapless?.step());
    expect((await state(firefox)).tick).toBe(tick + 1);
    const lines = () => [...document.querySelectorAll('.plot-line')].map((line) => line.getAttribute('d') ?? '');
    // What is out of sight is not drawn.
    await firefox.evaluate(() => document.getElementById('plots')?.scrollIntoView());
    const drawn = async () => (await firefox.evaluate(lines)).filter((line) => /^M.*L.*L/.test(line)).length;
    await expect.poll(drawn).toBe(5);
    await firefox.evaluate(() => window.mapless?.seek(7));
    expect(await firefox.evaluate(() => document.getElementById('time')?.textContent)).toBe('0:00.7');
  });

  test('a link opens the experiment, and the next visit goes on where one left off', async ({ firefox, baseURL }) => {
    const experiment = () => firefox.evaluate(() => window.mapless?.experiment());
    await firefox.evaluate(() => window.mapless?.pause());
    await firefox.evaluate(() => window.mapless?.loadScenario('gsb', { seed: 11 }));
    await firefox.evaluate(() => window.mapless?.setGoal({ x: 30, y: 31 }));
    const shared = await experiment();
    const link = await firefox.evaluate(() => window.mapless?.link());
    await firefox.evaluate(() => window.mapless?.loadScenario('vta'));
    // What is only looked at is not kept.
    await firefox.evaluate(() => window.mapless?.setGoal({ x: 30, y: 31 }));
    const own = await kept(firefox);
    expect(own).not.toEqual(shared);
    await firefox.goto('about:blank');
    await firefox.goto(link ?? '');
    await loaded(firefox);
    expect(await experiment()).toEqual(shared);
    await firefox.evaluate(() => window.mapless?.undo());
    expect(await kept(firefox)).toEqual(own);
    await firefox.goto('about:blank');
    await firefox.goto(baseURL ?? '');
    await loaded(firefox);
    expect(await experiment()).toEqual(own);
  });

  test('a batch of seeds runs beside the page', async ({ firefox }) => {
    await shortCourse(firefox, 3);
    await firefox.click('#lab');
    await firefox.click('[role=tab]:nth-of-type(3)');
    await firefox.evaluate(() => {
      const count = document.getElementById('seeds-how-many');
      if (count instanceof HTMLInputElement) count.value = '3';
    });
    await firefox.click('[role=tabpanel]:not([hidden]) .lab-action');
    const text = (selector: string) =>
      firefox.evaluate((asked) => document.querySelector(asked)?.textContent, selector);
    await expect.poll(() => text('.seeds-summary')).toContain('3 of 3 (95 %: 44 % to 100 %)');
    expect(await text('.trials-table tbody')).toMatch(/^1Goal reached.*2Goal reached.*3Goal reached/);
  });
});

test('in Firefox, after the first visit, the page opens and drives without a network', async () => {
  test.skip(!FIREFOX, 'No Firefox was found.');
  // A server of its own, that can go away.
  const server = await preview({ preview: { host: '127.0.0.1', port: 0 } });
  const address = server.resolvedUrls?.local[0] ?? '';
  const firefox = await opened(address);
  try {
    await firefox.evaluate(() => navigator.serviceWorker.ready.then(() => true));
    await server.close();
    await firefox.goto(`${address}?again`);
    await loaded(firefox);
    await until(firefox, ({ tick }) => tick > 3);
    // What is loaded only when it is asked for is there, too.
    await firefox.evaluate(() => window.mapless?.loadScenario('vta'));
    expect((await state(firefox)).scenario).toBe('vta');
  } finally {
    await firefox.close();
  }
});
