import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { deflateRawSync } from 'node:zlib';
import type { Page } from '@playwright/test';
import { unzipSync } from 'fflate';
import { driven, said } from './commandLine.ts';
import { driveTo, elsewhere, expect, kept, loaded, runToEnd, shortCourse, state, test, until } from './page.ts';

/** A boulder and a rough patch ahead of the start of `ht`, another goal with a heading behind a waypoint, and another parameter. */
async function shape(page: Page): Promise<void> {
  await page.evaluate(async () => {
    const { mapless } = window;
    await mapless?.loadScenario('ht', { seed: 3 });
    await mapless?.pause();
    const { x, y } = mapless?.experiment()?.start ?? { x: 0, y: 0 };
    const at = (east: number, north: number) => [Math.round(100 * (x + east)), Math.round(100 * (y + north))];
    await mapless?.sculpt({ kind: 'boulder', radius_m: 1.5, strength_m: 0.8, points_cm: at(4, 3) });
    const rough = { kind: 'roughen' as const, radius_m: 3, strength_m: 0.05, seed: 9 };
    await mapless?.sculpt({ ...rough, points_cm: [...at(2, 2), ...at(3, 2)] });
    await mapless?.setGoal({ x: x + 1, y: y + 4, heading_rad: 2 }, [{ x: x + 1.5, y: y + 1.5 }]);
    await mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } });
    await mapless?.restart();
  });
}

test('a link drives the same run in another profile, and so does the command line', async ({
  mapless: page,
  browser,
  baseURL,
}) => {
  await shape(page);
  const run = await runToEnd(page);
  await page.getByRole('button', { name: 'Share and save' }).click();
  await expect(page.locator('#link')).toHaveValue(/#e=./);
  const link = await page.locator('#link').inputValue();
  expect(link.length).toBeLessThan(700);
  const [zipped] = await Promise.all([page.waitForEvent('download'), page.locator('#save-scenario').click()]);
  expect(zipped.suggestedFilename()).toBe('ht.zip');

  const folder = test.info().outputPath();
  const files = unzipSync(readFileSync(await zipped.path()));
  for (const [name, bytes] of Object.entries(files)) writeFileSync(join(folder, name), bytes);
  const { outcome, ticks, digest } = driven(join(folder, 'scenario.toml'));
  expect({ outcome, ticks, digest }).toEqual(run);

  const other = await elsewhere(browser, baseURL);
  await other.goto(link);
  await loaded(other);
  expect(await runToEnd(other)).toEqual(run);
  await other.close();
});

test('hostile and broken links say so, and lose nothing', async ({ page }) => {
  await page.goto('/');
  await loaded(page);
  await page.locator('#view').click();
  await shape(page);
  const own = await kept(page);
  const bomb = deflateRawSync(new Uint8Array(64 << 20)).toString('base64url');
  const links: [link: string, words: string][] = [
    ['#e=AAAA', 'damaged or was cut short'],
    [`#e=${bomb}`, 'unpacks to more than 4 MB'],
    [`#e=${deflateRawSync('{"version":7}').toString('base64url')}`, 'version = 7'],
    ['?scenario=atlantis', 'atlantis'],
    ['?scenario=hard-1-7', 'expected the name of a generated task, such as "hard-1-0007"'],
    ['?scenario=ht&reality=real', '?reality = "real": expected ideal or field or harsh'],
    ['?scenario=ht&seed=1.5', '?seed = "1.5": expected a whole number'],
  ];
  for (const [link, words] of links) {
    await page.goto('about:blank');
    await page.goto(`/${link}`);
    await expect(page.locator('#notice-text')).toContainText(words);
    expect(await page.evaluate(() => window.mapless?.experiment())).toEqual(own);
  }
});

test('small links to hours of work are refused', async ({ page }) => {
  await page.goto('/');
  await loaded(page);
  const experiment = await page.evaluate(() => window.mapless?.experiment());
  const open = async (part: object) => {
    const json = JSON.stringify({ ...experiment, ...part });
    await page.goto('about:blank');
    await page.goto(`/#e=${deflateRawSync(json).toString('base64url')}`);
  };
  const hill = '[[hill]]\ncentre = [1, 1]\nheight_m = 0\nradius_m = 1000\n';
  const recipe = `name = "a"\nsize_m = [800.0, 800.0]\ncell_m = 0.2\n${hill.repeat(8000)}`;
  await open({ terrain: { recipe } });
  await expect(page.locator('#notice-text')).toContainText('hill[15].samples touched = 256128016: expected at most');
  // As many samples as an integer of 32 bits holds, and one more. Links hold each touch as the step from the one before.
  const largest = 'name = "a"\nsize_m = [819.0, 819.0]\ncell_m = 0.2\n';
  const points_cm = [100, 100, ...new Array(2 * 255).fill(0)];
  await open({ terrain: { recipe: largest }, strokes: [{ kind: 'lower', radius_m: 1000, strength_m: 0, points_cm }] });
  await expect(page.locator('#notice-text')).toContainText('stroke[1].samples touched = ');
  await until(page, ({ tick }) => tick > 3);
});

test('the page continues where it was left, and starts afresh when asked', async ({ page }) => {
  await page.goto('/');
  await loaded(page);
  await page.locator('#view').click();
  await shape(page);
  const own = await kept(page);
  await page.reload();
  await loaded(page);
  await expect(page.locator('#notice')).toContainText('where you left off');
  expect(await page.evaluate(() => window.mapless?.experiment())).toEqual(own);
  await page.getByRole('button', { name: 'Start afresh' }).click();
  await until(page, (now) => now.scenario === 'cht-ad');
  await page.locator('#undo').click();
  await until(page, (now) => now.scenario === 'ht');
});

test('a scenario by name, in another page’s frame', async ({ page }) => {
  await page.goto('/?scenario=gsb&seed=7&preset=paper&reality=field&embed');
  await loaded(page);
  const overrides = { reality: { preset: 'field' } };
  expect(await state(page)).toMatchObject({ scenario: 'gsb', seed: 7, preset: 'paper', overrides });
  await expect(page.locator('.transport')).toBeVisible();
  for (const part of ['.bar', '.panel', '.seen', '.tools', '.timeline']) await expect(page.locator(part)).toBeHidden();
});

test('the way out of a frame leads to what is shown in it', async ({ page, context }) => {
  await page.goto('/?scenario=gsb&seed=7&preset=paper&embed');
  await loaded(page);
  await page.evaluate(() => window.mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } }));
  const shown = await page.evaluate(() => window.mapless?.experiment());
  const out = page.locator('#open-page');
  await expect(out).toHaveAttribute('href', /\/#e=./);
  const before = await out.getAttribute('href');
  await page.setViewportSize({ width: 360, height: 300 });
  const [link, layers] = [await out.boundingBox(), await page.locator('#layers-open').boundingBox()];
  expect((layers?.y ?? 0) + (layers?.height ?? 0)).toBeLessThanOrEqual(link?.y ?? 0);
  const [opened] = await Promise.all([context.waitForEvent('page'), out.click()]);
  await loaded(opened);
  expect(await opened.evaluate(() => window.mapless?.experiment())).toEqual(shown);
  await expect(opened.locator('.panel')).toBeVisible();
  // And so from a link in a frame.
  await page.goto('about:blank');
  await page.goto(`/?embed${new URL(before ?? '').hash}`);
  await loaded(page);
  await expect(out).toHaveAttribute('href', before ?? '');
});

