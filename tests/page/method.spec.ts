/** The method by hand: thinking again where the robot stands, and the Gaussian process taken apart. */

import type { Locator, Page } from '@playwright/test';
import { colourFaults, faults } from './axe.ts';
import { drag, driveTo, expect, moved, state, still, test, until, within } from './page.ts';

/** Another threshold for the same planner. */
const HIGHER = { planner: { perception: { variance_threshold: 0.7 } } };
const what_if = (page: Page) => page.locator('#what-if');
const method = (page: Page) => page.locator('.method');

/** Drives to this tick and stands there, paused: how a skyline answers to what is changed depends on where the robot stands. */
async function pausedAt(page: Page, tick: number): Promise<void> {
  await driveTo(page, tick);
  await page.evaluate((wanted) => window.mapless?.seek(wanted), tick);
  await still(page);
  expect(await state(page)).toMatchObject({ tick, outcome: 'running' });
}

async function openByHand(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'By hand' }).click();
  await expect(method(page)).toBeVisible();
  await expect(page.locator('.method-error')).toContainText('cm at 7 m');
}

/** Degrees off the true skyline, of what is shown. */
async function off_deg(page: Page): Promise<number> {
  // It is there once the true skyline has come.
  const said = page.locator('.method-error');
  await expect(said).toHaveText(/by \d+\.\d+°/);
  const text = await said.textContent();
  return Number(/by (\d+\.\d+)°/.exec(text ?? '')?.[1]);
}

async function adjust(page: Page, overrides: object): Promise<void> {
  await page.evaluate((values) => window.mapless?.adjust({ overrides: values as never }), overrides);
}

test('a parameter changed while paused is decided on at this very pose: nothing restarts, nothing plays', async ({
  mapless: page,
}) => {
  await pausedAt(page, 40);
  const before = await state(page);
  await page.keyboard.press('p');
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill('variance threshold');
  const field = page.getByRole('spinbutton', { name: 'variance threshold' });
  await field.fill('0.7');
  await field.press('Enter');
  await until(page, (now) => now.thought === 'what_if');
  const after = await state(page);
  expect(after).toMatchObject({ tick: before.tick, pose: before.pose, playing: false, overrides: HIGHER });
  expect(after.threshold).toBe(0.7);
  await expect(what_if(page)).toContainText('What if');
  await expect(page.locator('#outcome')).toHaveText('What if');
  await expect(page.locator('#key-former')).toBeVisible();
  // Refused, it is said at the field and what is tried stays.
  await field.fill('-1');
  await field.press('Enter');
  await expect(page.locator('.parameter:visible .parameter-fault')).toContainText('variance_threshold = -1');
  expect((await state(page)).threshold).toBe(0.7);
});

test('what is only tried leaves the run as it was, to the last bit', async ({ mapless: page }) => {
  await pausedAt(page, 30);
  const { digest } = await state(page);
  await adjust(page, HIGHER);
  await page.evaluate(() => window.mapless?.adjust({ preset: 'paper' }));
  await until(page, (now) => now.thought === 'what_if' && now.preset === 'paper');
  expect((await state(page)).digest).toBe(digest);
  await page.getByRole('button', { name: 'As it was' }).click();
  await until(page, (now) => now.thought === 'run' && now.preset === 'default');
  await expect(what_if(page)).toBeHidden();
  await page.evaluate(() => window.mapless?.play());
  await driveTo(page, 60);
  const { tick, digest: went } = await state(page);
  await page.evaluate(() => window.mapless?.restart());
  await page.evaluate(() => window.mapless?.seek(0));
  for (let step = 0; step < tick; step += 1) await page.evaluate(() => window.mapless?.step());
  expect((await state(page)).digest).toBe(went);
});

