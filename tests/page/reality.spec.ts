/** Reality: presets and single effects by mouse, finger and keyboard; the believed pose; the ghost of an ideal world; links and files keep it. */

import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from '@playwright/test';
import { unzipSync } from 'fflate';
import { driven } from './commandLine.ts';
import {
  download,
  elsewhere,
  expect,
  fits,
  kept,
  loaded,
  misplaced,
  openLab,
  ownOf,
  press,
  runToEnd,
  shortCourse,
  state,
  still,
  test,
  until,
} from './page.ts';

const preset = (page: Page, name: string) =>
  page.getByRole('group', { name: 'How hard the world is' }).getByRole('button', { name });
const group = (page: Page, name: string) => page.locator('.reality-effects summary', { hasText: name });
const count = (page: Page, name: string) => group(page, name).locator('.parameter-count');
const card = (page: Page) =>
  page.locator('.parameter-group', { has: page.locator('> summary h3', { hasText: /^Reality$/ }) });
const said = (page: Page) => card(page).locator('> summary .parameter-count');
const believed = (page: Page) => page.locator('#view-key li', { hasText: 'believed' });

test('with a mouse: presets, one effect by itself, back again, and undo', async ({ mapless: page }) => {
  const { scenario, seed } = await state(page);
  await openLab(page, 'Parameters');
  await expect(said(page)).toHaveText('ideal');
  await expect(believed(page)).toBeHidden();
  await preset(page, 'field').click();
  await until(page, (now) => now.reality === 'field' && now.tick > 5);
  expect(await state(page)).toMatchObject({ scenario, seed, overrides: { reality: { preset: 'field' } } });
  await expect(preset(page, 'field')).toHaveAttribute('aria-pressed', 'true');
  await expect(said(page)).toHaveText('field');
  await expect(count(page, 'Sensing')).toHaveText(/^\d+ on$/);
  await expect(believed(page)).toHaveText(/^believed\d\.\d\d m off$/);

  // An effect says what it does, in which unit, and what each preset gives.
  await group(page, 'Motion').click();
  const latency = page.locator('.parameter', { has: page.locator('[id="reality.motion.latency_s"]') });
  await expect(latency).toContainText('Dead time');
  await expect(latency).toContainText('Ideal 0 · field 0.1 · harsh 0.2');
  await expect(latency.locator('.parameter-unit').first()).toHaveText('s');
  await group(page, 'Sensing').click();
  await page.getByRole('checkbox', { name: 'zeros', exact: true }).check();
  await until(page, (now) => now.reality === 'own' && now.seed === seed);
  expect((await state(page)).overrides).toEqual({ reality: { preset: 'field', sensing: { zeros: true } } });
  await expect(said(page)).toHaveText('own');
  for (const name of ['ideal', 'field', 'harsh']) {
    await expect(preset(page, name)).toHaveAttribute('aria-pressed', 'false');
  }
  await expect(count(page, 'Sensing')).toContainText('1 changed');
  await page.getByRole('button', { name: 'Reset zeros' }).click();
  await until(page, (now) => now.reality === 'field');

  await preset(page, 'ideal').click();
  await until(page, (now) => now.reality === 'ideal');
  expect((await state(page)).overrides).toEqual({});
  await expect(believed(page)).toBeHidden();
  await page.locator('#undo').click();
  await until(page, (now) => now.reality === 'field');
  await expect(said(page)).toHaveText('field');
});

test('by keyboard: a preset, a number and a switch', async ({ mapless: page }) => {
  await page.keyboard.press('p');
  await expect(page.getByRole('tab', { name: 'Parameters' })).toBeFocused();
  await preset(page, 'harsh').focus();
  await page.keyboard.press('Enter');
  await until(page, (now) => now.reality === 'harsh');
  await expect(preset(page, 'harsh')).toBeFocused();
  await group(page, 'Motion').focus();
  await page.keyboard.press('Enter');
  const friction = page.getByRole('spinbutton', { name: 'friction' });
  await friction.focus();
  await page.keyboard.press('Control+A');
  await page.keyboard.type('0.7');
  await page.keyboard.press('Enter');
  await until(
    page,
    (now) => JSON.stringify(now.overrides) === '{"reality":{"preset":"harsh","motion":{"friction":0.7}}}',
  );
  await expect(friction).toBeFocused();
  await page.getByRole('checkbox', { name: 'touches ground' }).focus();
  await page.keyboard.press('Space');
  await until(page, (now) => JSON.stringify(now.overrides).includes('"touches_ground":false'));
  expect((await state(page)).reality).toBe('own');
  // What makes no sense is refused at its field.
  await friction.fill('-1');
  await friction.press('Enter');
  await expect(page.locator('.parameter-fault:visible')).toContainText('reality.motion.friction = -1: expected');
});

