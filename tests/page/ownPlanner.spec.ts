/** Somebody's own planner drives beside the robot of the page, and whatever is wrong with it harms nothing. */

import { readFileSync } from 'node:fs';
import type { Page } from '@playwright/test';
import { DEVICES, faults } from './axe.ts';
import { driveTo, expect, file, fits, loaded, openLab, ownOf, shortCourse, state, test, until } from './page.ts';

const tab = (page: Page) => page.getByRole('tabpanel', { name: 'Compare' });
const card = (page: Page) => tab(page).locator('.own-planner');
const fault = (page: Page) => card(page).getByRole('alert');
const code = (page: Page) => tab(page).getByLabel('Your planner, in JavaScript');
/** Of the planner alone; the robot in view has the first column. */
const own = (page: Page, row: string) =>
  tab(page)
    .getByRole('row', { name: new RegExp(`^${row}`) })
    .locator('td')
    .last();

async function open(page: Page, press: 'click' | 'tap' = 'click'): Promise<void> {
  await openLab(page, 'Compare', press);
  await card(page).getByRole('heading', { name: 'Your own planner' })[press]();
}

async function drive(page: Page, source: string, press: 'click' | 'tap' = 'click'): Promise<void> {
  await code(page).fill(source);
  await card(page).getByRole('button', { name: 'Drive it' })[press]();
}

/** Straight at the goal, with a line of its own in each decision. */
const straight = (line: string) => `export default ({ pose, goal, time_s }) => {
  ${line}
  const bearing = Math.atan2(goal.y - pose.y, goal.x - pose.x) - pose.yaw;
  return { linear_m_s: 0.8, angular_rad_s: Math.atan2(Math.sin(bearing), Math.cos(bearing)) };
};`;

const WASM = readFileSync('web/src/wasm/planner_template.wasm');

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);
    const press = device === 'phone' ? 'tap' : 'click';

    test('the example drives to the goal, by the same metrics', async ({ mapless: page }) => {
      await shortCourse(page, 4);
      await open(page, press);
      await card(page).getByRole('button', { name: 'Drive it' })[press]();
      await expect(tab(page).getByRole('checkbox', { name: /^Yours/ })).toBeChecked();
      await page.evaluate(() => window.mapless?.play());
      await until(page, (now) => now.outcome === 'reached');
      await expect(own(page, 'Outcome')).toHaveText('Goal reached');
      await expect(own(page, 'Distance')).toHaveText(/^3\.\d+ \([+-]?\d\.\d+\)$/);
      await expect(card(page).getByRole('status')).toHaveText(/^planner\.js takes \d+\.\d ms for a decision\.$/);
      expect(await faults(page)).toEqual([]);
      if (device !== 'phone') return;
      await drive(page, straight('throw new RangeError("no way");'), press);
      await page.evaluate(() => window.mapless?.restart());
      await page.evaluate(() => window.mapless?.play());
      await expect(fault(page)).toHaveText(/^planner\.js at 0\.0 s: RangeError: no way \(line 2\)$/);
      await fits(fault(page));
    });
  });
}

test('what goes wrong in a decision is said with its time, and the run goes on', async ({ mapless: page }) => {
  await shortCourse(page, 2);
  await open(page);
  for (const [line, said] of [
    ['if (time_s > 0.35) throw new RangeError("no way");', /^planner\.js at 0\.4 s: RangeError: no way \(line 2\)$/],
    ['return { linear_m_s: 0 / 0, angular_rad_s: 0 };', /at 0\.0 s: linear_m_s = NaN: expected a finite number/],
    ['return 7;', /at 0\.0 s: linear_m_s = absent: expected a finite number/],
    ['return { linear_m_s: 1 };', /at 0\.0 s: angular_rad_s = absent: expected a finite number/],
    ['return { linear_m_s: () => 1, angular_rad_s: 0 };', /at 0\.0 s: DataCloneError/],
    ['for (;;);', /at 0\.0 s: a decision took longer than 5 s: it was stopped/],
  ] as const) {
    await drive(page, straight(line));
    await page.evaluate(() => window.mapless?.restart());
    await page.evaluate(() => window.mapless?.play());
    await expect(fault(page)).toHaveText(said);
    await until(page, (now) => now.outcome === 'reached');
    await expect(own(page, 'Outcome')).toHaveText('Broke off');
  }
  await drive(page, straight(''));
  await expect(own(page, 'Outcome')).toHaveText('Goal reached');
  await expect(fault(page)).toBeHidden();
});

test('what is no planner is said, and code gets nowhere else', async ({ page, baseURL }) => {
  await page.goto('/');
  await loaded(page);
  const fetched: string[] = [];
  page.on('response', (response) => fetched.push(response.url()));
  await shortCourse(page, 4);
  await open(page);
  for (const [source, said] of [
    ['export const planner = 1;', /no default export: expected a class with decide\(\), or a function/],
    ['export default (', /SyntaxError/],
    ['for (;;);', /opening it took longer than 15 s/],
    [`import "${baseURL}/favicon.svg?imported";`, /Failed to fetch/],
    [`await fetch("${baseURL}/favicon.svg?fetched", { mode: "no-cors" });`, /TypeError: Failed to fetch/],
    ['indexedDB.open("mapless");', /SecurityError/],
    ['new Function("1")();', /EvalError/],
  ] as const) {
    await drive(page, source);
    await expect(fault(page)).toHaveText(said);
  }
  expect(fetched.filter((url) => /\?(imported|fetched)$/.test(url))).toEqual([]);
});