test('play asks whether to go on from here or from the start, by keyboard', async ({ mapless: page }) => {
  await pausedAt(page, 30);
  await adjust(page, HIGHER);
  const { tick, pose } = await state(page);
  await page.locator('#view').focus();
  await page.keyboard.press('Space');
  await expect(what_if(page)).toContainText('Go on from here with these settings, or from the start?');
  await expect(page.getByRole('button', { name: 'Go on from here' })).toBeFocused();
  expect(await state(page)).toMatchObject({ tick, playing: false });
  await page.keyboard.press('Enter');
  await until(page, (now) => now.tick > tick || now.outcome !== 'running');
  await still(page);
  const after = await state(page);
  expect(after.overrides).toEqual(HIGHER);
  expect(after.timeline.first).toBe(tick);
  expect(after).toMatchObject({ thought: 'run', disturbed: true, threshold: 0.7 });
  expect(moved(after.pose, pose)).toBe(true);

  await adjust(page, {});
  await page.locator('#view').focus();
  await page.keyboard.press('Space');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await until(page, (now) => now.timeline.first === 0 && now.tick > 0 && now.playing);
  expect(await state(page)).toMatchObject({ thought: 'run', disturbed: false, overrides: {} });
});

test('undo takes back what is tried, and a jump in time tries it there', async ({ mapless: page }) => {
  await pausedAt(page, 40);
  await adjust(page, HIGHER);
  const { tick } = await state(page);
  await page.evaluate((to) => window.mapless?.seek(to), tick - 25);
  await until(page, (now) => now.tick === tick - 25);
  expect(await state(page)).toMatchObject({ thought: 'what_if', threshold: 0.7, playing: false });
  await page.evaluate(() => window.mapless?.undo());
  expect(await state(page)).toMatchObject({ thought: 'run', overrides: {}, tick: tick - 25 });
});

test('a stroke while paused is sensed and decided on at this very pose', async ({ mapless: page }) => {
  await pausedAt(page, 40);
  const before = await state(page);
  const { x, y, yaw } = before.pose;
  const place = [x + 4 * Math.cos(yaw), y + 4 * Math.sin(yaw)].map((metres) => Math.round(100 * metres));
  await page.evaluate(
    (points_cm) => window.mapless?.sculpt({ kind: 'raise', radius_m: 2.5, strength_m: 2.5, points_cm }),
    place,
  );
  await until(page, (now) => now.thought === 'again');
  await expect(what_if(page)).toContainText('Thought again here');
  await expect(page.getByRole('button', { name: 'Go on from here' })).toBeHidden();
  const after = await state(page);
  expect(after).toMatchObject({ tick: before.tick, playing: false });
  // The hill is in the decision, not only in the scan.
  expect([after.segments, after.subgoals]).not.toEqual([before.segments, before.subgoals]);
  await page.keyboard.press('s');
  await until(page, (now) => now.tick === before.tick + 1);
  await expect(what_if(page)).toBeHidden();
});

test('the threshold is a handle on the scale of the image, by mouse and by keys', async ({ mapless: page }) => {
  await pausedAt(page, 40);
  await page.keyboard.press('v');
  const handle = page.getByRole('slider', { name: 'Threshold V_th' });
  await expect(handle).toBeVisible();
  await expect(handle).toHaveValue('0.3');
  await handle.focus();
  await page.keyboard.press('ArrowUp');
  await until(page, (now) => now.threshold === 0.31);
  const box = await handle.boundingBox();
  if (!box) throw new Error('It is not shown.');
  const at = (share: number) => box.y + 9 + (box.height - 18) * (1 - share);
  await page.mouse.move(box.x + box.width / 2, at((0.31 - 0.05) / 0.93));
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, at(0.8), { steps: 4 });
  await until(page, (now) => now.threshold > 0.6);
  expect((await state(page)).thought).toBe('what_if');
  await page.mouse.up();
  await until(page, (now) => JSON.stringify(now.overrides).includes('variance_threshold'));
});

/** Opens what is by hand at an exact tick; returns where the number of inducing inputs stands. */
async function inducingInputsByHand(page: Page): Promise<Locator> {
  await pausedAt(page, 60);
  await openByHand(page);
  const count = page.locator('.method-count');
  await expect(count).toHaveText(/^\d+$/);
  return count;
}

