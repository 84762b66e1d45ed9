/** The npm package: packed, installed into an empty folder, and used from there, in Node and in a page of somebody else. */

import { execFileSync, spawnSync } from 'node:child_process';
import { createReadStream, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { type Page, test } from '@playwright/test';
import { DEVICES } from './axe.ts';
import { driven } from './commandLine.ts';
import { expect } from './page.ts';

const TYPES: Readonly<Record<string, string>> = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml',
};

let folder = '';
let server: Server | undefined;
let origin = '';

function run(command: string, args: readonly string[], cwd: string): string {
  return execFileSync(command, args, { cwd, encoding: 'utf8' });
}

/** As any static host, of the folder in which the package is installed. */
async function serve(): Promise<void> {
  server = createServer(({ url = '' }, response) => {
    const file = join(folder, new URL(url, 'http://host').pathname);
    const stream = createReadStream(file);
    stream.on('error', () => response.writeHead(404).end());
    stream.on('open', () => response.setHeader('Content-Type', TYPES[extname(file)] ?? 'application/octet-stream'));
    stream.pipe(response);
  });
  await new Promise<void>((resolve) => server?.listen(0, '127.0.0.1', resolve));
  origin = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
}

test.beforeAll(async () => {
  // Outside the repository, whose own settings would hold for it.
  folder = mkdtempSync(join(tmpdir(), 'mapless-'));
  run('npm', ['run', 'embed', '--silent'], '.');
  const [packed] = JSON.parse(run('npm', ['pack', '--json', '--pack-destination', folder], 'target/embed'));
  writeFileSync(join(folder, 'package.json'), '{ "type": "module", "private": true }');
  run('npm', ['install', '--offline', '--no-audit', '--no-fund', packed.filename], folder);
  await serve();
});

