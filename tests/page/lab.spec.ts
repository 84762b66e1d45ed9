import { writeFileSync } from 'node:fs';
import { resolve } from 'node:path';
import type { Page } from '@playwright/test';
import { driven } from './commandLine.ts';
import { changeFirstCore, driveTo, expect, loaded, openLab, shortCourse, state, test, until } from './page.ts';

test('a parameter is found, changed, refused with the reason at its field, and reset', async ({ mapless: page }) => {
  await openLab(page, 'Parameters');
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill('noise metre');
  await expect(page.locator('.parameter:visible')).toHaveCount(0);
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill('range noise');
  await expect(page.locator('.parameter:visible')).toHaveCount(1);
  const noise = page.getByRole('spinbutton', { name: 'range noise' });
  await noise.fill('0.1');
  await noise.press('Enter');
  await until(page, (now) => JSON.stringify(now.overrides) === '{"sensor":{"range_noise_m":0.1}}');
  await expect(page.locator('#lab-count')).toHaveText('1');

  await noise.fill('7');
  await noise.press('Enter');
  await expect(page.locator('.parameter:visible .parameter-fault')).toHaveText(
    'sensor.range_noise_m = 7: expected a number from 0 to 1',
  );
  expect((await state(page)).overrides).toEqual({ sensor: { range_noise_m: 0.1 } });

  await page.getByRole('button', { name: 'Reset range noise' }).click();
  await until(page, (now) => Object.keys(now.overrides).length === 0);
  await expect(noise).toHaveValue('0.02');
  await expect(page.locator('.parameter:visible .parameter-fault')).toBeHidden();
});

test('what is written into the search is no key of the page', async ({ mapless: page }) => {
  await openLab(page, 'Parameters');
  const search = page.getByRole('searchbox', { name: 'Search parameters' });
  await search.focus();
  await page.keyboard.type('pitch bcd');
  await expect(search).toHaveValue('pitch bcd');
  await expect(page.getByRole('radio', { name: 'Look' })).toBeChecked();
});

test('a refused choice goes back to what holds, and an unusual value is called so', async ({ mapless: page }) => {
  await page.evaluate(() =>
    window.mapless?.setOverrides({ planner: { perception: { kernel: { length_scales_rad: [0.25, 0.25] } } } }),
  );
  await page.locator('#learning').selectOption('every_scan');
  await expect(page.locator('#notice-text')).toBeVisible();
  await expect(page.locator('#learning')).toHaveValue('fixed');
  expect((await state(page)).learning).toBe('fixed');
  await page.evaluate(() => window.mapless?.setOverrides({}));
  await openLab(page, 'Parameters');
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill('steepness weight');
  const field = page.locator('.parameter:visible').first();
  await expect(field.getByText('Outside what is usual')).toBeHidden();
  await field.getByRole('spinbutton').fill('1000');
  await field.getByRole('spinbutton').press('Enter');
  await expect(field.getByText('Outside what is usual')).toBeVisible();
});

test('what departs from the paper is said, and one press gives the paper as written', async ({ mapless: page }) => {
  await page.locator('#preset').selectOption('paper');
  await page.locator('#learning').selectOption('fixed');
  await openLab(page, 'Parameters');
  const summary = page.getByRole('tabpanel', { name: 'Parameters' }).locator('.lab-note').first();
  await expect(summary).toContainText('The paper has another mode.');
  await page.getByRole('button', { name: 'The paper as written' }).click();
  await until(page, (now) => now.preset === 'paper' && now.learning === 'every_scan');
  // Nobody waits for the first scan, from which it learns for long.
  await expect(summary).toContainText('The paper as written.');
});

test('one trial has no deviation', async ({ mapless: page }) => {
  await shortCourse(page, 3);
  await openLab(page, 'Seeds');
  await page.getByLabel('How many').fill('1');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(page.locator('.seeds-summary')).toContainText('1 of 1');
  await expect(page.locator('.seeds-summary tbody')).not.toContainText('±');
});