test('the process by hand: its inducing inputs, presets, sliders and threshold', async ({ mapless: page }) => {
  const count = await inducingInputsByHand(page);
  await test.step('an inducing input is taken away and put back, and strided ones are worse than the lattice', async () => {
    const all = Number(await count.textContent());
    const own = await off_deg(page);
    const slice = page.locator('.slice-canvas');
    await expect(slice).toHaveAttribute('aria-label', /^Slice ahead: skyline at/);
    for (let taken = 1; taken <= 4; taken += 1) {
      await page.getByRole('button', { name: 'Take one away' }).click();
      await expect(count).toHaveText(`${all - taken} of ${all}`);
    }
    await expect.poll(() => off_deg(page)).not.toBe(own);
    await page.getByRole('button', { name: 'Put back' }).click();
    await expect(count).toHaveText(String(all));
    await expect.poll(() => off_deg(page)).toBe(own);

    const placement = page.getByRole('combobox', { name: 'Inducing inputs' });
    await placement.selectOption('farthest_points');
    await expect(count).toHaveText(/^\d+$/);
    await expect(count).not.toHaveText(String(all));
    await placement.selectOption('strided');
    await expect.poll(() => off_deg(page)).toBeGreaterThan(own);
    await placement.selectOption('lattice');
    await expect(count).toHaveText(String(all));
    await expect.poll(() => off_deg(page)).toBe(own);
    // Nothing of this is the run's.
    expect(await state(page)).toMatchObject({ thought: 'run', overrides: {} });
  });
  await test.step('a press in the image moves the slice; with By press it takes an inducing input away', async () => {
    const all = await count.textContent();
    const image = page.locator('#variance');
    /** Presses below the middle, until one meets an inducing input if any does. */
    const press = async () => {
      for (const across of [0.4, 0.42, 0.44, 0.46]) {
        for (const down of [0.5, 0.55, 0.6, 0.65]) {
          const { x, y } = await within(image, across, down);
          await page.mouse.click(x, y);
          if ((await count.textContent()) !== all) return;
        }
      }
    };
    await press();
    await expect(page.locator('.slice-canvas')).toHaveAttribute('aria-label', /^Slice \d+° left: /);
    await still(page);
    await expect(count).toHaveText(all ?? '');
    const byPress = page.getByRole('button', { name: 'By press' });
    await byPress.focus();
    await page.keyboard.press('Enter');
    await expect(byPress).toHaveAttribute('aria-pressed', 'true');
    await press();
    await expect(count).toHaveText(new RegExp(`^\\d+ of ${all}$`));
    // The next time the panel opens, a press takes nothing.
    await page.getByRole('button', { name: 'By hand' }).click();
    await page.getByRole('button', { name: 'By hand' }).click();
    await expect(byPress).toHaveAttribute('aria-pressed', 'false');
  });
  await expect(count).toHaveText(/^\d+$/);
  await test.step('the process is changed by presets and sliders, and its skyline is compared with the true one', async () => {
    const own = await off_deg(page);
    expect(own).toBeLessThan(1.5);
    await page.getByRole('button', { name: 'Paper’s' }).click();
    await until(page, (now) => now.thought === 'what_if' && now.threshold === 0.7);
    await expect(page.locator('.method-error')).toContainText('the run’s');
    await expect.poll(() => off_deg(page)).toBeGreaterThan(own);
    await page.getByRole('button', { name: 'Default', exact: true }).click();
    await until(page, (now) => now.thought === 'run');
    await expect.poll(() => off_deg(page)).toBe(own);

    const scale = page.getByRole('slider', { name: 'ℓ elevation' });
    await scale.focus();
    for (let step = 0; step < 40; step += 1) await page.keyboard.press('ArrowRight');
    await expect.poll(() => off_deg(page)).toBeGreaterThan(own);
    expect((await state(page)).overrides).toHaveProperty('planner.perception.kernel.length_scales_rad');
  });
  await page.getByRole('button', { name: 'Default', exact: true }).click();
  await until(page, (now) => now.thought === 'run');
  await test.step('a threshold that nothing passes leaves no skyline, and says so', async () => {
    await page.getByRole('slider', { name: 'V_th' }).first().focus();
    await page.keyboard.press('Home');
    await expect(page.locator('.method-error')).toHaveText('No skyline: nowhere does the variance cross V_th.');
  });
});

