import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { McapIndexedReader } from '@mcap/core';
import type { Download, Page } from '@playwright/test';
import type { Experiment } from '../../web/src/experiment/experiment.ts';
import { driven } from './commandLine.ts';
import { download, driveTo, expect, file, ownOf, runToEnd, state, test, until } from './page.ts';

// A small view leaves a processor without graphics card its time.
test.use({ viewport: { width: 720, height: 560 } });

const cursor = (page: Page) => page.getByRole('slider', { name: 'Time in the plots' });
const time_s = async (page: Page) => Number(await cursor(page).getAttribute('aria-valuenow'));

test('the plots show the run, and their cursor reads it', async ({ mapless: page }) => {
  await driveTo(page, 30);
  await cursor(page).scrollIntoViewIfNeeded();
  const lines = page.locator('.plot-line');
  await expect(lines).toHaveCount(5);
  for (const line of await lines.all()) {
    await expect(line).toHaveAttribute('d', /^M.*L.*L/);
  }
  await expect(page.locator('.plot-paper')).toHaveCount(2);
  await cursor(page).focus();
  await page.keyboard.press('Home');
  expect(await time_s(page)).toBe(0);
  for (let press = 0; press < 7; press += 1) await page.keyboard.press('ArrowRight');
  expect(await time_s(page)).toBeCloseTo(0.7);
  await expect(cursor(page)).toHaveAttribute('aria-valuetext', /^0:00\.7: Roll .*°, Pitch .*, Curvature .* rad\/m$/);
  // The run goes where the cursor is, and the timeline with it.
  await until(page, ({ tick }) => tick === 7);
  await expect(page.getByRole('slider', { name: 'Time of the run' })).toHaveValue('7');
  await page.keyboard.press('End');
  const { timeline } = await state(page);
  expect(await time_s(page)).toBeCloseTo((timeline.end - 1) / 10);
  await page.evaluate(() => window.mapless?.seek(12));
  await expect.poll(() => time_s(page)).toBeCloseTo(1.2);
});

test('an angle fills the height of its plot, and its limit is there when it is near', async ({ mapless: page }) => {
  await driveTo(page, 10);
  await cursor(page).scrollIntoViewIfNeeded();
  await expect(page.locator('.plots-figure')).toContainText('limit 30°');
  await expect(page.locator('.plot-number').first()).toHaveText('−5');
  await expect(page.locator('.plot-limit')).toHaveCount(0);
  // A steep hill beside the start, under one side of the robot.
  await page.evaluate(async () => {
    const { x, y } = window.mapless?.state()?.start ?? { x: 0, y: 0 };
    const points_cm = [Math.round(100 * x) + 300, Math.round(100 * y)];
    await window.mapless?.sculpt({ kind: 'raise', radius_m: 7, strength_m: 3, points_cm });
    await window.mapless?.restart();
    await window.mapless?.step();
  });
  await expect(page.locator('.plot-limit')).toHaveCount(2);
});

test('the plots zoom by keys, wheel and buttons, and grow into a sheet', async ({ mapless: page }) => {
  await driveTo(page, 50);
  const times = () => page.locator('.plot-axis text').allTextContents();
  await cursor(page).focus();
  // Plots follow the run with a delay; a key draws them at once.
  await page.keyboard.press('0');
  const whole = await times();
  await page.keyboard.press('Home');
  for (let press = 0; press < 3; press += 1) await page.keyboard.press('+');
  const near = await times();
  expect(near).not.toEqual(whole);
  expect(near).toContain('0:00');
  await page.keyboard.press('0');
  expect(await times()).toEqual(whole);
  await page.getByRole('button', { name: 'Enlarge the plots' }).click();
  const sheet = page.getByRole('dialog', { name: 'Over time' });
  await expect(sheet.locator('.plot-line')).toHaveCount(5);
  const box = await cursor(page).boundingBox();
  if (!box) throw new Error('The plots have no place.');
  await expect(sheet.locator('svg')).toHaveAttribute('viewBox', new RegExp(`^0 0 ${Math.round(box.width)} `));
  await page.mouse.move(box.x + box.width / 2, box.y + 80);
  const { timeline } = await state(page);
  await expect.poll(() => time_s(page)).toBeCloseTo(Math.max(timeline.end - 1, 50) / 20, 0);
  const before = await times();
  await page.mouse.wheel(0, -600);
  await expect.poll(times).not.toEqual(before);
  await sheet.getByRole('button', { name: 'Show all of the run' }).click();
  expect(await times()).toEqual(before);
  await page.keyboard.press('Escape');
  await expect(page.locator('#plots .plot-line')).toHaveCount(5);
});

