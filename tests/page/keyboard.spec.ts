import { expect, moved, state, still, test, textsOf, until } from './page.ts';

test('everything runs by keyboard', async ({ mapless: page }) => {
  // Far enough from the start that a restart shows.
  await until(page, (now) => now.tick > 40);
  await page.keyboard.press('Space');
  await until(page, (now) => !now.playing);
  await expect(page.locator('#outcome')).toHaveText('Paused');
  await still(page);
  const { tick } = await state(page);
  await page.keyboard.press('s');
  await until(page, (now) => now.tick === tick + 1);
  await page.keyboard.press('.');
  await until(page, (now) => now.speed === 2);
  await page.keyboard.press(',');
  await until(page, (now) => now.speed === 1);
  const times = await textsOf(page, '#time');
  await page.keyboard.press('r');
  await expect.poll(times).toContain('0:00.0');
  await until(page, (now) => now.playing);
  await page.keyboard.press('5');
  await expect(page.getByRole('radio', { name: 'Lower' })).toBeChecked();
  const size = page.getByRole('slider', { name: 'Size' });
  const before = Number(await size.inputValue());
  await page.keyboard.press(']');
  expect(Number(await size.inputValue())).toBeGreaterThan(before);
  await page.keyboard.press('Escape');
  await expect(page.getByRole('radio', { name: 'Look' })).toBeChecked();
  const follow = page.getByRole('button', { name: 'Follow the robot' });
  await page.keyboard.press('o');
  await expect(follow).toHaveAttribute('aria-pressed', 'false');
  await page.keyboard.press('f');
  await expect(follow).toHaveAttribute('aria-pressed', 'true');
  const { scenario } = await state(page);
  await page.keyboard.press('n');
  await until(page, (now) => now.scenario !== scenario);
});

test('the help sheet opens, lists the keys and closes', async ({ mapless: page }) => {
  await page.keyboard.press('?');
  const sheet = page.getByRole('dialog', { name: 'How it works' });
  await expect(sheet).toBeVisible();
  await expect(sheet).toContainText('play or pause');
  await page.keyboard.press('Escape');
  await expect(sheet).toBeHidden();
});

test('the ground is reached by keyboard too: a goal and a hill', async ({ mapless: page }) => {
  // The cursor starts from the robot as it is drawn, which glides to where it stands.
  await still(page);
  const old = await state(page);
  await page.locator('#view').focus();
  await page.keyboard.press('2');
  for (let step = 0; step < 4; step += 1) await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Enter');
  await until(page, (now) => moved(now.goal, old.goal));
  const { goal } = await state(page);
  expect(Math.hypot(goal.x - old.pose.x, goal.y - old.pose.y)).toBeCloseTo(2, 1);
  await page.keyboard.press('4');
  for (let step = 0; step < 4; step += 1) await page.keyboard.press('ArrowUp');
  const height = () => page.evaluate((at) => window.mapless?.heightAt(at) ?? Number.NaN, goal);
  const before = await height();
  for (let dab = 0; dab < 5; dab += 1) await page.keyboard.press('Enter');
  await expect.poll(height).toBeGreaterThan(before + 0.1);
});

test('the view moves by keyboard, and back', async ({ mapless: page }) => {
  await page.locator('#view').focus();
  await page.keyboard.press('2');
  /** What lies in the middle of the view, found by dropping the goal there. */
  const middle = async () => {
    await still(page);
    const before = await state(page);
    await page.locator('#view').click();
    await until(page, (now) => moved(now.goal, before.goal));
    return (await state(page)).goal;
  };
  const steps = async (key: string) => {
    await page.keyboard.press('1');
    for (let step = 0; step < 3; step += 1) await page.keyboard.press(key);
    await page.keyboard.press('2');
  };
  const first = await middle();
  await steps('Shift+ArrowRight');
  await expect(page.getByRole('button', { name: 'Follow the robot' })).toHaveAttribute('aria-pressed', 'false');
  const right = await middle();
  expect(Math.hypot(right.x - first.x, right.y - first.y)).toBeGreaterThan(1);
  await steps('Shift+ArrowLeft');
  const back = await middle();
  expect(Math.hypot(back.x - first.x, back.y - first.y)).toBeLessThan(0.5);
});

test('every control can be reached and has a name', async ({ mapless: page }) => {
  await still(page);
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll<HTMLElement>(':is(button, select, input, [tabindex]):not([hidden], :disabled)')]
      .filter(
        (one) =>
          !one.hasAttribute('aria-label') && !(one as HTMLInputElement).labels?.length && !one.textContent?.trim(),
      )
      .map((one) => one.outerHTML),
  );
  expect(nameless).toEqual([]);
  const visited = new Set<string>();
  for (let press = 0; press < 40; press += 1) {
    await page.keyboard.press('Tab');
    visited.add(
      await page.evaluate(() => document.activeElement?.id || document.activeElement?.getAttribute('name') || ''),
    );
  }
  for (const id of [
    'scenario',
    'preset',
    'learning',
    'seed',
    'help',
    'view',
    'tool',
    'follow',
    'overview',
    'restart',
    'play',
    'step',
    'speed',
  ]) {
    expect([...visited]).toContain(id);
  }
});
