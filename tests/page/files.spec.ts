import { readFileSync } from 'node:fs';
import type { Page } from '@playwright/test';
import { expect, file, state, test, until } from './page.ts';

const SIDE = 61;

/** Gentle waves from 0 to 1 m, on a grid of half a metre. */
const HEIGHTS = Array.from({ length: SIDE * SIDE }, (_, at) => {
  const [row, column] = [Math.floor(at / SIDE), at % SIDE];
  return Math.round(500 * (1 + Math.sin(column / 9) * Math.cos(row / 7))) / 1000;
});

/** The first line is the northern edge. */
function ascii(): string {
  const lines = Array.from({ length: SIDE }, (_, line) => {
    const row = SIDE - 1 - line;
    return HEIGHTS.slice(row * SIDE, (row + 1) * SIDE).join(' ');
  });
  return [`ncols ${SIDE}`, `nrows ${SIDE}`, 'cellsize 0.5', ...lines, ''].join('\n');
}

/** A TIFF of one strip of 32-bit floats, with the size of a pixel. */
function geotiff(): Buffer {
  const [long, short, double] = [4, 3, 12];
  const data = 8;
  const scale = data + 4 * SIDE * SIDE;
  const directory = scale + 24;
  const entries = [
    [256, short, 1, SIDE],
    [257, short, 1, SIDE],
    [258, short, 1, 32],
    [259, short, 1, 1],
    [262, short, 1, 1],
    [273, long, 1, data],
    [277, short, 1, 1],
    [278, short, 1, SIDE],
    [279, long, 1, 4 * SIDE * SIDE],
    [339, short, 1, 3],
    [33550, double, 3, scale],
  ] as const;
  const file = Buffer.alloc(directory + 2 + 12 * entries.length + 4);
  file.write('II*\0', 0, 'latin1');
  file.writeUInt32LE(directory, 4);
  for (let line = 0; line < SIDE; line += 1) {
    for (let column = 0; column < SIDE; column += 1) {
      const height = HEIGHTS[(SIDE - 1 - line) * SIDE + column] ?? 0;
      file.writeFloatLE(height, data + 4 * (line * SIDE + column));
    }
  }
  for (const axis of [0, 1]) file.writeDoubleLE(0.5, scale + 8 * axis);
  file.writeUInt16LE(entries.length, directory);
  for (const [index, [tag, type, count, value]] of entries.entries()) {
    const at = directory + 2 + 12 * index;
    file.writeUInt16LE(tag, at);
    file.writeUInt16LE(type, at + 2);
    file.writeUInt32LE(count, at + 4);
    file.writeUInt32LE(value, at + 8);
  }
  return file;
}

async function open(page: Page, ...files: { name: string; mimeType: string; buffer: Buffer }[]): Promise<void> {
  await page.locator('#files').setInputFiles(files);
}

/** The largest difference between the ground and `HEIGHTS` plus `offset_m`. */
function difference(page: Page, offset_m = 0): Promise<number> {
  return page.evaluate(
    ([heights, side, offset]) => {
      const away = (height: number, at: number) => {
        const place = { x: 0.5 * (at % side), y: 0.5 * Math.floor(at / side) };
        return Math.abs((window.mapless?.heightAt(place) ?? Number.NaN) - height - offset);
      };
      return Math.max(...heights.map(away));
    },
    [HEIGHTS, SIDE, offset_m] as const,
  );
}

test('heights from ASCII, GeoTIFF and PNG are the ground, and drive', async ({ mapless: page }) => {
  await open(page, file('waves.asc', ascii()));
  await until(page, (now) => now.scenario === 'waves' && now.tick > 3);
  expect(await difference(page)).toBeLessThan(1e-6);
  const { start, goal } = await state(page);
  expect(Math.hypot(goal.x - start.x, goal.y - start.y)).toBeGreaterThan(8);
  await page.getByRole('button', { name: 'Share and save' }).click();
  const [png] = await Promise.all([page.waitForEvent('download'), page.locator('#save-png').click()]);
  const [json] = await Promise.all([page.waitForEvent('download'), page.locator('#save-experiment').click()]);
  await page.keyboard.press('Escape');

  await open(page, file('bank.tif', geotiff()));
  await until(page, (now) => now.scenario === 'bank' && now.tick > 0);
  expect(await difference(page)).toBeLessThan(1e-6);

  await open(page, file('image.png', readFileSync(await png.path())));
  // What this page saved is read as it was saved, unless somebody says otherwise.
  await page.getByRole('button', { name: 'Open', exact: true }).click();
  await until(page, (now) => now.scenario === 'image');
  expect(await difference(page, -Math.min(...HEIGHTS))).toBeLessThan(0.00051);

  await open(page, file('mine.json', readFileSync(await json.path())));
  await until(page, (now) => now.scenario === 'waves');
  expect(await difference(page)).toBeLessThan(1e-6);
});

