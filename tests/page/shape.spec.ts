import type { Page } from '@playwright/test';
import { BRUSHES } from '../../web/src/ground/brushes.ts';
import { drag, expect, loaded, moved, shortCourse, state, still, test, until, within } from './page.ts';

/** Every fourth sample of the ground, row by row. */
function ground(page: Page): Promise<number[]> {
  return page.evaluate(() => {
    const { columns = 0, rows = 0, cell_m = 1 } = window.mapless?.state()?.ground ?? {};
    const heights: number[] = [];
    for (let row = 0; row < rows; row += 4) {
      for (let column = 0; column < columns; column += 4) {
        heights.push(window.mapless?.heightAt({ x: column * cell_m, y: row * cell_m }) ?? Number.NaN);
      }
    }
    return heights;
  });
}

async function strokes(page: Page): Promise<number> {
  return page.evaluate(() => window.mapless?.experiment()?.strokes.length ?? -1);
}

test('every tool shapes the ground, and undoing leads back to the very heights', async ({ mapless: page }) => {
  await still(page);
  const before = await ground(page);
  const states = [before];
  const { x, y } = await within(page.locator('#view'), 0.5, 0.36);
  for (const [index, tool] of Object.keys(BRUSHES).entries()) {
    await page.locator(`input[name="tool"][value="${tool}"]`).check();
    if (tool === 'height') await page.locator('#brush-height').fill('9.5');
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 12, { steps: 4 });
    await page.mouse.up();
    await expect.poll(() => strokes(page), { message: tool }).toBe(index + 1);
    const after = await ground(page);
    expect(after, tool).not.toEqual(states.at(-1));
    states.push(after);
  }
  for (let index = states.length - 2; index >= 0; index -= 1) {
    await page.keyboard.press('Control+z');
    await expect.poll(() => strokes(page)).toBe(index);
    expect(await ground(page)).toEqual(states[index]);
  }
  await expect(page.locator('#undo')).toBeDisabled();
  for (let index = 1; index < states.length; index += 1) {
    await page.keyboard.press(index % 2 ? 'Control+y' : 'Control+Shift+z');
    await expect.poll(() => strokes(page)).toBe(index);
  }
  expect(await ground(page)).toEqual(states.at(-1));
  await expect(page.locator('#redo')).toBeDisabled();
});

test('goal, start and settings are undone with the buttons', async ({ mapless: page }) => {
  const old = await state(page);
  const at = { x: old.start.x + 2, y: old.start.y + 1 };
  await page.evaluate((place) => window.mapless?.setGoal(place), at);
  await page.evaluate((place) => window.mapless?.setStart({ ...place, heading_rad: 0.5 }), at);
  await page.selectOption('#preset', 'paper');
  await until(page, (now) => now.preset === 'paper');
  await page.evaluate(() => window.mapless?.setOverrides({ robot: { max_speed_m_s: 0.5 } }));
  await page.locator('#undo').click();
  await until(page, (now) => Object.keys(now.overrides).length === 0 && now.preset === 'paper');
  await page.locator('#undo').click();
  await until(page, (now) => now.preset === 'default' && now.start.x === at.x);
  await page.locator('#undo').click();
  await until(page, (now) => now.start.x === old.start.x && now.goal.x === at.x);
  await page.locator('#undo').click();
  await until(page, (now) => now.goal.x === old.goal.x);
  await page.locator('#redo').click();
  await until(page, (now) => now.goal.x === at.x);
});

test('a goal has the heading that is dragged out from it, is driven to with it, and keeps it in a link', async ({
  mapless: page,
}) => {
  await shortCourse(page, 2);
  await still(page);
  const { goal: old } = await state(page);
  await page.locator('.tool', { hasText: 'Goal' }).click();
  const view = page.locator('#view');
  await drag(page, [await within(view, 0.5, 0.45), await within(view, 0.62, 0.45)]);
  await until(page, (now) => moved(now.goal, old) && now.goal.heading_rad !== undefined);
  const { goal } = await state(page);
  const link = await page.evaluate(() => window.mapless?.link());
  await page.getByRole('button', { name: 'Play' }).click();
  await expect(page.locator('#result-words')).toHaveText('Goal reached');
  const { pose } = await state(page);
  const turn_rad = pose.yaw - (goal.heading_rad ?? Number.NaN);
  expect(Math.abs(Math.atan2(Math.sin(turn_rad), Math.cos(turn_rad)))).toBeLessThan(0.06);
  await page.goto('about:blank');
  await page.goto(link ?? '');
  await loaded(page);
  expect((await state(page)).goal).toEqual(goal);
});

