/** An image says no metres: the page asks how it is to be read, shows what that gives, and writes it down. */

import { crc32, deflateSync } from 'node:zlib';
import type { Page } from '@playwright/test';
import { DEVICES, faults } from './axe.ts';
import { expect, file, ownOf, press, state, test, until } from './page.ts';

const SIDE = 41;

function chunk(type: string, body: Buffer): Buffer {
  const named = Buffer.concat([Buffer.from(type), body]);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(body.length);
  sum.writeUInt32BE(crc32(named));
  return Buffer.concat([length, named, sum]);
}

/** Grey from black in the west to white in the east, without a spacing; `holes` makes the north-western pixel transparent. */
function ramp(bits: 8 | 16, holes = false): Buffer {
  const head = Buffer.alloc(13);
  head.writeUInt32BE(SIDE, 0);
  head.writeUInt32BE(SIDE, 4);
  head.set([bits, holes ? 4 : 0, 0, 0, 0], 8);
  const most = 2 ** bits - 1;
  const row = (line: number) =>
    Array.from({ length: SIDE }, (_, column) => {
      const level = Math.round((column / (SIDE - 1)) * most);
      const alpha = line === 0 && column === 0 ? 0 : most;
      const numbers = holes ? [level, alpha] : [level];
      return numbers.flatMap((one) => (bits === 16 ? [one >> 8, one & 255] : [one]));
    }).flat();
  const lines = Array.from({ length: SIDE }, (_, line) => Buffer.from([0, ...row(line)]));
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  const data = deflateSync(Buffer.concat(lines));
  return Buffer.concat([signature, chunk('IHDR', head), chunk('IDAT', data), chunk('IEND', Buffer.alloc(0))]);
}

const sheet = (page: Page) => page.getByRole('dialog', { name: /^How high is/ });
const open = (page: Page, name: string, content: Buffer) => page.locator('#files').setInputFiles(file(name, content));
const heightAt = (page: Page, x: number) =>
  page.evaluate((place) => window.mapless?.heightAt(place) ?? Number.NaN, { x, y: 1 });

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);

    test('16 bits: asked for cell and heights, with a preview, and written down', async ({ mapless: page }) => {
      await open(page, 'slope.png', ramp(16));
      await expect(sheet(page)).toContainText('41 × 41 pixels of 16 bits');
      await expect(sheet(page)).toContainText('10.0 × 10.0 m, from 0.00 m to 65.54 m: 65.5 m of relief.');
      await expect(sheet(page).getByRole('img', { name: /^Preview: 10.0 × 10.0 m/ })).toBeVisible();
      expect(await faults(page)).toEqual([]);
      const part = (name: string) => sheet(page).getByLabel(name);
      await part('Cell size').fill('1');
      await part('Black is').fill('-1');
      await part('White is').fill('1.5');
      await expect(sheet(page)).toContainText('40.0 × 40.0 m, from −1.00 m to 1.50 m: 2.5 m of relief.');
      const act = sheet(page).getByRole('button', { name: 'Open' });
      await (device === 'phone' ? press(act) : act.click());
      await until(page, (now) => now.scenario === 'slope' && now.tick > 2);
      expect((await state(page)).ground).toEqual({ columns: SIDE, rows: SIDE, cell_m: 1 });
      expect(await heightAt(page, 0)).toBeCloseTo(-1, 4);
      expect(await heightAt(page, 40)).toBeCloseTo(1.5, 4);
      const recipe = 'cell_m = 1\nheight_min_m = -1\nheight_max_m = 1.5';
      expect((await ownOf(page))?.terrain).toMatchObject({
        recipe: expect.stringContaining(recipe),
        imported: { name: 'slope.png' },
      });
    });
  });
}

test('8 bits: opened with a warning of its steps, by keyboard', async ({ mapless: page }) => {
  await open(page, 'eight.png', ramp(8));
  await expect(sheet(page).getByRole('alert')).toHaveText(/^Only 256 heights fit into 8 bits: .* steps of 3\.9 cm\.$/);
  // Cell size, then black, then white.
  for (let tab = 0; tab < 2; tab += 1) await page.keyboard.press('Tab');
  await expect(sheet(page).getByLabel('White is')).toBeFocused();
  await page.keyboard.press('Control+A');
  await page.keyboard.type('2.55');
  await expect(sheet(page).getByRole('alert')).toContainText('steps of 1.0 cm');
  await page.keyboard.press('Enter');
  await until(page, (now) => now.scenario === 'eight');
  expect(await heightAt(page, 10)).toBeCloseTo(2.55, 4);
});

test('heights that make no sense and holes are said in the sheet; Escape changes nothing', async ({
  mapless: page,
}) => {
  const { scenario } = await state(page);
  await open(page, 'gap.png', ramp(16, true));
  const act = sheet(page).getByRole('button', { name: 'Open' });
  await expect(sheet(page).getByRole('alert')).toContainText('row 1, column 1 = transparent');
  await expect(act).toBeDisabled();
  await sheet(page).getByLabel('Holes').selectOption('fill');
  await expect(act).toBeEnabled();
  await sheet(page).getByLabel('White is').fill('-3');
  await act.click();
  await expect(sheet(page)).toBeVisible();
  expect(
    await sheet(page)
      .getByLabel('White is')
      .evaluate((input: HTMLInputElement) => input.validationMessage),
  ).toBe('White must be higher than black, which is 0 m.');
  await page.keyboard.press('Escape');
  await expect(sheet(page)).toHaveCount(0);
  expect((await state(page)).scenario).toBe(scenario);
});