test('the template in WebAssembly drives when it is dropped; what lacks a function or traps is said', async ({
  mapless: page,
}) => {
  await shortCourse(page, 4);
  const input = page.locator('#files');
  await input.setInputFiles(file('template.wasm', WASM));
  await expect(tab(page).getByRole('checkbox', { name: /^Yours/ })).toBeChecked();
  await page.evaluate(() => window.mapless?.play());
  await expect(own(page, 'Outcome')).toHaveText('Goal reached');
  await expect(card(page).getByRole('status')).toHaveText(/^template\.wasm takes/);
  await input.setInputFiles(file('empty.wasm', Buffer.from([0, 97, 115, 109, 1, 0, 0, 0])));
  await expect(fault(page)).toHaveText(/^empty\.wasm .*no export points, decide, linear_m_s, angular_rad_s, memory/);
  await input.setInputFiles(file('cut.wasm', WASM.subarray(0, 5000)));
  await expect(fault(page)).toHaveText(/^cut\.wasm .*CompileError/);
});

/** A planner in WebAssembly that begins with so many pages of 64 KiB and takes so many more with each decision. */
function greedy(pages: number, more: number): Buffer {
  const leb = (value: number): number[] => (value < 64 ? [value] : [(value & 0x7f) | 0x80, ...leb(value >> 7)]);
  const section = (id: number, ...content: number[]) => [id, ...leb(content.length), ...content];
  const exported = (name: string, kind: number, index: number) => [name.length, ...Buffer.from(name), kind, index];
  const body = (...code: number[]) => [code.length + 2, 0, ...code, 0x0b];
  const half = [0x44, 0, 0, 0, 0, 0, 0, 0xe0, 0x3f];
  return Buffer.from([
    ...[0, 0x61, 0x73, 0x6d, 1, 0, 0, 0],
    // points(count) → i32, decide(), and two numbers.
    ...section(1, 3, 0x60, 1, 0x7f, 1, 0x7f, 0x60, 0, 0, 0x60, 0, 1, 0x7c),
    ...section(3, 4, 0, 1, 2, 2),
    ...section(5, 1, 0, ...leb(pages)),
    ...section(
      7,
      5,
      ...exported('memory', 2, 0),
      ...['points', 'decide', 'linear_m_s', 'angular_rad_s'].flatMap((name, index) => exported(name, 0, index)),
    ),
    ...section(10, 4, ...body(0x41, 0), ...body(0x41, ...leb(more), 0x40, 0, 0x1a), ...body(...half), ...body(...half)),
  ]);
}

test('a planner in WebAssembly whose memory grows without end is ended with a reason', async ({ mapless: page }) => {
  await shortCourse(page, 4);
  const input = page.locator('#files');
  await input.setInputFiles(file('large.wasm', greedy(5000, 0)));
  await expect(fault(page)).toHaveText(/^large\.wasm .*its memory is 313 MiB: expected at most 256 MiB/);
  // 2 MiB to begin with, and 100 MiB with each decision.
  await input.setInputFiles(file('greedy.wasm', greedy(32, 1600)));
  await page.evaluate(() => window.mapless?.play());
  await expect(fault(page)).toHaveText(
    /^greedy\.wasm at 0\.2 s: Error: its memory is 302 MiB: expected at most 256 MiB/,
  );
  await until(page, (now) => now.outcome === 'reached');
});

test('links and files of the run say nothing of it; what was written is there at the next visit', async ({
  mapless: page,
}) => {
  await shortCourse(page, 4);
  const before = await page.evaluate(() => window.mapless?.link());
  const experiment = await ownOf(page);
  await page.keyboard.press('p');
  await expect(page.getByRole('tab', { name: 'Parameters' })).toBeFocused();
  await page.keyboard.press('ArrowRight');
  await card(page).locator('summary').focus();
  await page.keyboard.press('Enter');
  await code(page).focus();
  await page.keyboard.press('Control+A');
  // With letters that are keys of the page elsewhere.
  await page.keyboard.type('export default () => ({ linear_m_s: 0.5, angular_rad_s: 0 }); // grcdb');
  await card(page).getByRole('button', { name: 'Drive it' }).focus();
  await page.keyboard.press('Enter');
  await page.evaluate(() => window.mapless?.play());
  await driveTo(page, 20);
  await expect(own(page, 'Time')).toHaveText(/^0:0[2-9]/);
  expect(await page.evaluate(() => window.mapless?.link())).toBe(before);
  expect(await ownOf(page)).toEqual(experiment);
  expect((await state(page)).preset).toBe('default');
  await page.reload();
  await loaded(page);
  await open(page);
  await expect(code(page)).toHaveValue(/grcdb$/);
});
