/** Files from an address: what is fetched goes the way of files that are chosen. */

import type { Page } from '@playwright/test';
import { DEVICES, faults } from './axe.ts';
import { test as base, expect, fits, loaded, ownOf, press, state, still, until } from './page.ts';

const HOST = 'https://worlds.example';
const MAPS = 'verti_bench/main/envs/data/BenchMaps/sampled_maps';
const RAW = `https://raw.githubusercontent.com/RobotiXX/${MAPS}`;
const SIDE = 41;

/** A world as the benchmark's repository has it: ground that rises to the north, a rock and a tree, two tasks. */
const CONFIG = `obstacles:
  rocks:
  - position: {x: 10.0, y: 5.0, z: 3.7}
    scale: 0.5
  trees:
  - position: {x: -15.0, y: -15.0, z: 3.1}
positions:
- goal: [15.0, -10.0, 1.0]
  start: [-15.0, 5.0, 1.0]
- goal: [-15.0, 14.5, 1.0]
  start: [-15.0, -5.0, 1.0]
terrain: {difficulty: mid, is_flat: false, max_height: 10.2, min_height: 0.0}
terrain_type: rigid
textures: []
`;

/** A grey BMP image of 8 bits; a row is one level above the row south of it. */
function bmp(): Buffer {
  const stride = Math.ceil(SIDE / 4) * 4;
  const image = Buffer.alloc(1078 + stride * SIDE);
  image.write('BM');
  for (const [at, number] of [1078, 40, SIDE, SIDE, (8 << 16) | 1].entries()) image.writeUInt32LE(number, 10 + 4 * at);
  for (let grey = 0; grey < 256; grey += 1) image.fill(grey, 54 + 4 * grey, 57 + 4 * grey);
  for (let row = 0; row < SIDE; row += 1) image.fill(60 + row, 1078 + row * stride, 1078 + row * stride + SIDE);
  return image;
}

/** Level ground with a slope in the east. */
const ASC = ['ncols 41', 'nrows 41', 'cellsize 0.5', ...Array(41).fill([...Array(40).fill(0), 0.2].join(' ')), ''].join(
  '\n',
);
const SCENARIO = 'terrain = "../ground/slope.toml"\nstart = [4.0, 4.0, 0.5]\ngoal = [14.0, 12.0]\nseed = 5\n';
const RECIPE = 'name = "slope"\n\n[import]\nfile = "slope.asc"\n';

type Served = Record<
  string,
  string | Buffer | { status?: number; headers?: Record<string, string>; body?: string | Buffer }
>;

/** Serves these addresses as a host that lets every page read them; notes what is asked for. */
async function serve(page: Page, host: string, files: Served): Promise<string[]> {
  const asked: string[] = [];
  await page.route(`${host}/**`, async (route) => {
    const request = route.request();
    const path = request.url().slice(host.length + 1);
    expect(await request.headerValue('referer')).toBeNull();
    asked.push(path);
    const found = files[path.replace(/\?.*/, '')];
    if (found === undefined) return route.fulfill({ status: 404, body: 'Not Found' });
    const answer = typeof found === 'string' || Buffer.isBuffer(found) ? { body: found } : found;
    return route.fulfill({ headers: { 'access-control-allow-origin': '*' }, ...answer });
  });
  return asked;
}

/** A page whose scripts throw nothing. */
const test = base.extend({
  mapless: async ({ page }, use) => {
    const thrown: string[] = [];
    page.on('pageerror', (error) => thrown.push(String(error)));
    await page.goto('/');
    await loaded(page);
    await use(page);
    expect(thrown).toEqual([]);
  },
});

const field = (page: Page) => page.getByLabel('From an address');
const said = (page: Page) => page.locator('#address-said');
const task = (page: Page) => page.getByRole('dialog', { name: 'World 3 of Verti-Bench' });