test('every kind of parameter is set, and the command line drives the same way with them', async ({
  mapless: page,
}) => {
  await shortCourse(page, 4);
  const overrides = {
    sensor: { dropout_probability: 0.2, columns: 900 },
    robot: { max_speed_m_s: 0.6 },
    planner: {
      segments: { subgoals_on_unknown: false },
      decision: { cost_model: 'paper' },
      perception: { kernel: { length_scales_rad: [0.12, 0.05] } },
    },
  };
  await page.evaluate((values) => window.mapless?.setOverrides(values), overrides);
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome !== 'running');
  const { start, goal, seed, digest, tick } = await state(page);

  const scenario = `terrain = "${resolve('terrains/cht.toml')}"
start = [${start.x}, ${start.y}, ${start.heading_rad}]
goal = [${goal.x}, ${goal.y}]
seed = ${seed}
[sensor]
dropout_probability = 0.2
columns = 900
[robot]
max_speed_m_s = 0.6
[planner.segments]
subgoals_on_unknown = false
[planner.decision]
cost_model = "paper"
[planner.perception.kernel]
length_scales_rad = [0.12, 0.05]
`;
  const file = test.info().outputPath('scenario.toml');
  writeFileSync(file, scenario);
  expect(driven(file)).toMatchObject({ digest, ticks: tick });
});

test('the table of parameters and the drawer work by keyboard', async ({ mapless: page }) => {
  await page.keyboard.press('p');
  const first = page.getByRole('tab', { name: 'Parameters' });
  await expect(first).toBeFocused();
  await page.keyboard.press('ArrowRight');
  await expect(page.getByRole('tab', { name: 'Compare' })).toBeFocused();
  await expect(page.getByRole('tabpanel', { name: 'Compare' })).toBeVisible();
  await page.keyboard.press('Escape');
  await expect(page.getByRole('button', { name: /^Parameters, comparison/ })).toBeFocused();
});

test('ghosts drive the same course: the same planner gives the same digest, another one another way', async ({
  mapless: page,
}) => {
  await shortCourse(page, 4, 3);
  await openLab(page, 'Compare');
  await page.getByRole('checkbox', { name: /^Best/ }).check();
  await page.getByRole('checkbox', { name: /^Direct/ }).check();
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome === 'reached');
  const table = page.locator('.comparison').first();
  const row = (name: string) => table.getByRole('row', { name });
  await expect(row('Outcome').getByText('Goal reached')).toHaveCount(3);
  // Distance, roll, …: no difference of the same planner with the same seed.
  for (const name of ['Distance', 'Largest roll', 'Vibration']) {
    await expect(row(name).getByRole('cell').nth(1)).toHaveText(/\(0\.0+\)$/);
  }
  await expect(row('Curvature change').getByRole('cell').nth(2)).not.toHaveText(/\(0\.0+\)$/);
});

test('a ghost that catches up is compared with the robot in view at the same tick', async ({ mapless: page }) => {
  await driveTo(page, 120);
  await openLab(page, 'Compare');
  // Each difference that the same planner with the same seed is ever shown with.
  await page.evaluate(() => {
    const seen = new Set<string>();
    Object.assign(window, { seen });
    new MutationObserver(() => {
      const texts = Array.from(
        document.querySelectorAll('.comparison tbody tr td:last-child'),
        (cell) => cell.textContent,
      );
      if (texts[1]?.includes('catching up')) for (const text of texts.slice(2)) seen.add(text?.split(' ').pop() ?? '');
    }).observe(document.body, { subtree: true, childList: true, characterData: true });
  });
  await page.getByRole('checkbox', { name: /^Best/ }).check();
  const time = page.locator('.comparison').getByRole('row', { name: 'Time' }).getByRole('cell').nth(1);
  await expect(time).toHaveText(/^\d+:\d\d\.\d$/);
  const seen = await page.evaluate(() => [...(window as unknown as { seen: Set<string> }).seen]);
  expect(seen.length).toBeGreaterThan(0);
  for (const difference of seen) expect(difference).toMatch(/^(–|\(0\.0+\))$/);
});

