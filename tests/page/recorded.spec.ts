/** A robot's recording in the page: what the robot saw and decided at any moment, and why a file is none. */

import { readFileSync } from 'node:fs';
import { McapStreamReader, McapWriter } from '@mcap/core';
import type { Page } from '@playwright/test';
import { DEVICES, faults } from './axe.ts';
import { drag, drawnIn, expect, file, misplaced, state, test, within } from './page.ts';

const KEPT = readFileSync('crate/recording/tests/kept/drive.mcap');

const panel = (page: Page) => page.getByRole('region', { name: 'Recording' });
const now = (page: Page) => page.locator('#scrub-now');
const scrub = (page: Page) => page.locator('#scrub');
const close = (page: Page) => page.getByRole('button', { name: 'Close the recording' });

/** Opens a recording and waits until all of it was decided again. */
async function open(page: Page, name: string, content: Buffer): Promise<void> {
  await page.locator('#files').setInputFiles(file(name, content));
  await expect(panel(page)).toContainText('of the decisions differ');
}

/** Presses buttons by their names, on a phone with a finger. */
const presser = (page: Page, phone: boolean) => (name: string) => {
  const button = page.getByRole('button', { name, exact: true });
  return phone ? button.tap() : button.click();
};

/** The same drive as the robot's own rosbag2 would have it: no decisions, and two clouds and two odometries, of which each second one is half as fast. */
async function foreign(): Promise<Buffer> {
  const parts: Uint8Array[] = [];
  const written = () => parts.reduce((sum, { length }) => sum + length, 0);
  const write = async (part: Uint8Array) => {
    parts.push(part.slice());
  };
  const writer = new McapWriter({ writable: { write, position: () => BigInt(written()) } });
  await writer.start({ profile: 'ros2', library: 'rosbag2' });
  const topics: Record<string, string[]> = {
    scan: ['/front/points', '/rear/points'],
    odometry: ['/odometry/filtered', '/platform/odometry'],
    imu: ['/imu/data'],
    goal_pose: ['/goal_pose'],
  };
  const [schemas, channels] = [new Map<number, number>(), new Map<number, number[]>()];
  const reader = new McapStreamReader();
  reader.append(KEPT);
  const passed = new Map<number, number>();
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
    if (record.type === 'Schema') schemas.set(record.id, await writer.registerSchema(record));
    else if (record.type === 'Channel') {
      const schemaId = schemas.get(record.schemaId) ?? 0;
      const given = { schemaId, messageEncoding: 'cdr', metadata: new Map() };
      const names = topics[record.topic.replace('/a200_0000/', '')] ?? [];
      channels.set(record.id, await Promise.all(names.map((topic) => writer.registerChannel({ ...given, topic }))));
    } else if (record.type === 'Message') {
      const [first, second] = channels.get(record.channelId) ?? [];
      if (first !== undefined) await writer.addMessage({ ...record, channelId: first });
      const count = passed.get(record.channelId) ?? 0;
      passed.set(record.channelId, count + 1);
      if (second !== undefined && count % 2 === 0) await writer.addMessage({ ...record, channelId: second });
    }
  }
  await writer.end();
  return Buffer.concat(parts);
}

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);

    test('a recording opens, is gone along, explains itself and gives the run back', async ({ mapless: page }) => {
      const phone = device === 'phone';
      const press = presser(page, phone);
      await page.evaluate(() => window.mapless?.pause());
      const before = await state(page);
      const title = await page.locator('#scene-title').textContent();
      await open(page, 'drive.mcap', KEPT);
      await expect(page.locator('#scrub-end')).toHaveText('0:02.5');
      await expect(panel(page)).toContainText('none of the decisions differ');
      await expect(panel(page)).toContainText('the emergency stop is silent');
      await expect(page.locator('#setup')).toBeHidden();

      // By finger or mouse along the slider.
      const [from, to] = [await within(scrub(page), 0.02, 0.5), await within(scrub(page), 0.7, 0.5)];
      if (phone) await drag(page, [from, to]);
      else {
        await page.mouse.move(from.x, from.y);
        await page.mouse.down();
        await page.mouse.move(to.x, to.y, { steps: 4 });
        await page.mouse.up();
      }
      await expect(now(page)).toHaveText(/^0:01\.[5-9]$/);
      await expect(panel(page)).toContainText('driving');
      await expect(panel(page)).toContainText('decided on');
      await expect(page.locator('#reason')).toContainText(/^(Heads|Straight|The goal)/);
      await expect(page.locator('#candidate-count')).toContainText('candidate');
      await drawnIn(page, '#variance', 20);
      await drawnIn(page, '#view', 20);
      expect(await faults(page)).toEqual([]);
      expect(await misplaced(page, false)).toEqual([]);

      // From scan to scan, which are a tenth of a second apart.
      const there = await now(page).textContent();
      await press('To the next scan');
      await expect(panel(page)).toContainText('0.01 s old');
      await press('To the next scan');
      await expect(now(page)).not.toHaveText(there ?? '');
      await press('To the scan before');
      await expect(now(page)).toHaveText(there ?? '');

      // The emergency stop is pressed at 2.2 s.
      await press('0:02.2 Aborted: the emergency stop is pressed');
      await expect(page.locator('#reason')).toHaveText('Goal given up; the emergency stop is pressed.');

      await press('Close the recording');
      await expect(panel(page)).toHaveCount(0);
      await expect(page.locator('#scene-title')).toHaveText(title ?? '');
      expect(await state(page)).toEqual(before);
      await press('One tick');
      await expect.poll(async () => (await state(page)).tick).toBe(before.tick + 1);
    });

    test('faults are put in by hand, and the supervisor stops the robot', async ({ mapless: page }) => {
      const press = presser(page, device === 'phone');
      await page.evaluate(() => window.mapless?.pause());
      await open(page, 'drive.mcap', KEPT);
      const supervisor = page.getByRole('region', { name: 'Supervisor' });
      const states = supervisor.getByRole('img');
      await expect(supervisor.getByRole('combobox', { name: 'Fault' }).getByRole('option')).toHaveCount(15);
      await expect(supervisor.getByRole('option', { name: '_' })).toHaveCount(0);
      await scrub(page).fill('15');
      await expect(states).toHaveAccessibleName(/in the state Driving.* what needs a reset → Latched/);

      await supervisor.getByRole('combobox', { name: 'Fault' }).selectOption('Somebody else publishes commands');
      await press('Put in at 0:01.5');
      await expect(states).toHaveAccessibleName(/in the state Latched.* reset → Aborted/);
      await expect(now(page)).toHaveText('0:02.0');
      await expect(panel(page)).toContainText('0:01.5 Latched: another publisher commands the robot');
      await expect(panel(page)).toContainText(/[1-9]\d* of the decisions differ/);
      await expect(page.locator('#reason')).toHaveText(
        'Stopped until it is reset; another publisher commands the robot.',
      );
      expect(await faults(page)).toEqual([]);
      expect(await misplaced(page, false)).toEqual([]);

      await press('Take out: Somebody else publishes commands, at 0:01.5 for 0.50 s');
      await expect(states).toHaveAccessibleName(/in the state Driving/);
      await expect(panel(page)).toContainText('none of the decisions differ');
      await expect(panel(page)).not.toContainText('Latched');
    });

    test('topics that cannot be told apart are asked for', async ({ mapless: page }) => {
      const phone = device === 'phone';
      const press = presser(page, phone);
      await page.evaluate(() => window.mapless?.pause());
      const before = await state(page);
      const form = page.getByRole('region', { name: 'Which topics?' });
      const scan = form.getByRole('combobox', { name: 'Scan' });
      const bag = file('bag.mcap', await foreign());
      await page.locator('#files').setInputFiles(bag);
      await expect(scan).toBeFocused();
      await expect(scan).toBeInViewport({ ratio: 1 });
      await expect(form.getByRole('button', { name: 'Open' })).toBeInViewport({ ratio: 1 });
      await expect(scan.getByRole('option')).toHaveText([/^\/front\/points \(\d+ messages\)$/, /^\/rear\/points \(/]);
      expect(await faults(page)).toEqual([]);
      expect(await misplaced(page, false)).toEqual([]);

      // Called off, the run is as it was.
      await press('Cancel');
      await expect(form).toHaveCount(0);
      expect(await state(page)).toEqual(before);
      await expect(page.locator('#setup')).toBeVisible();

      await page.locator('#files').setInputFiles(bag);
      await scan.selectOption('/rear/points');
      await press('Open');
      await expect(panel(page)).toContainText('decided by this page alone');
      await expect(form).toHaveCount(0);
      await expect(page.locator('#scrub-end')).toHaveText('0:02.5');
      // The rear cloud comes every 0.2 s.
      const there = await now(page).textContent();
      await press('To the next scan');
      await expect(now(page)).not.toHaveText(there ?? '');
      const at_s = (text: string | null) => Number(text?.replace('0:', ''));
      expect(at_s(await now(page).textContent()) - at_s(there)).toBeCloseTo(0.2, 1);
      await expect(panel(page)).toContainText('decided on');
      await expect(page.locator('#candidate-count')).toContainText('candidate');
      await drawnIn(page, '#variance', 20);
      await drawnIn(page, '#view', 20);
    });
  });
}

