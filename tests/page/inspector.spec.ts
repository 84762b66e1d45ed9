import { createHash } from 'node:crypto';
import type { Page } from '@playwright/test';
import { drawnIn, driveTo, expect, loaded, state, still, test, until } from './page.ts';

/** Drives until there is something to decide, then pauses. */
async function pauseAt(page: Page, tick: number): Promise<void> {
  await until(page, (now) => now.tick >= tick);
  await still(page);
}

/** The part of the view that nothing stands before. */
const CLIP = { x: 100, y: 140, width: 600, height: 400 };
/** A fingerprint of it as it stands, which a failed test can print. */
async function picture(page: Page): Promise<string> {
  await still(page);
  return createHash('sha256')
    .update(await page.screenshot({ clip: CLIP }))
    .digest('hex');
}

test('each camera shows something else, by key and by button', async ({ mapless: page }) => {
  await pauseAt(page, 10);
  const seen = new Set<string>();
  for (const [key, name] of [
    ['e', 'See with the robot’s sensor'],
    ['t', 'See from above'],
    ['f', 'Follow the robot'],
  ] as const) {
    await page.keyboard.press(key);
    await expect(page.getByRole('button', { name: name.replace('’', "'") })).toHaveAttribute('aria-pressed', 'true');
    seen.add(await picture(page));
    await drawnIn(page, '#view', 200);
  }
  await page.keyboard.press('o');
  await expect(page.locator('.camera [aria-pressed="true"]')).toHaveCount(0);
  seen.add(await picture(page));
  expect(seen.size).toBe(4);
  await page.getByRole('button', { name: 'See from above' }).click();
  await expect(page.locator('#top')).toHaveAttribute('aria-pressed', 'true');
});

test('through the robot’s eye a drag turns the gaze', async ({ mapless: page }) => {
  await pauseAt(page, 10);
  await page.keyboard.press('e');
  const before = await picture(page);
  const box = await page.locator('#view').boundingBox();
  const [x, y] = [(box?.x ?? 0) + 500, (box?.y ?? 0) + 250];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 200, y, { steps: 5 });
  await page.mouse.up();
  expect(await picture(page)).not.toBe(before);
});

test('each layer changes the view, and back', async ({ mapless: page }) => {
  await pauseAt(page, 10);
  await page.keyboard.press('x');
  const panel = page.locator('#layers');
  await expect(panel).toBeVisible();
  const plain = await picture(page);
  for (const name of ['Observed', 'Reconstructed', 'Variance', 'Segments', 'Subgoals', 'Path']) {
    const box = panel.getByRole('checkbox', { name: new RegExp(name) });
    const shown = await box.isChecked();
    await box.setChecked(!shown);
    expect(await picture(page), name).not.toBe(plain);
    await box.setChecked(shown);
    expect(await picture(page), `${name} put back`).toBe(plain);
  }
  const seen = new Set([plain]);
  for (const by of ['range', 'height', 'ring', 'none']) {
    await panel.getByRole('combobox', { name: 'Point cloud by' }).selectOption(by);
    seen.add(await picture(page));
  }
  expect(seen.size).toBe(5);
  await page.keyboard.press('Escape');
  await expect(panel).toBeHidden();
});

test('a subgoal pointed at anywhere shows its cost terms and is marked everywhere', async ({ mapless: page }) => {
  await pauseAt(page, 10);
  const card = page.locator('#detail');
  await expect(card).toBeHidden();
  const row = page.locator('.candidate').nth(1);
  const where = await row.locator('.candidate-where').textContent();
  await row.hover();
  await expect(card.locator('.detail-title')).toHaveText(new RegExp(`^(Subgoal|Target or frontier,) ${where}$`));
  await page.mouse.move(5, 5);
  await expect(card).toBeHidden();
  // The chosen one first, and then its neighbour.
  await page.locator('#variance').focus();
  await page.keyboard.press('ArrowRight');
  await expect(card.locator('.detail-chip')).toHaveText('chosen');
  await expect(page.locator('.candidate.is-marked')).toHaveClass(/is-chosen/);
  const values = (await card.locator('.detail-line .detail-value').allTextContents()).map(Number);
  const total = values.pop() ?? Number.NaN;
  expect(values).toHaveLength(5);
  expect(Math.abs(values.reduce((sum, one) => sum + one, 0) - total)).toBeLessThan(0.004);
  await expect(page.locator('#pointed')).toContainText('chosen');
  await page.keyboard.press('ArrowRight');
  await expect(card.locator('.detail-chip')).not.toHaveText('chosen');
  await page.keyboard.press('Escape');
  await expect(card).toBeHidden();
  // In the view from above, subgoals lie on a circle around the middle.
  await page.keyboard.press('t');
  await still(page);
  const box = await page.locator('#view').boundingBox();
  const middle = { x: (box?.x ?? 0) + (box?.width ?? 0) / 2, y: (box?.y ?? 0) + (box?.height ?? 0) / 2 };
  const reach_px = ((box?.height ?? 0) * 7) / (2 * 34 * Math.tan((21 * Math.PI) / 180));
  for (let turn = 0; turn < 2 * Math.PI && !(await card.isVisible()); turn += 0.05) {
    await page.mouse.move(middle.x + reach_px * Math.cos(turn), middle.y + reach_px * Math.sin(turn));
  }
  await expect(card.locator('.detail-title')).toHaveText(/^(Subgoal|Target) /);
});