async function give(page: Page, address: string): Promise<void> {
  if (!(await field(page).isVisible())) await page.keyboard.press('g');
  await field(page).fill(address);
  await field(page).press('Enter');
}

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);

    test('a world of Verti-Bench opens by the address of its file at GitHub', async ({ mapless: page }) => {
      await serve(page, RAW, { 'Configs/Final/config3_mid.yaml': CONFIG, 'Worlds/3.bmp': bmp() });
      const address = `https://github.com/RobotiXX/${MAPS.replace('/main/', '/blob/main/')}/Configs/Final/config3_mid.yaml`;
      const act = device === 'phone' ? press : (part: Parameters<typeof press>[0]) => part.click();
      await act(page.getByRole('button', { name: 'Terrains' }));
      await field(page).fill(address);
      await fits(page.locator('#from-address > *'));
      await act(page.getByRole('button', { name: 'Open address' }));
      await expect(task(page)).toContainText('Steep ground (mid) with rocks and trees');
      await expect(page.locator('#terrains-sheet')).toBeHidden();
      expect(await faults(page)).toEqual([]);
      await fits(task(page).locator('h2, p, label, select, button'));
      await task(page).getByLabel('Task').selectOption('2 of 2');
      await act(task(page).getByRole('button', { name: 'Open' }));
      await until(page, (now) => now.scenario === 'mid-003-02');
      // A fifth of 40 m; a level is 10.2 m / 255 = 4 cm there, and the rows of the south and north are 60 and 100.
      const heights = await page.evaluate(() => [0, 8].map((y) => window.mapless?.heightAt({ x: 1, y }) ?? Number.NaN));
      expect(heights[0]).toBeCloseTo(0.2 * 0.04 * 60, 5);
      expect(heights[1]).toBeCloseTo(0.2 * 0.04 * 100, 5);
      const own = await ownOf(page);
      expect(own?.goal).toMatchObject({ x: 1, y: 6.9 });
      expect(own?.terrain).toMatchObject({ recipe: expect.stringContaining('size_m = [0.44, 0.44, 0.38]') });
    });

    test('what is wrong is said at the field, with the address', async ({ mapless: page }) => {
      const large = Buffer.alloc((32 << 20) + 1, '0');
      await serve(page, HOST, {
        'withheld.asc': { headers: { 'access-control-allow-origin': 'https://others.example' }, body: ASC },
        'broken.asc': { status: 503, headers: { 'access-control-allow-origin': '*' } },
        'large.asc': large,
        'away.toml': 'terrain = "https://others.example/hill.asc"\n',
        'lonely.toml': SCENARIO,
      });
      await page.route('https://nowhere.example/**', (route) => route.abort('namenotresolved'));
      const before = await ownOf(page);
      for (const [address, words] of [
        [`${HOST}/none.asc`, `${HOST}/none.asc: not found (404)`],
        [`${HOST}/withheld.asc`, `${HOST}/withheld.asc: its server does not let other pages read it (CORS)`],
        ['https://nowhere.example/hill.asc', 'https://nowhere.example/hill.asc: cannot be reached'],
        [`${HOST}/broken.asc`, `${HOST}/broken.asc: refused with 503`],
        [`${HOST}/large.asc`, `${HOST}/large.asc: more than 33554432 bytes`],
        [
          `${HOST}/page.html`,
          `${HOST}/page.html: not a format that this page opens: expected a name that ends in .png, `,
        ],
        [
          'http://worlds.example/hill.asc',
          'http://worlds.example/hill.asc: expected an address that begins with https://',
        ],
        [`${HOST}/away.toml`, `${HOST}/away.toml: names https://others.example/hill.asc: expected a path`],
        [`${HOST}/lonely.toml`, `${HOST}/ground/slope.toml: not found (404)`],
      ] as const) {
        await give(page, address);
        await expect(said(page)).toContainText(words);
        await expect(said(page)).toHaveAttribute('data-fault');
      }
      await fits(said(page));
      expect(await faults(page)).toEqual([]);
      expect(await ownOf(page)).toEqual(before);
    });
  });
}