test('topics are chosen by keyboard, too; Escape and another file call the question off', async ({ mapless: page }) => {
  const form = page.getByRole('region', { name: 'Which topics?' });
  const bag = file('bag.mcap', await foreign());
  await page.locator('#files').setInputFiles(bag);
  await expect(form.getByRole('combobox', { name: 'Scan' })).toBeFocused();
  await page.keyboard.press('Escape');
  await expect(form).toHaveCount(0);

  await page.locator('#files').setInputFiles(bag);
  await expect(form).toHaveCount(1);
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await expect(form).toHaveCount(0);

  await page.locator('#files').setInputFiles(bag);
  await expect(form.getByRole('combobox', { name: 'Scan' })).toBeFocused();
  await page.keyboard.press('ArrowDown');
  for (let time = 0; time < 2; time += 1) await page.keyboard.press('Tab');
  await expect(form.getByRole('button', { name: 'Open' })).toBeFocused();
  await page.keyboard.press('Enter');
  await expect(panel(page)).toContainText('decided by this page alone');
});

test('by keyboard: play to the end, jump, step, arrow keys', async ({ mapless: page }) => {
  await open(page, 'drive.mcap', KEPT);
  await page.locator('#view').focus();
  await page.keyboard.press(' ');
  await expect(page.getByRole('button', { name: 'Pause' })).toBeVisible();
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible({ timeout: 60_000 });
  await expect(now(page)).toHaveText('0:02.5');
  await page.keyboard.press('j');
  await expect(now(page)).toHaveText('0:00.0');
  await page.keyboard.press('s');
  await expect(now(page)).not.toHaveText('0:00.0');
  await page.keyboard.press('k');
  await expect(now(page)).toHaveText('0:02.5');
  await scrub(page).focus();
  await page.keyboard.press('ArrowLeft');
  await expect(now(page)).toHaveText('0:02.4');
  // What changes a run does nothing.
  await page.locator('#view').focus();
  await page.keyboard.press('p');
  await page.keyboard.press('2');
  await expect(page.locator('#view')).toHaveAttribute('data-tool', 'look');
  await close(page).focus();
  await page.keyboard.press('Enter');
  await expect(panel(page)).toHaveCount(0);
});