test('trajectory and result are those of the command line', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 5 }));
  await runToEnd(page);
  const out = test.info().outputPath();
  driven('terrains/scenarios/ht.toml', '--seed', '5', '--out', out);
  const csv = await download(page, 'save-csv');
  expect(csv.name).toBe('mapless-ht-seed5-trajectory.csv');
  expect(csv.bytes.toString()).toBe(readFileSync(join(out, 'trajectory.csv'), 'utf8'));
  const { planner_ms: _page, run, ...result } = JSON.parse((await download(page, 'save-json')).bytes.toString());
  const { planner_ms: _line, ...expected } = JSON.parse(readFileSync(join(out, 'result.json'), 'utf8'));
  expect(result).toEqual(expected);
  expect(run).toMatchObject({ scenario: 'ht', planner: 'default', seed: 5, changes: [], changed_at_ticks: [] });
  expect(run.experiment).toEqual(await ownOf(page));
});

/** What a file says of what was run. */
interface Said {
  changes: string[];
  changed_at_ticks: number[];
  experiment: Experiment;
}

test('every file of a changed run says what was run, in its name and within', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht', { preset: 'paper' }));
  await page.evaluate(() =>
    window.mapless?.setOverrides({ planner: { perception: { variance_threshold: 0.7 } }, sensor: { columns: 900 } }),
  );
  await driveTo(page, 12);
  const own = await ownOf(page);
  const changes = ['planner.perception.variance_threshold = 0.7', 'sensor.columns = 900'];
  const name = (what: string) => new RegExp(`^mapless-ht-paper-seed1-changed-[0-9a-f]{8}-${what}$`);

  const downloads: Download[] = [];
  page.on('download', (one) => downloads.push(one));
  await page.locator('#save-csv').click();
  await expect.poll(() => downloads.length).toBe(2);
  const names = downloads.map((one) => one.suggestedFilename()).sort();
  expect(names[0]).toMatch(name('trajectory.csv'));
  expect(names[1]).toMatch(name('trajectory.run.json'));
  const side = downloads.find((one) => one.suggestedFilename().endsWith('.run.json'));
  const beside: Said = JSON.parse(readFileSync((await side?.path()) ?? '', 'utf8'));
  expect(beside).toMatchObject({ changes, experiment: own });

  const json = await download(page, 'save-json');
  expect(json.name).toMatch(name('result.json'));
  const within: Said = JSON.parse(json.bytes.toString()).run;
  expect(beside).toMatchObject({ ...within });

  const svg = await download(page, 'save-plots');
  expect(svg.name).toMatch(name('plots.svg'));
  for (const words of [...changes, 'planner paper, seed 1']) expect(svg.bytes.toString()).toContain(words);

  const mcap = await download(page, 'save-mcap');
  expect(mcap.name).toMatch(name('run.mcap'));
  expect(mcap.bytes.toString()).toContain(JSON.stringify(own));

  // What a file says opens again, and is the same run.
  await page.evaluate(() => window.mapless?.loadScenario('ml'));
  await page.locator('#files').setInputFiles(file(json.name, json.bytes));
  await until(page, (now) => now.scenario === 'ht');
  expect((await download(page, 'save-json')).name).toBe(json.name);
  await driveTo(page, 3);
  await page.evaluate(() =>
    window.mapless?.sculpt({ kind: 'raise', radius_m: 1, strength_m: 0.1, points_cm: [500, 500] }),
  );
  await until(page, (now) => now.disturbed);
  const later: Said = JSON.parse((await download(page, 'save-json')).bytes.toString()).run;
  expect(later.changes).toEqual(['1 stroke on the ground', ...changes]);
  expect(later.changed_at_ticks).toHaveLength(1);
});