test('a scenario brings the recipe and the heights that it names, as the files do', async ({ mapless: page }) => {
  const served = { 'tasks/east.toml': SCENARIO, 'ground/slope.toml': RECIPE, 'ground/slope.asc': ASC };
  const asked = await serve(page, HOST, served);
  await give(page, `${HOST}/tasks/east.toml?version=2`);
  await until(page, (now) => now.scenario === 'east');
  expect(asked).toEqual(['tasks/east.toml?version=2', 'ground/slope.toml', 'ground/slope.asc']);
  const byAddress = await ownOf(page);
  expect(byAddress).toMatchObject({ goal: { x: 14, y: 12 }, seed: 5, terrain: { imported: { name: 'slope.asc' } } });
  await page.keyboard.press('n');
  await until(page, (now) => now.scenario !== 'east');
  const files = Object.entries(served).map(([path, content]) => ({
    name: path.replace(/.*\//, ''),
    mimeType: 'text/plain',
    buffer: Buffer.from(content),
  }));
  await page.locator('#files').setInputFiles(files);
  await until(page, (now) => now.scenario === 'east');
  expect(await ownOf(page)).toEqual(byAddress);
});

test('heights, a table and a planner open by address; what their reader refuses is said with it', async ({
  mapless: page,
}) => {
  await serve(page, HOST, {
    'hill.asc': ASC,
    'bad.asc': ASC.replace('0.2', 'x'),
    'trials.csv': 'id,planner\n',
    'mine.js': 'export function decide() { return { stop: true }; }',
  });
  await give(page, `${HOST}/hill.asc`);
  await until(page, (now) => now.scenario === 'hill');
  const { scenario } = await state(page);
  for (const name of ['bad.asc', 'trials.csv']) {
    await give(page, `${HOST}/${name}`);
    await expect(page.locator('#notice-text')).toContainText(`From ${HOST}/${name}: ${name}: `);
    expect((await state(page)).scenario).toBe(scenario);
    await page.locator('#notice-close').click();
  }
  await give(page, `${HOST}/mine.js`);
  await expect(page.getByRole('tab', { name: 'Compare' })).toHaveAttribute('aria-selected', 'true');
});

test('a closed sheet stops fetching', async ({ mapless: page }) => {
  let answer = () => {};
  const waiting = new Promise<void>((resolve) => {
    answer = resolve;
  });
  await serve(page, HOST, {});
  await page.route(`${HOST}/hill.asc`, async (route) => {
    await waiting;
    // Nobody may be there to hear it any more.
    await route.fulfill({ headers: { 'access-control-allow-origin': '*' }, body: ASC }).catch(() => undefined);
  });
  const { scenario } = await state(page);
  await give(page, `${HOST}/hill.asc`);
  await expect(said(page)).toHaveText('Fetching…');
  await page.keyboard.press('Escape');
  await expect(said(page)).toHaveText('');
  answer();
  await give(page, `${HOST}/none.asc`);
  await expect(said(page)).toContainText('not found');
  await still(page);
  expect((await state(page)).scenario).toBe(scenario);
});

test('a world of Verti-Bench opens by its two files; one alone says what it lacks', async ({ mapless: page }) => {
  const [config, image] = [
    { name: 'config3_mid.yaml', mimeType: 'text/plain', buffer: Buffer.from(CONFIG) },
    { name: '3.bmp', mimeType: 'image/bmp', buffer: bmp() },
  ];
  const open = (...files: { name: string; mimeType: string; buffer: Buffer }[]) =>
    page.locator('#files').setInputFiles(files);
  const gives = { ...config, buffer: Buffer.from(CONFIG.replace('rigid', 'mixed')) };
  for (const [files, words] of [
    [[config], 'config3_mid.yaml: expected the heights of that world, 3.bmp, too'],
    [[image], '3.bmp: heights of Verti-Bench alone: expected its config'],
    [[{ ...config, buffer: Buffer.from('obstacles: [') }, image], 'config3_mid.yaml: '],
    [[gives, image], 'config3_mid.yaml: the ground of world 3 gives: expected terrain_type: rigid'],
    [[config, { ...image, buffer: Buffer.from('GIF') }], '3.bmp: it begins with'],
  ] as const) {
    await open(...files);
    await expect(page.locator('#notice-text')).toContainText(words);
    await page.locator('#notice-close').click();
  }
  const before = (await state(page)).scenario;
  await open(config, image);
  await task(page).press('Escape');
  await expect(task(page)).toBeHidden();
  expect((await state(page)).scenario).toBe(before);
  await open(config, image);
  await task(page).getByLabel('Scale').selectOption('1');
  await task(page).getByRole('button', { name: 'Open' }).press('Enter');
  await until(page, (now) => now.scenario === 'mid-003-01');
  expect((await ownOf(page))?.goal).toMatchObject({ x: 35, y: 10 });
});