test('what the robot believes differs from where it is, and is drawn', async ({ mapless: page }) => {
  await page.evaluate(() =>
    window.mapless?.setOverrides({ reality: { pose: { roll_bias_rad: 0.05, pitch_bias_rad: 0.05 } } }),
  );
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.play());
  await until(page, ({ tick }) => tick > 60);
  await still(page);
  const { pose, believed: its } = await state(page);
  if (!its) throw new Error('It believes nothing.');
  expect(its.pitch - pose.pitch).toBeCloseTo(0.05, 6);
  const apart_m = Math.hypot(its.x - pose.x, its.y - pose.y, its.z - pose.z);
  expect(apart_m).toBeGreaterThan(0.1);
  await expect(believed(page)).toHaveText(`believed${apart_m.toFixed(2)} m off`);
  // Pixels of its colour, of which there are none where it cannot err.
  expect(await pixelsOf(page)).toBeGreaterThan(30);
  await page.evaluate(() => window.mapless?.setOverrides({ reality: { motion: { friction: 0.9 } } }));
  await still(page);
  expect((await state(page)).believed).toBeUndefined();
  expect(await pixelsOf(page)).toBeLessThan(5);
});

/** How many pixels of the view have the colour of the believed robot's outline. */
async function pixelsOf(page: Page): Promise<number> {
  const png = await page.locator('#view').screenshot();
  return page.evaluate(async (base64) => {
    const hex = getComputedStyle(document.documentElement).getPropertyValue('--believed').trim();
    const wanted = [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16));
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context?.drawImage(image, 0, 0);
    // Without the key, which has the same colour.
    const data = context?.getImageData(0, 0.25 * image.height, image.width, 0.6 * image.height).data ?? [];
    let found = 0;
    for (let at = 0; at < data.length; at += 4) {
      if (wanted.every((value, channel) => Math.abs((data[at + channel] ?? 0) - value) <= 6)) found += 1;
    }
    return found;
  }, png.toString('base64'));
}

test('the ghost of an ideal world drives as the robot would if nothing went wrong', async ({ mapless: page }) => {
  await shortCourse(page, 3, 2);
  await openLab(page, 'Parameters');
  await preset(page, 'field').click();
  await until(page, (now) => now.reality === 'field');
  await page.getByRole('checkbox', { name: 'Ghost of an ideal world beside it' }).check();
  await runToEnd(page);
  await page.getByRole('tab', { name: 'Compare' }).click();
  const table = page.locator('.comparison').first();
  const cell = (name: string) => table.getByRole('row', { name }).getByRole('cell').nth(1);
  await expect(table.getByRole('columnheader').nth(1)).toHaveText('Ideal');
  await expect(cell('Outcome')).toHaveText('Goal reached');
  await expect(cell('Curvature change')).not.toHaveText(/\(0\.0+\)$/);
  // In an ideal world there is no difference.
  await page.getByRole('tab', { name: 'Parameters' }).click();
  await preset(page, 'ideal').click();
  await until(page, (now) => now.reality === 'ideal');
  await runToEnd(page);
  await page.getByRole('tab', { name: 'Compare' }).click();
  await expect(cell('Outcome')).toHaveText('Goal reached');
  for (const name of ['Distance', 'Vibration', 'Curvature change']) await expect(cell(name)).toHaveText(/\(0\.0+\)$/);
  // The switch and the list of planners are the same choice.
  await page.getByRole('checkbox', { name: /^Ideal/ }).uncheck();
  await page.getByRole('tab', { name: 'Parameters' }).click();
  await expect(page.getByRole('checkbox', { name: 'Ghost of an ideal world beside it' })).not.toBeChecked();
});