test('the MCAP file is valid, complete and in the schemas of Foxglove', async ({ mapless: page }) => {
  await driveTo(page, 40);
  const { tick, seed, digest, returns, pose } = await state(page);
  const { bytes } = await download(page, 'save-mcap');
  const reader = await McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
    },
  });
  const schemas = new Map(
    [...reader.channelsById.values()].map((one) => [one.topic, reader.schemasById.get(one.schemaId)?.name]),
  );
  expect(Object.fromEntries(schemas)).toEqual({
    '/pose': 'foxglove.PoseInFrame',
    '/tf': 'foxglove.FrameTransform',
    '/subgoal': 'foxglove.PoseInFrame',
    '/goal': 'foxglove.PoseInFrame',
    '/points': 'foxglove.PointCloud',
    '/tick': 'mapless.Tick',
  });
  const messages = new Map<string, { time: bigint; content: Record<string, never> }[]>();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const topic = reader.channelsById.get(message.channelId)?.topic ?? '';
    const content = JSON.parse(new TextDecoder().decode(message.data));
    messages.set(topic, [...(messages.get(topic) ?? []), { time: message.logTime, content }]);
  }
  expect(messages.get('/tf')).toHaveLength(tick);
  expect(messages.get('/tick')).toHaveLength(tick);
  expect(messages.get('/tick')?.at(-1)?.time).toBe(BigInt(tick - 1) * 100_000_000n);
  const points = messages.get('/points')?.[0]?.content as unknown as { data: string; point_stride: number };
  const cloud = Buffer.from(points.data, 'base64');
  expect(cloud.length).toBe(returns * points.point_stride);
  expect(Math.hypot(cloud.readFloatLE(0) - pose.x, cloud.readFloatLE(4) - pose.y)).toBeLessThan(110);
  const metadata = new Map<string, string>();
  for await (const one of reader.readMetadata()) for (const [name, value] of one.metadata) metadata.set(name, value);
  expect(Object.fromEntries(metadata)).toMatchObject({ seed: String(seed), digest, outcome: 'running' });
});