test('the process by hand: its skyline, slice, paper’s values, end and failure', async ({ mapless: page }) => {
  await pausedAt(page, 40);
  await openByHand(page);
  await test.step('the true skyline is that of the radius which is tried', async () => {
    for (const surface_radius_m of [4, 6]) {
      await adjust(page, { planner: { perception: { surface_radius_m } } });
      await expect(page.locator('.method-error')).toContainText(`cm at ${surface_radius_m} m`);
      expect(await off_deg(page)).toBeLessThan(1);
    }
  });
  await adjust(page, {});
  await until(page, (now) => now.thought === 'run');
  await test.step('the slice goes where the pointer is, and along the azimuths by keys; the kernel follows it', async () => {
    const slice = page.locator('.slice-canvas');
    const azimuth = page.getByRole('slider', { name: 'Azimuth of the slice' });
    await azimuth.focus();
    await page.keyboard.press('ArrowRight');
    await expect(slice).toHaveAttribute('aria-label', /^Slice 1° right: /);
    const { x, y } = await within(page.locator('#variance'), 0.3, 0.6);
    await page.mouse.move(x, y);
    await expect(slice).toHaveAttribute('aria-label', /^Slice \d+° left: /);
    const image = page.locator('#variance');
    const before = await image.screenshot();
    await page.getByRole('checkbox', { name: /^kernel/ }).check();
    await expect.poll(async () => (await image.screenshot()).equals(before)).toBe(false);
    await page.getByRole('checkbox', { name: /^kernel/ }).uncheck();
  });
  await test.step('the paper’s process is what the paper’s planner has', async () => {
    await page.getByRole('button', { name: 'Paper’s' }).click();
    await until(page, (now) => now.threshold === 0.7);
    const values = () => page.locator('.knob output').allTextContents();
    const process = await values();
    await page.evaluate(() => window.mapless?.adjust({ preset: 'paper', overrides: {} }));
    await until(page, (now) => now.preset === 'paper' && Object.keys(now.overrides).length === 0);
    expect(await values()).toEqual(process);
  });
  await page.evaluate(() => window.mapless?.adjust({ preset: 'default', overrides: {} }));
  await until(page, (now) => now.thought === 'run');
  await test.step('closing the process leaves the image as it was before', async () => {
    const image = page.locator('#app');
    await expect(image).toHaveAttribute('data-image', 'large');
    await page.keyboard.press('m');
    await expect(method(page)).toBeHidden();
    await expect(image).toHaveAttribute('data-image', 'small');
    // Who enlarged it before, keeps it so.
    await page.keyboard.press('v');
    await page.keyboard.press('m');
    await expect(method(page)).toBeVisible();
    await page.keyboard.press('m');
    await expect(method(page)).toBeHidden();
    await expect(image).toHaveAttribute('data-image', 'large');
  });
  await openByHand(page);
  await test.step('a process without a solution is named as such, with what to do', async () => {
    const kernel = { variance: 1e9, length_scales_rad: [1, 1] };
    await adjust(page, { planner: { perception: { noise_variance_m2: 1e-9, kernel } } });
    await expect(page.locator('.method-error')).toHaveText(
      'No skyline: the noise is too small for this kernel. Press Default, or As it was.',
    );
    await expect(page.locator('#notice-text')).toHaveText(/^The Gaussian process has no solution: /);
    await page.locator('#what-if-go-on').click();
    await until(page, (now) => now.outcome === 'no_subgoal');
    await expect(page.locator('#outcome')).toHaveText('Perception failed');
    await expect(page.locator('#result-words')).toHaveText('Perception failed');
    await expect(page.locator('#reason')).toHaveText(/^The Gaussian process has no solution for this scan: /);
  });
});

test('learning without bounds climbs step by step, and its skyline runs away', async ({ mapless: page }) => {
  // Near the start, where every planner stands alike. Elsewhere the learned process may have no solution.
  await pausedAt(page, 10);
  await openByHand(page);
  const own = await off_deg(page);
  await page.getByRole('button', { name: 'Learned…' }).click();
  const said = page.locator('.method-climb-said');
  await expect(said).toHaveText(/^Step (\d+) of \1: bound −?[\d,]+ nats/);
  await until(page, (now) => now.thought === 'what_if');
  await expect.poll(() => off_deg(page)).toBeGreaterThan(own + 3);
  const step = page.getByRole('slider', { name: 'Step of learning' });
  await step.focus();
  await page.keyboard.press('Home');
  await expect(said).toContainText('Step 0 of');
  // It began where the run's own values are.
  await expect(page.locator('.method-error')).toHaveText(/by (.*); the run’s: \1\.$/);
  // Other values to begin with are those of no step.
  await page.getByRole('button', { name: 'Default', exact: true }).click();
  await expect(said).toBeHidden();
  await expect(page.getByRole('button', { name: 'Learned…' })).toHaveAttribute('aria-expanded', 'false');
});