test('a link, the next visit and files keep it, and the command line drives the same way', async ({
  mapless: page,
  browser,
  baseURL,
}) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 3 }));
  await shortCourse(page, 3);
  const reality = { preset: 'field', motion: { friction: 0.7 }, sensing: { zeros: true } };
  await page.evaluate((values) => window.mapless?.setOverrides({ reality: values }), reality);
  const run = await runToEnd(page);
  const own = await ownOf(page);
  expect(await kept(page)).toEqual(own);
  const link = await page.evaluate(() => window.mapless?.link());
  const other = await elsewhere(browser, baseURL);
  await other.goto(link ?? '');
  await loaded(other);
  expect(await ownOf(other)).toEqual(own);
  expect((await state(other)).reality).toBe('own');
  expect(await runToEnd(other)).toEqual(run);
  await other.context().close();

  await page.locator('#share').click();
  const { bytes } = await download(page, 'save-scenario');
  const folder = test.info().outputPath();
  for (const [name, content] of Object.entries(unzipSync(bytes))) writeFileSync(join(folder, name), content);
  expect(readFileSync(join(folder, 'scenario.toml'), 'utf8')).toContain('[reality]\npreset = "field"');
  const { outcome, ticks, digest } = driven(join(folder, 'scenario.toml'));
  expect({ outcome, ticks, digest }).toEqual(run);
  await page.getByRole('button', { name: 'Close' }).click();

  await page.reload();
  await loaded(page);
  expect((await state(page)).overrides).toEqual({ reality });
  await page.evaluate(() => window.mapless?.setOverrides({}));
  await page.locator('#terrains').click();
  await page.setInputFiles('#files', { name: 'it.zip', mimeType: 'application/zip', buffer: bytes });
  await until(page, (now) => now.reality === 'own');
  expect((await state(page)).overrides).toEqual({ reality });
});

test('terrains of each family come with their objects, and a link keeps them', async ({ mapless: page }) => {
  const families = await page.locator('#family option').allTextContents();
  expect(families).toEqual(['easy', 'moderate', 'hard', 'rocks', 'posts', 'walls', 'ditches', 'mixed', 'movers']);
  await page.locator('#terrains').click();
  await page.selectOption('#family', 'movers');
  await expect(page.locator('#generated-cards .card-title')).toHaveText(['Seed 1', 'Seed 2', 'Seed 3', 'Seed 4']);
  await page.locator('#generated-cards button').nth(1).click();
  await until(page, (now) => now.scenario === 'movers 2' && now.tick > 5);
  const { objects } = await state(page);
  expect(objects.some((object) => 'walk' in object && object.walk !== undefined)).toBe(true);
  const link = await page.evaluate(() => window.mapless?.link());
  await page.goto('about:blank');
  await page.goto(link ?? '');
  await loaded(page);
  expect((await state(page)).objects).toEqual(objects);
  await page.evaluate(() => window.mapless?.loadScenario('posts-1-0001'));
  await until(page, (now) => now.scenario === 'posts-1-0001' && now.objects.length > 5);
  expect((await state(page)).overrides).toEqual({ reality: { motion: { touches_ground: true } } });
});

test.describe('with a finger', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('a preset and a switch, and nothing covers anything', async ({ mapless: page }) => {
    await openLab(page, 'Parameters', 'tap');
    for (const name of ['ideal', 'field', 'harsh']) await fits(preset(page, name));
    await press(preset(page, 'harsh'));
    await until(page, (now) => now.reality === 'harsh' && now.tick > 5);
    await press(group(page, 'Sensing'));
    const sweep = page.locator('[id="reality.sensing.sweep"]');
    await expect(sweep).toBeChecked();
    await sweep.tap();
    await until(page, (now) => now.reality === 'own');
    await press(page.locator('.reality-ghost'));
    await expect(page.getByRole('checkbox', { name: 'Ghost of an ideal world beside it' })).toBeChecked();
    await press(page.locator('.lab-close'));
    await until(page, (now) => now.tick > 5);
    await still(page);
    await expect(believed(page)).toBeVisible();
    expect(await misplaced(page, true)).toEqual([]);
    await page.locator('label.tool', { hasText: 'Objects' }).tap();
    await page.locator('#result-words').evaluate((words) => words.replaceChildren('Tilt limit exceeded'));
    await page.locator('#result').evaluate((result) => result.removeAttribute('hidden'));
    expect(await misplaced(page, true), 'objects and a result').toEqual([]);
  });
});