test('other settings keep the ground, the start and the goal', async ({ mapless: page }) => {
  const { pose, goal } = await state(page);
  const points_cm = [Math.round(100 * pose.x) + 400, Math.round(100 * pose.y) + 400];
  const stroke = { kind: 'boulder' as const, radius_m: 2, strength_m: 1, points_cm };
  await page.evaluate((one) => window.mapless?.sculpt(one), stroke);
  const shaped = await ground(page);
  await page.locator('#seed').fill('77');
  await page.locator('#seed').press('Enter');
  await until(page, (now) => now.seed === 77 && now.tick > 0);
  expect(await ground(page)).toEqual(shaped);
  expect((await state(page)).goal).toEqual(goal);
});

test('by keyboard alone: a ramp from here to there, a boulder, and back', async ({ mapless: page }) => {
  await still(page);
  const before = await ground(page);
  await page.keyboard.press('9');
  await page.locator('#view').focus();
  for (const key of ['ArrowUp', 'Enter', 'ArrowUp', 'ArrowUp', 'Shift+ArrowLeft', 'Enter'])
    await page.keyboard.press(key);
  await expect.poll(() => strokes(page)).toBe(1);
  expect(await page.evaluate(() => window.mapless?.experiment()?.strokes[0]?.points_cm.length)).toBe(4);
  await page.keyboard.press('b');
  for (const key of ['}', ']', 'Enter']) await page.keyboard.press(key);
  await expect.poll(() => strokes(page)).toBe(2);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await expect.poll(() => strokes(page)).toBe(0);
  expect(await ground(page)).toEqual(before);
});

test('generated terrains have pictures, a start, a goal, and drive', async ({ mapless: page }) => {
  await page.keyboard.press('g');
  await expect(page.locator('#terrains-sheet')).toBeVisible();
  await page.selectOption('#family', 'easy');
  await page.locator('#terrain-seed').fill('12');
  await page.locator('#terrain-seed').press('Enter');
  await expect(page.locator('#terrains-sheet')).toBeVisible();
  const card = page.getByRole('button', { name: 'Seed 13' });
  const drawn = () => card.locator('canvas').evaluate((canvas: HTMLCanvasElement) => canvas.width);
  await expect.poll(drawn).toBeLessThan(100);
  await card.click();
  await until(page, (now) => now.scenario === 'easy 13' && now.tick > 5);
  await expect(page.locator('#scenario')).toHaveValue('easy 13');
  await expect(page.locator('#scene-title')).toContainText('easy 13');
});

test('the ground is coloured by slope and by where the robot can stand, with a legend', async ({ mapless: page }) => {
  await still(page);
  const picture = () => page.locator('#view').screenshot();
  const seen = [await picture()];
  for (const colouring of ['slope', 'stand']) {
    await page.keyboard.press('x');
    await page.selectOption('#ground-colours', colouring);
    // The layers close again, so that only the ground differs.
    await page.keyboard.press('Escape');
    await page.locator('#view').focus();
    await still(page);
    seen.push(await picture());
  }
  expect(seen[1]?.equals(seen[0] ?? Buffer.of())).toBe(false);
  expect(seen[2]?.equals(seen[1] ?? Buffer.of())).toBe(false);
  await expect(page.locator('#ground-legend')).toContainText('any heading, to 30°');
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true });

  test('a finger shapes the ground, and a tap undoes it', async ({ mapless: page }) => {
    await still(page);
    const before = await ground(page);
    await page.getByRole('radio', { name: 'Crater' }).check();
    // The row of tools scrolls, the view does not.
    expect(await page.locator('.stage').evaluate((stage) => stage.scrollLeft)).toBe(0);
    const { x, y } = await within(page.locator('#view'), 0.5, 0.36);
    await page.touchscreen.tap(x, y + 60);
    await expect.poll(() => strokes(page)).toBe(1);
    expect(await ground(page)).not.toEqual(before);
    await page.locator('#undo').tap();
    await expect.poll(() => strokes(page)).toBe(0);
    expect(await ground(page)).toEqual(before);
  });
});