test('weights are dragged, the candidates weighed anew and the path with them', async ({ mapless: page }) => {
  await pausedAt(page, 40);
  const before = await state(page);
  const costs = () => page.locator('.candidate-total').allTextContents();
  const old = await costs();
  await page.keyboard.press('w');
  const weight = page.getByRole('slider', { name: 'direction' });
  await expect(weight).toHaveValue('0.2');
  await weight.focus();
  for (let step = 0; step < 10; step += 1) await page.keyboard.press('ArrowRight');
  await until(page, (now) => JSON.stringify(now.overrides).includes('"direction_weight":0.7'));
  expect(await state(page)).toMatchObject({ thought: 'what_if', tick: before.tick, pose: before.pose });
  await expect.poll(costs).not.toEqual(old);
});

test('changes of mind are gone through, each with what changed it', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.loadScenario('ht'));
  await page.evaluate(() => window.mapless?.play());
  await driveTo(page, 200);
  await page.evaluate(() => window.mapless?.seek(1));
  await page.getByRole('button', { name: 'Weigh' }).click();
  const said = page.locator('.weighing-said').first();
  const ticks: number[] = [];
  for (let step = 0; step < 2; step += 1) {
    await page.getByRole('button', { name: 'Next', exact: true }).click();
    await until(page, (now) => now.tick > (ticks.at(-1) ?? 1));
    await expect(said).toHaveText(/^From .+ to .+: .+\.$/);
    ticks.push((await state(page)).tick);
  }
  await page.getByRole('button', { name: 'Earlier' }).click();
  await until(page, (now) => now.tick === ticks[0]);
  await page.evaluate(() => window.mapless?.seek(1));
  await page.getByRole('button', { name: 'Earlier' }).click();
  await expect(said).toHaveText('No earlier change of mind in the run so far.');
});

test('why not there? is answered for any place on the ground, by pointer and by keys', async ({ mapless: page }) => {
  await pausedAt(page, 40);
  await page.getByRole('button', { name: 'Weigh' }).click();
  const bearing = page.getByRole('slider', { name: 'Bearing' });
  // It is loaded on demand, and only then a press of the ground asks.
  await expect(bearing).toBeVisible();
  const why = page.locator('.weighing-said').last();
  const { x, y } = await within(page.locator('#view'), 0.6, 0.45);
  await page.mouse.click(x, y);
  await expect(why).toHaveText(/^[\d.]+ m away, .+\. In truth .+/);
  await bearing.focus();
  await page.keyboard.press('End');
  await expect(why).toHaveText(/^5\.0 m away, 180° /);
  // A hill in the way makes it too steep.
  const { pose } = await state(page);
  const hill = { x: pose.x + 5 * Math.cos(pose.yaw), y: pose.y + 5 * Math.sin(pose.yaw) };
  await page.evaluate(
    ({ x, y }) =>
      window.mapless?.sculpt({
        kind: 'raise',
        radius_m: 2,
        strength_m: 4,
        points_cm: [x, y].map((m) => Math.round(100 * m)),
      }),
    { x: hill.x + 1.2 * Math.cos(pose.yaw), y: hill.y + 1.2 * Math.sin(pose.yaw) },
  );
  await page.keyboard.press('Home');
  for (let degree = 0; degree < 180; degree += 1) await page.keyboard.press('ArrowRight');
  await expect(why).toHaveText(/^5\.0 m away, ahead\. In truth too steep .+: up to \d+° of (pitch|roll)/);
});