test('holes are refused with their place, or become what is chosen, and what was done is said', async ({
  mapless: page,
}) => {
  const notice = page.locator('#notice-text');
  const lines = ascii().split('\n');
  // The northern edge.
  const framed = [...lines.slice(0, 3), Array(SIDE).fill('-9999').join(' '), ...lines.slice(4)].join('\n');
  await open(page, file('framed.asc', framed));
  await expect(notice).toContainText('line 4, row 1, column 1 = -9999: expected a height in metres; 61 of 3721');
  expect((await state(page)).scenario).not.toBe('framed');

  await page.locator('#holes').selectOption('fill', { force: true });
  await open(page, file('framed.asc', framed));
  await until(page, (now) => now.scenario === 'framed');
  await expect(notice).toContainText('61 of 3721 samples were holes: filled from the heights around.');
  // The filled edge is as high as the row before, to what a step of half a metre rises.
  expect(await difference(page)).toBeLessThan(0.1);
  const experiment = await page.evaluate(() => window.mapless?.experiment());
  expect(experiment?.terrain).toMatchObject({ recipe: expect.stringContaining('holes = "fill"') });

  await page.locator('#holes').selectOption('crop', { force: true });
  await open(page, file('cut.asc', framed));
  await until(page, (now) => now.scenario === 'cut');
  await expect(notice).toContainText('columns 1 to 61, rows 2 to 61 of the file are the ground');
  const height = (y: number) => page.evaluate((y) => window.mapless?.heightAt({ x: 1, y }), y);
  expect(await height(29.5)).toBeDefined();
  expect(await height(29.75)).toBeUndefined();
});

test('a scenario opens with its own terrain, and one of the catalogue by itself', async ({ mapless: page }) => {
  const head =
    'start = [4.0, 5.0, 0.25]\ngoal = [20.0, 21.0]\nseed = 5\n\n[planner.decision]\nsteepness_weight = 0.5\n';
  const recipe = 'name = "waves"\n\n[import]\nfile = "waves.asc"\n';
  const scenario = file('mine.toml', `terrain = "waves.toml"\n${head}`);
  await open(page, scenario, file('waves.toml', recipe), file('waves.asc', ascii()));
  await until(page, (now) => now.scenario === 'mine' && now.seed === 5);
  expect(await difference(page)).toBeLessThan(1e-6);
  const experiment = () => page.evaluate(() => window.mapless?.experiment());
  await expect.poll(experiment).toMatchObject({ name: 'mine', start: { x: 4, y: 5, heading_rad: 0.25 } });
  expect((await experiment())?.overrides).toEqual({ planner: { decision: { steepness_weight: 0.5 } } });
  await open(page, file('other.toml', `terrain = "../ht.toml"\n${head}`));
  await until(page, (now) => now.scenario === 'other');
});

test('the scenario that the page saves opens again, and drives the same run', async ({ mapless: page }) => {
  const steps = async () => {
    await page.evaluate(async () => {
      await window.mapless?.pause();
      await window.mapless?.restart();
      for (let tick = 0; tick < 5; tick += 1) await window.mapless?.step();
    });
    return state(page);
  };
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 3 }));
  const { start } = await state(page);
  await page.evaluate(async ({ x, y }) => {
    const points_cm = [100 * (x + 4), 100 * (y + 1)].map(Math.round);
    await window.mapless?.sculpt({ kind: 'boulder', radius_m: 1.5, strength_m: 0.8, points_cm });
    await window.mapless?.setGoal({ x: x + 6, y: y + 6 }, [{ x: x + 4, y: y - 1 }]);
    await window.mapless?.setOverrides({ sensor: { range_noise_m: 0.03 } });
  }, start);
  const before = await steps();
  await page.getByRole('button', { name: 'Share and save' }).click();
  const [zip] = await Promise.all([page.waitForEvent('download'), page.locator('#save-scenario').click()]);
  const bytes = readFileSync(await zip.path());
  await page.keyboard.press('Escape');
  await page.evaluate(() => window.mapless?.loadScenario('ml'));
  await open(page, file('mine.zip', bytes));
  await until(page, (now) => now.scenario === 'mine');
  const { digest, goal, waypoints, seed, overrides } = before;
  expect(await steps()).toMatchObject({ digest, goal, waypoints, seed, overrides, tick: 5 });
  await open(page, file('cut.zip', bytes.subarray(0, bytes.length - 9)));
  await expect(page.locator('#notice-text')).toContainText('cut.zip: not a ZIP file that this page reads');
  expect((await state(page)).scenario).toBe('mine');
});

test('files that cannot be opened say why, and change nothing', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.pause());
  const { scenario } = await state(page);
  const cases: [name: string, content: string | Buffer, words: string][] = [
    ['a.asc', ascii().slice(0, 2000), 'it ends after'],
    ['b.asc', ascii().replace('0.5 ', 'nan '), 'expected a height in metres'],
    ['c.png', 'no picture', 'not a valid PNG file'],
    ['d.tif', geotiff().subarray(0, 900), 'not a valid TIFF file'],
    ['e.json', '{"version":1}', 'e.json: experiment.name = absent'],
    ['f.toml', 'terrain = "gone.toml"\nstart = [1, 1, 0]\ngoal = [2, 2]\nseed = 1\n', 'choose that file together'],
    ['g.toml', 'terrain = "../ht.toml"\nstart = [1, 1]\ngoal = [2, 2]\nseed = 1\n', 'g.toml'],
    ['h.txt', 'hello', 'h.txt: expected a scenario or recipe'],
    ['i.toml', 'planners = ["default"]\nroutes = ["a.toml"]\n', 'i.toml: a campaign, which `mapless trials` drives: '],
    ['i.asc', Buffer.alloc((16 << 20) + 1), 'expected at most 16777216'],
  ];
  for (const [name, content, words] of cases) {
    await open(page, file(name, content));
    await expect(page.locator('#notice-text'), name).toContainText(words);
    expect((await state(page)).scenario).toBe(scenario);
  }
});