test('a generated task by name has its goal, and is driven as by the command line', async ({ page }) => {
  const folder = test.info().outputPath();
  said('generate', '--seed', '6', '--difficulty', 'easy', '--count', '2', '--out', folder);
  await page.goto('/?scenario=easy-6-0002&seed=5');
  await loaded(page);
  await expect(page.locator('#scene-lesson')).toContainText('a safe path exists');
  const path = join(folder, 'easy-6-0002.toml');
  const scenario = readFileSync(path, 'utf8');
  const goal = /^goal = \[(.+), (.+)\]$/m;
  const [, x, y] = goal.exec(scenario) ?? [];
  expect((await state(page)).goal).toEqual({ x: Number(x), y: Number(y) });
  // Not all the way: a part of it is driven as the whole.
  await shortCourse(page, 4);
  const nearer = (await state(page)).goal;
  writeFileSync(path, scenario.replace(goal, `goal = [${nearer.x}, ${nearer.y}]`));
  const { outcome, ticks, digest } = driven(path, '--seed', '5');
  expect(await runToEnd(page)).toEqual({ outcome, ticks, digest });
});

test('a link from this moment opens the run there, paused, as far as the run follows from its start', async ({
  mapless: page,
  browser,
  baseURL,
}) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 3 }));
  await page.evaluate(() => window.mapless?.restart());
  await page.evaluate(() => window.mapless?.play());
  await driveTo(page, 40);
  const { tick, digest, time_s, pose } = await state(page);
  await page.getByRole('button', { name: 'Share and save' }).click();
  const moment = page.getByRole('checkbox', { name: /^From this moment \(0:\d\d\.\d\), paused$/ });
  await expect(page.locator('#link')).toHaveValue(/#e=[^&]*$/);
  await moment.check();
  await expect(page.locator('#link')).toHaveValue(new RegExp(`&t=${Number(time_s.toFixed(3))}$`));
  const link = await page.locator('#link').inputValue();
  const other = await elsewhere(browser, baseURL);
  for (const address of [link, `/?scenario=ht&seed=3&t=${time_s}`]) {
    await other.goto('about:blank');
    await other.goto(address);
    await loaded(other);
    await until(other, (now) => now.tick >= tick && !now.playing);
    expect(await state(other)).toMatchObject({ tick, digest, pose, playing: false });
  }
  await expect(other.getByRole('button', { name: 'Play' })).toBeVisible();
  await other.goto('about:blank');
  await other.goto('/?scenario=ht&t=soon');
  await expect(other.locator('#notice-text')).toContainText('t = "soon": expected a number from 0 to 3600');
  await other.close();
  // What is only tried, or was changed under way, no link drives again.
  await page.getByRole('button', { name: 'Close' }).click();
  await page.evaluate(() => window.mapless?.adjust({ preset: 'paper' }));
  await page.getByRole('button', { name: 'Share and save' }).click();
  const none = page.getByRole('checkbox', { name: /^Not from this moment: / });
  await expect(none).toBeDisabled();
  await expect(none).toHaveAccessibleName(/other settings are only tried here/);
  await page.getByRole('button', { name: 'Close' }).click();
  await page.evaluate(() => window.mapless?.step());
  await page.getByRole('button', { name: 'Share and save' }).click();
  await expect(none).toHaveAccessibleName(/changed during this run/);
});