test('a cut and a broken recording say why and play up to there', async ({ mapless: page }) => {
  await open(page, 'cut.mcap', KEPT.subarray(0, KEPT.length * 0.6));
  await expect(panel(page)).toContainText('The file is cut off: it ends within a record, at 0:01.');
  await page.keyboard.press('k');
  await expect(now(page)).toHaveText(/^0:01\.\d$/);

  const broken = Buffer.from(KEPT);
  const from = Math.floor(KEPT.length * 0.6);
  broken.fill(0xff, from, from + 64);
  await open(page, 'broken.mcap', broken);
  await expect(panel(page)).toContainText('The file cannot be read any further. broken.mcap: after message');
  await page.keyboard.press('k');
  await expect(now(page)).toHaveText(/^0:01\.\d$/);
});

test('what is no recording is refused, and the run stays as it is', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.pause());
  const before = await state(page);
  const text = page.locator('#notice-text');
  await page.locator('#files').setInputFiles(file('notes.mcap', 'no such thing'));
  await expect(text).toContainText('notes.mcap: ');
  await expect(text).toContainText('Expected an MCAP recording of mapless-node or of a robot (rosbag2)');
  expect(await state(page)).toEqual(before);
  await expect(panel(page)).toHaveCount(0);
});

test('opening a scenario closes the recording', async ({ mapless: page }) => {
  await open(page, 'drive.mcap', KEPT);
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await expect(panel(page)).toHaveCount(0);
  await expect(page.locator('#setup')).toBeVisible();
});