/** What the table and the summary of a batch of four seeds say; `most` is how many workers drove at once. */
async function batch(page: Page): Promise<{ rows: string[]; summary: string | null; most: number }> {
  const before = page.workers().length;
  let most = 0;
  page.on('worker', () => {
    most = Math.max(most, page.workers().length - before);
  });
  await shortCourse(page, 2);
  await openLab(page, 'Seeds');
  await page.getByLabel('How many').fill('4');
  await page.getByLabel('From seed').fill('41');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(page.getByText('4 trials of Best. Press a seed to see it driven.')).toBeVisible({ timeout: 200_000 });
  const rows = await page.locator('.trials-table tbody tr').allInnerTexts();
  return { rows, summary: await page.locator('.seeds-summary').textContent(), most };
}

/** Has the page believe that there are so many processors. */
function processors(page: Page, count: number): Promise<unknown> {
  return page.addInitScript((value) => {
    Object.defineProperty(navigator, 'hardwareConcurrency', { value, configurable: true });
  }, count);
}

test('many seeds run beside the page, are summed up, replayed and cancelled', async ({ mapless: page }) => {
  await shortCourse(page, 3);
  await openLab(page, 'Seeds');
  await page.getByLabel('How many').fill('3');
  await page.getByLabel('From seed').fill('41');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(page.locator('.trials-table tbody tr')).toHaveCount(3);
  await expect(page.locator('.seeds-summary')).toContainText('3 of 3 (95 %: 44 % to 100 %)');
  const time = await page.locator('.trials-table tbody tr').nth(1).getByRole('cell').nth(1).textContent();
  await page.getByRole('button', { name: 'Show seed 42' }).click();
  await until(page, (now) => now.seed === 42 && now.outcome === 'reached');
  await expect(page.locator('#time')).toHaveText(time ?? '');

  await page.getByLabel('How many').fill('200');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.getByRole('button', { name: 'Cancel' }).click();
  await expect(page.getByRole('status').filter({ hasText: /^Cancelled after \d+ of 200/ })).toBeVisible();
});

test('an object put on the course leaves the seeds as they were found, with none to replay', async ({
  mapless: page,
}) => {
  await shortCourse(page, 3);
  await openLab(page, 'Seeds');
  await page.getByLabel('How many').fill('1');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  const replay = page.getByRole('button', { name: 'Show seed 1' });
  await expect(replay).toBeEnabled();
  const { goal } = await state(page);
  await page.evaluate(
    ({ x, y }) => window.mapless?.setObjects([{ kind: 'post', at: [x, y + 2], radius_m: 0.2, height_m: 1 }]),
    goal,
  );
  await expect(replay).toBeDisabled();
  await expect(page.getByText('The course has changed since')).toBeVisible();
});

test('one worker and several give the same table and the same summary', async ({ mapless: page }) => {
  await processors(page, 2);
  await page.reload();
  await loaded(page);
  const one = await batch(page);
  await processors(page, 4);
  await page.reload();
  await loaded(page);
  const several = await batch(page);
  expect([one.most, several.most]).toEqual([1, 3]);
  expect(one.rows.map((row) => Number.parseInt(row, 10))).toEqual([41, 42, 43, 44]);
  expect(several.rows).toEqual(one.rows);
  expect(several.summary).toBe(one.summary);
});

test('a panic is told with its seed, and all other seeds are driven', async ({ mapless: page }) => {
  const trap = 'tick(){throw new WebAssembly.RuntimeError("unreachable");';
  const scripts = '**/mapless_wasm_baselines*.js';
  await changeFirstCore(page, (script) => script.replace(/\btick\(\)\s*\{/, trap), scripts);
  await processors(page, 3);
  await page.reload();
  await loaded(page);
  await shortCourse(page, 3);
  await openLab(page, 'Seeds');
  await page.getByLabel('How many').fill('6');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await expect(page.getByRole('alert').filter({ hasText: /^Seed \d: unreachable$/ })).toBeVisible();
  await expect(page.getByText('5 of 6 trials of Best. Press a seed to see it driven.')).toBeVisible({
    timeout: 200_000,
  });
  await expect(page.locator('.trials-table tbody tr')).toHaveCount(5);
  await expect(page.locator('.seeds-summary')).toContainText('5 of 5');
});