test('thinking again and looking inside take no longer than a few ticks, at the 95th percentile', async ({ page }) => {
  await page.addInitScript(() => {
    // From the message to the worker to its answer: the worker's time and a little more.
    const took: Record<string, number[]> = {};
    const begun = new Map<number, [string, number]>();
    Object.assign(window, { took });
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (this: Worker, message: never, ...rest: never[]) {
      const { type, id, command } = message as { type?: string; id: number; command?: { type: string } };
      if (type === 'request' && command) {
        begun.set(id, [command.type, performance.now()]);
        if (!this.onmessage || !('timed' in this)) {
          Object.assign(this, { timed: true });
          this.addEventListener('message', ({ data }) => {
            const [what, at] = (data.type === 'done' && begun.get(data.id)) || [];
            if (!what || at === undefined) return;
            took[what] ??= [];
            took[what]?.push(performance.now() - at);
          });
        }
      }
      return post.call(this, message, ...(rest as []));
    } as never;
  });
  await page.goto('/');
  await page.waitForFunction(() => (window.mapless?.state()?.tick ?? 0) > 0);
  await pausedAt(page, 60);
  // What a machine takes that is busy with others, too, is measured by its ticks.
  for (let round = 0; round < 20; round += 1) await page.evaluate(() => window.mapless?.step());
  await openByHand(page);
  for (let round = 0; round < 20; round += 1) {
    const placement = round % 2 ? 'farthest_points' : 'lattice';
    await page.getByRole('combobox', { name: 'Inducing inputs' }).selectOption(placement);
    await expect(page.locator('.method-count')).toHaveText(/^\d+$/);
    await still(page);
  }
  await page.getByRole('combobox', { name: 'Inducing inputs' }).selectOption('');
  for (let round = 0; round < 20; round += 1) {
    await adjust(page, { planner: { perception: { variance_threshold: 0.3 + 0.02 * (round + 1) } } });
  }
  const took = await page.evaluate(() => (window as unknown as { took: Record<string, number[]> }).took);
  const p95 = (name: string) => {
    const sorted = [...(took[name] ?? [])].sort((a, b) => a - b);
    expect(sorted.length, name).toBeGreaterThanOrEqual(20);
    return sorted[Math.ceil(0.95 * sorted.length) - 1] ?? Number.NaN;
  };
  const report = JSON.stringify({ tick_ms: p95('step'), inside_ms: p95('inside'), think_ms: p95('think') });
  test.info().annotations.push({ type: 'time', description: report });
  expect(p95('think'), report).toBeLessThan(6 * p95('step'));
  expect(p95('inside'), report).toBeLessThan(3 * p95('step'));
});

test('axe finds nothing serious in the process by hand and in what is only tried', async ({ mapless: page }) => {
  await pausedAt(page, 20);
  await page.emulateMedia({ colorScheme: 'light', reducedMotion: 'reduce' });
  await openByHand(page);
  await adjust(page, HIGHER);
  await expect(what_if(page)).toBeVisible();
  await page.locator('.method-equations summary').click();
  expect(await faults(page)).toEqual([]);
  await page.emulateMedia({ colorScheme: 'dark', reducedMotion: 'reduce' });
  expect(await colourFaults(page)).toEqual([]);
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('fingers open the process, drag its threshold, and answer how to go on', async ({ mapless: page }) => {
    await pausedAt(page, 40);
    await page.getByRole('button', { name: 'By hand' }).tap();
    await expect(method(page)).toBeVisible();
    await expect(page.locator('.method-error')).toContainText('cm at 7 m');
    const knob = page.getByRole('slider', { name: 'V_th', exact: true });
    await knob.evaluate((one) => one.scrollIntoView({ block: 'end' }));
    // A busy browser may take a touch for a scroll; a person would drag once more.
    await expect(async () => {
      await drag(page, [await within(knob, 0.27, 0.5), await within(knob, 0.8, 0.5)]);
      await expect.poll(async () => Number(await knob.inputValue()), { timeout: 5000 }).toBeGreaterThan(0.6);
    }).toPass({ timeout: 120_000 });
    await until(page, (now) => now.thought === 'what_if' && now.threshold > 0.6);
    const { tick } = await state(page);
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
    await page.getByRole('button', { name: 'Play' }).tap();
    await page.getByRole('button', { name: 'Go on from here' }).tap();
    await until(page, (now) => now.tick > tick || now.outcome !== 'running');
    expect((await state(page)).timeline.first).toBe(tick);
  });
});