test.afterAll(() => {
  server?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** A page of somebody else with this in its body. */
async function open(page: Page, name: string, body: string): Promise<void> {
  const head =
    '<!doctype html><html lang="en"><meta charset="utf-8"><title>Course</title><link rel="icon" href="data:,">';
  writeFileSync(join(folder, name), `${head}<body>${body}</body></html>`);
  await page.goto(`${origin}/${name}`);
}

test('npm packs without a word of warning', () => {
  const { stderr, stdout, status } = spawnSync('npm', ['pack', '--dry-run', '--json'], {
    cwd: 'target/embed',
    encoding: 'utf8',
  });
  expect(status).toBe(0);
  expect(stderr).not.toMatch(/warn/i);
  const [{ files, size }] = JSON.parse(stdout) as [{ files: { path: string }[]; size: number }];
  for (const path of ['README.md', 'scene.js', 'core.js', 'types/embed/scene.d.ts', 'page/index.html', 'LICENSE-MIT'])
    expect(files.map((file) => file.path)).toContain(path);
  // The page in it has the modules that open recordings and worlds of Verti-Bench, too.
  expect(size).toBeLessThan(2_750_000);
});

test('the core drives in Node as on the command line, and says what is wrong', () => {
  const terrain = readFileSync('terrains/ht.toml', 'utf8');
  const [, x, y, heading] =
    /^start = \[([\d.]+), ([\d.]+), ([-\d.]+)\]/m.exec(readFileSync('terrains/scenarios/ht.toml', 'utf8')) ?? [];
  const [ahead, left] = [Number(x) + 4 * Math.cos(Number(heading)), Number(y) + 4 * Math.sin(Number(heading))];
  const scenario = `terrain = "ground.toml"\nstart = [${x}, ${y}, ${heading}]\ngoal = [${ahead}, ${left}]\nseed = 7\n`;
  writeFileSync(join(folder, 'ground.toml'), terrain);
  writeFileSync(join(folder, 'short.toml'), `${scenario}[sensor]\nrange_noise_m = 0.03\n`);
  writeFileSync(
    join(folder, 'drive.js'),
    `import { readFileSync } from 'node:fs';
import { open, SCENARIOS } from 'mapless-scene/core';
const files = { scenario: ${JSON.stringify(scenario)}, terrain: readFileSync('ground.toml', 'utf8') };
const run = await open(files, { preset: 'paper', overrides: { sensor: { range_noise_m: 0.03 } } });
const { after, tick } = run.drive();
const known = await open('ht', { seed: 7 });
known.tick();
const { frame, buffers } = known.look(true);
const refused = await open('nowhere').catch(({ message }) => message);
const wrong = await open('ht', { overrides: { sensor: { range_noise_m: 7 } } }).catch(({ message }) => message);
console.log(JSON.stringify({
  outcome: after.outcome, ticks: tick, digest: run.digest(), returns: frame.returns,
  varied: new Set(buffers.variance).size, refused, wrong, scenarios: SCENARIOS.length,
}));
`,
  );
  const own = JSON.parse(run('node', ['drive.js'], folder));
  const native = driven(join(folder, 'short.toml'), '--planner', 'paper');
  expect(native.outcome).toBe('reached');
  expect(own).toMatchObject({ outcome: native.outcome, digest: native.digest });
  expect(own.returns).toBeGreaterThan(1000);
  expect(own.varied).toBeGreaterThan(1000);
  expect(own.refused).toMatch(/^scenario = nowhere: expected one of cht-ad, /);
  expect(own.wrong).toMatch(/sensor\.range_noise_m = 7: expected a number from 0 to 1/);
});

test('its types hold in a strict project', () => {
  writeFileSync(
    join(folder, 'typed.ts'),
    `import { open } from 'mapless-scene/core';
import { type MaplessState, MaplessScene } from 'mapless-scene';
const run = await open('ht', { preset: 'paper' });
const x: number = run.tick().pose.x;
const scene = document.createElement('mapless-scene');
const state: MaplessState | undefined = await (await scene.api).state();
await (await scene.api).setGoal({ x, y: 2 });
MaplessScene.page = String(state?.outcome);
`,
  );
  const lib = ['--lib', 'es2023,dom,dom.iterable,esnext.disposable', '--types', ''];
  const options = ['--noEmit', '--strict', '--target', 'es2022', '--module', 'nodenext', '--skipLibCheck', 'false'];
  run(join(process.cwd(), 'node_modules/.bin/tsc'), [...options, ...lib, 'typed.ts'], folder);
});

test('two lines put a scene into a page, and its API drives it', async ({ page }) => {
  const faults: string[] = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') faults.push(message.text());
  });
  await open(
    page,
    'course.html',
    `<script type="module" src="node_modules/mapless-scene/scene.js"></script>
<mapless-scene scenario="gsb" seed="7" preset="paper"></mapless-scene>`,
  );
  const shown = await page.evaluate(async () => {
    const robot = await document.querySelector('mapless-scene')?.api;
    await robot?.pause();
    await robot?.restart();
    await robot?.step();
    const refused = await robot?.loadScenario('nowhere').catch(({ message }) => message);
    return { state: await robot?.state(), refused, scan: (await robot?.scan())?.length };
  });
  expect(shown.state).toMatchObject({ scenario: 'gsb', seed: 7, preset: 'paper', tick: 1 });
  expect(shown.refused).toContain('nowhere');
  expect(shown.scan).toBeGreaterThan(3000);
  const size = () => page.locator('mapless-scene').boundingBox();
  const { height: window_px = 0 } = page.viewportSize() ?? {};
  expect((await size())?.height).toBeCloseTo(0.8 * window_px, 0);
  await page.setViewportSize({ width: 800, height: window_px });
  const box = await size();
  expect((box?.width ?? 0) / (box?.height ?? 1)).toBeCloseTo(1.6, 1);
  const scene = page.frameLocator('mapless-scene iframe');
  await expect(scene.getByRole('button', { name: 'Play' })).toBeVisible();
  expect(faults).toEqual([]);
});