test.describe('in full resolution', () => {
  test.use({ deviceScaleFactor: 1 });

  test('pictures, plots and a film of the view', async ({ mapless: page }) => {
    const view = await page.locator('#view').boundingBox();
    const [width, height] = [Math.floor(view?.width ?? 0), Math.floor(view?.height ?? 0)];
    for (const act of ['drives', 'stands']) {
      if (act === 'stands') await driveTo(page, 30);
      const picture = await download(page, 'save-picture');
      expect(picture.bytes.subarray(1, 4).toString()).toBe('PNG');
      expect(picture.bytes.length).toBeGreaterThan(20_000);
      // Every pixel of the screen, also where a processor draws coarsely what moves.
      expect([picture.bytes.readUInt32BE(16), picture.bytes.readUInt32BE(20)]).toEqual([width, height]);
    }
    const plots = (await download(page, 'save-plots')).bytes.toString();
    const faults = await page.evaluate(
      (text) => new DOMParser().parseFromString(text, 'image/svg+xml').querySelectorAll('parsererror').length,
      plots,
    );
    expect(faults).toBe(0);
    expect(plots).not.toMatch(/class=|var\(/);
    await page.locator('#save-film').click();
    const { tick } = await state(page);
    // As fast as it goes, it might be over before the recorder has a picture.
    await page.evaluate(() => window.mapless?.setSpeed(1));
    await page.evaluate(() => window.mapless?.play());
    await expect(page.locator('#save-film')).toHaveText('Stop the film');
    await until(page, (now) => now.tick > tick + 25);
    const film = await download(page, 'save-film');
    expect(film.name).toMatch(/film\.webm$/);
    expect(film.bytes.readUInt32BE(0)).toBe(0x1a45dfa3);
    expect(film.bytes.length).toBeGreaterThan(5_000);
    await expect(page.locator('#save-film')).toHaveText('Film (WebM)');
  });

  test('the view is sharp once it stands, and coarser at most while something moves', async ({ mapless: page }) => {
    const width = () =>
      page.locator('#view').evaluate(async (view: HTMLCanvasElement) => {
        const picture = await createImageBitmap(view);
        return picture.width / view.clientWidth;
      });
    await until(page, ({ tick }) => tick > 5);
    expect(await width()).toBeLessThanOrEqual(1);
    await page.evaluate(() => window.mapless?.still());
    expect(await width()).toBeCloseTo(1, 2);
    await page.evaluate(() => window.mapless?.play());
    await page.evaluate(() => window.mapless?.pause());
    await expect.poll(width).toBeCloseTo(1, 2);
  });
});

test('the digest goes to the clipboard, the paper’s numbers stand beside the run’s', async ({ mapless: page }) => {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await driveTo(page, 10);
  await page.getByRole('button', { name: 'Copy the digest' }).click();
  const { digest } = await state(page);
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toBe(digest);
  await expect(page.locator('#metrics')).toContainText('paper 63.5');
  // They are those of the paper's own course.
  const [paper, lesson] = [page.locator('#metrics').getByText('paper 63.5'), page.locator('#scene-lesson')];
  await expect(lesson).toContainText('too steep');
  await page.evaluate(() => window.mapless?.setGoal({ x: 30, y: 20 }));
  await expect(paper).toBeHidden();
  await expect(page.locator('.plot-paper')).toHaveCount(0);
  await expect(lesson).toHaveText('Changed: ground, objects, start or route are no longer the scenario’s.');
  await page.evaluate(() => window.mapless?.undo());
  await expect(lesson).toContainText('too steep');
  // The course is the scenario's own again; what drives was changed under way.
  expect((await state(page)).disturbed).toBe(true);
  await expect(paper).toBeHidden();
  await page.evaluate(() => window.mapless?.restart());
  await expect(paper).toBeVisible();
  await expect(page.locator('.plot-paper')).toHaveCount(2);
  await page.evaluate(() =>
    window.mapless?.sculpt({ kind: 'raise', radius_m: 2, strength_m: 1, points_cm: [3000, 2000] }),
  );
  await expect(paper).toBeHidden();
  // A link says so, too.
  const link = await page.evaluate(() => window.mapless?.link());
  await page.goto('about:blank');
  await page.goto(link ?? '');
  await expect(lesson).toContainText('Changed');
  await expect(paper).toBeHidden();
  await page.evaluate(() => window.mapless?.loadScenario('ml'));
  await expect(page.locator('#metrics')).toContainText('paper 84.5 ± 2.3');
  await page.evaluate(() => window.mapless?.loadScenario('gsb'));
  await expect(page.locator('#metrics')).not.toContainText('paper');
  await page.evaluate(() => window.mapless?.step());
  await expect(page.locator('#tick-ms')).toHaveText(/\d/);
  // The time of a tick, and then those of its parts.
  const times = await page.locator('#tick-ms, #scan-ms, #planner-ms, #motion-ms').allTextContents();
  const [whole = 0, ...parts] = times.map((text) => Number.parseFloat(text));
  expect(Math.abs(parts.reduce((total, part) => total + part, 0) - whole)).toBeLessThan(0.3);
});