test('a refused segment says which number failed', async ({ mapless: page }) => {
  const card = page.locator('#detail');
  const verdicts = new Map<string, string>();
  const refused = () => [...verdicts.keys()].filter((verdict) => verdict !== 'valid');
  // Some way along the route there is one.
  for (let tick = 10; tick < 600 && refused().length === 0; tick += 40) {
    await page.evaluate(() => window.mapless?.play());
    await driveTo(page, tick);
    await page.evaluate((wanted) => window.mapless?.seek(wanted), tick);
    await still(page);
    await page.locator('#variance').focus();
    const { segments } = await state(page);
    for (let step = 0; step < segments; step += 1) {
      await page.keyboard.press('Shift+ArrowRight');
      const text = (await card.locator('.detail-reason').textContent()) ?? '';
      verdicts.set((await card.locator('.detail-chip').textContent()) ?? '', text);
    }
    await page.keyboard.press('Escape');
  }
  expect(verdicts.get('valid')).toMatch(/m wide, .* wide enough and not too steep/);
  expect(refused().length).toBeGreaterThan(0);
  if (verdicts.has('too narrow')) expect(verdicts.get('too narrow')).toMatch(/m wide; the robot needs more than 0\.9/);
});

test('the large image shows more, and a second press makes it small again', async ({ mapless: page }) => {
  await pauseAt(page, 10);
  const height = async () => (await page.locator('#variance').boundingBox())?.height ?? 0;
  const small = await height();
  await page.keyboard.press('v');
  await expect.poll(height).toBeGreaterThan(1.5 * small);
  await drawnIn(page, '#variance', 100);
  await page.getByRole('button', { name: 'Large image' }).click();
  await expect.poll(height).toBe(small);
});

test('the tour goes through by keyboard, pauses for each page and puts everything back', async ({ mapless: page }) => {
  await until(page, (now) => now.tick > 5);
  await page.keyboard.press('h');
  const card = page.getByRole('dialog', { name: 'Guided tour' });
  await expect(card).toBeVisible();
  const titles = new Set<string>();
  for (let step = 1; step <= 11; step += 1) {
    await expect(card).toContainText(`${step} of 11`);
    titles.add((await card.getByRole('heading').textContent()) ?? '');
    await until(page, (now) => now.playing === (step === 11));
    if (step < 11) await page.keyboard.press('ArrowRight');
  }
  expect(titles.size).toBe(11);
  await page.keyboard.press('ArrowLeft');
  await expect(card).toContainText('10 of 11');
  await page.keyboard.press('Escape');
  await expect(card).toBeHidden();
  await expect(page.locator('#tour-open')).toBeFocused();
  await until(page, (now) => now.playing);
  await expect(page.locator('#follow')).toHaveAttribute('aria-pressed', 'true');
  await expect(page.locator('#detail')).toBeHidden();
});

test.describe('in a low window', () => {
  test.use({ viewport: { width: 1280, height: 720 } });

  test('each page of the tour is in sight, and goes on by keys from what was pressed', async ({ mapless: page }) => {
    await until(page, (now) => now.tick > 5);
    await page.keyboard.press('h');
    const card = page.getByRole('dialog', { name: 'Guided tour' });
    for (let step = 1; step <= 8; step += 1) {
      await expect(card).toContainText(`${step} of 11`);
      await expect
        .poll(async () => {
          const [box, view] = [await card.boundingBox(), await page.locator('#view').boundingBox()];
          return (box?.y ?? 0) >= (view?.y ?? 0);
        })
        .toBe(true);
      if (step < 8) await page.keyboard.press('ArrowRight');
    }
    await page.getByRole('button', { name: 'Learned…' }).press('Enter');
    await until(page, (now) => now.thought === 'what_if');
    await page.keyboard.press('ArrowLeft');
    await expect(card).toContainText('7 of 11');
    await page.getByRole('button', { name: 'Default', exact: true }).press('Enter');
    await page.keyboard.press('Escape');
    await expect(card).toBeHidden();
  });
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('surfaces are predicted only while something shows them', async ({ page }) => {
    await page.goto('/');
    await loaded(page);
    await until(page, (now) => now.surfaces);
    // The image is scrolled out of sight under the view.
    await page.evaluate(() => window.scrollTo(0, document.documentElement.scrollHeight));
    // Where the machine is slow, single frames lack them anyway.
    const someOfFive = async () => {
      for (let frame = 0; frame < 5; frame += 1) {
        const { tick, surfaces } = await state(page);
        if (surfaces) return true;
        await until(page, (now) => now.tick > tick);
      }
      return false;
    };
    await expect.poll(someOfFive).toBe(false);
    await page.locator('#layers-open').tap();
    await page.getByRole('checkbox', { name: /Variance/ }).check();
    await until(page, (now) => now.surfaces);
  });

  test('a tap on the image explains what is there, and the tour is taken by touch', async ({ page }) => {
    await page.goto('/');
    await loaded(page);
    await pauseAt(page, 6);
    const box = await page.locator('#variance').boundingBox();
    await page.touchscreen.tap((box?.x ?? 0) + 200, (box?.y ?? 0) + (box?.height ?? 0) / 2);
    await expect(page.locator('#detail')).toBeVisible();
    await page.locator('#detail').getByRole('button', { name: 'Close' }).tap();
    await expect(page.locator('#detail')).toBeHidden();
    await page.locator('#tour-open').tap();
    const card = page.getByRole('dialog', { name: 'Guided tour' });
    for (let step = 1; step <= 11; step += 1) {
      await expect(card).toContainText(`${step} of 11`);
      await card.getByRole('button', { name: step < 11 ? 'Next' : 'Done' }).tap();
    }
    await expect(card).toBeHidden();
    await expect(page.evaluate(() => document.documentElement.scrollWidth)).resolves.toBeLessThanOrEqual(390);
  });
});