test.describe('on a phone', () => {
  test.use(DEVICES.phone);

  test('nothing in a scene lies over what can be pressed', async ({ page }) => {
    await open(
      page,
      'phone.html',
      `<meta name="viewport" content="width=device-width, initial-scale=1">
<script type="module" src="node_modules/mapless-scene/scene.js"></script><mapless-scene scenario="gsb"></mapless-scene>`,
    );
    const scene = page.frameLocator('mapless-scene iframe');
    await scene.getByRole('link', { name: 'Open in mapless' }).tap({ trial: true });
    for (const name of ['Layers', 'Pause', 'See the whole terrain'])
      await scene.getByRole('button', { name, exact: true }).tap({ trial: true, timeout: 30_000 });
  });
});

test('a wheel over a scene scrolls the page, until Ctrl is held or the scene was pressed into', async ({ page }) => {
  await open(
    page,
    'reading.html',
    `<script type="module" src="node_modules/mapless-scene/scene.js"></script>
<h1>Reading</h1>
<mapless-scene scenario="gsb" t="1"></mapless-scene>
<div style="height: 3000px">More to read</div>`,
  );
  const stands = await page.evaluate(async () => await (await document.querySelector('mapless-scene')?.api)?.state());
  expect(stands).toMatchObject({ playing: false, tick: 10 });
  const scrolled = () => page.evaluate(() => window.scrollY);
  const picture = async () => {
    await page.evaluate(async () => (await document.querySelector('mapless-scene')?.api)?.still());
    return page.locator('mapless-scene').screenshot();
  };
  const box = await page.locator('mapless-scene').boundingBox();
  const [x, y] = [(box?.x ?? 0) + 300, (box?.y ?? 0) + 200];
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, 120);
  await expect.poll(scrolled).toBe(120);
  await page.mouse.wheel(0, -120);
  await expect.poll(scrolled).toBe(0);
  const before = await picture();
  await page.keyboard.down('Control');
  await page.mouse.wheel(0, -240);
  await page.keyboard.up('Control');
  await expect.poll(async () => (await picture()).equals(before)).toBe(false);
  expect(await scrolled()).toBe(0);
  await page.mouse.click(x, y);
  await page.mouse.wheel(0, 120);
  const zoomed = await picture();
  expect(zoomed.equals(before)).toBe(false);
  expect(await scrolled()).toBe(0);
  // Whoever presses elsewhere reads on.
  await page.getByRole('heading', { name: 'Reading' }).click();
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, 120);
  await expect.poll(scrolled).toBe(120);
});

test('the example page runs and is used by its button', async ({ page }) => {
  await page.goto(`${origin}/node_modules/mapless-scene/example.html`);
  await expect(page.locator('#said')).toHaveText(/^default: \d+\.\d s, running$/);
  await page.getByRole('button', { name: /paper/ }).click();
  await expect(page.locator('#said')).toHaveText(/^paper: [1-9]\d*\.\d s, /);
  await page.screenshot({ path: 'test-results/embed-example.png' });
});

test('a page may frame one of another origin, and nobody else gets a word in', async ({ page, baseURL }) => {
  await open(
    page,
    'elsewhere.html',
    `<script type="module">
import { MaplessScene } from './node_modules/mapless-scene/scene.js';
MaplessScene.page = '${baseURL}/index.html';
const scene = document.createElement('mapless-scene');
scene.setAttribute('scenario', 'ht');
document.body.append(scene);
</script>`,
  );
  await page.waitForSelector('mapless-scene');
  const scenario = await page.evaluate(async () => {
    const robot = await document.querySelector('mapless-scene')?.api;
    return (await robot?.state())?.scenario;
  });
  expect(scenario).toBe('ht');
  // Not as an embedded scene, the page answers nobody.
  await open(page, 'plain.html', `<iframe src="${baseURL}/index.html?scenario=ht"></iframe>`);
  const frame = page.frames()[1];
  await frame?.waitForFunction(() => window.mapless?.state() !== undefined);
  const answered = await page.evaluate(async () => {
    const { port1, port2 } = new MessageChannel();
    const answer = new Promise((resolve) => {
      port1.onmessage = () => resolve(true);
      setTimeout(() => resolve(false), 2000);
    });
    document.querySelector('iframe')?.contentWindow?.postMessage('mapless', '*', [port2]);
    port1.postMessage({ id: 0, method: 'state', given: [] });
    return answer;
  });
  expect(answered).toBe(false);
});
