import { colourFaults, DEVICES, faults } from './axe.ts';
import { expect, still, test, until } from './page.ts';

for (const [device, options] of Object.entries(DEVICES)) {
  test.describe(device, () => {
    test.use(options);
    // Each theme has all rules on one device, and those of colours on the other.
    const [scheme, other] = device === 'desktop' ? (['light', 'dark'] as const) : (['dark', 'light'] as const);

    test(`axe finds nothing serious in ${scheme}, nor in the colours of ${other}, also in what opens over the page`, async ({
      mapless: page,
    }) => {
      const show = (colorScheme: typeof scheme) => page.emulateMedia({ colorScheme, reducedMotion: 'reduce' });
      const check = async (what: string) => {
        expect(await faults(page), `${what}, ${scheme}`).toEqual([]);
        await show(other);
        expect(await colourFaults(page), `${what}, ${other}`).toEqual([]);
        await show(scheme);
      };
      await show(scheme);
      await until(page, (now) => now.tick > 5);
      await still(page);
      await check('the page');
      for (const button of ['How it works, and keys', 'Enlarge the plots', 'Terrains', 'Share and save']) {
        await page.getByRole('button', { name: button }).click();
        await expect(page.locator('dialog[open]')).toBeVisible();
        await check(button);
        await page.keyboard.press('Escape');
      }
      await page.locator('#variance').focus();
      await page.keyboard.press('ArrowRight');
      await page.evaluate(() => window.dispatchEvent(new ErrorEvent('error', { message: 'made up' })));
      await expect(page.locator('#notice')).toBeVisible();
      await expect(page.locator('.detail-close')).toBeVisible();
      await check('what is pointed at, and a notice');
      await page.locator('#notice-close').click();
      await page.keyboard.press('Escape');
      for (const [key, opened] of [
        ['x', '#layers'],
        ['h', '#tour'],
      ] as const) {
        await page.keyboard.press(key);
        await expect(page.locator(opened)).toBeVisible();
        await check(opened);
        await page.keyboard.press('Escape');
      }
      await page.getByRole('button', { name: /^Parameters, comparison/ }).click();
      for (const tab of ['Parameters', 'Compare', 'Seeds']) {
        await page.getByRole('tab', { name: tab }).click();
        await expect(page.getByRole('tabpanel', { name: tab })).toBeVisible();
        await check(tab);
      }
    });
  });
}

test('the first stop of the keyboard leads past the controls to the view', async ({ mapless: page }) => {
  await page.keyboard.press('Tab');
  const link = page.getByRole('link', { name: 'Skip to the 3D view' });
  await expect(link).toBeFocused();
  await expect(link).toBeInViewport();
  await page.keyboard.press('Enter');
  await expect(page.locator('#view')).toBeFocused();
  expect(new URL(page.url()).hash).toBe('');
});

test('nothing moves by itself where reduced motion is asked for', async ({ mapless: page }) => {
  await page.emulateMedia({ reducedMotion: 'reduce' });
  const moving = await page.evaluate(() =>
    [...document.querySelectorAll('*')]
      .filter((one) => {
        const { transitionDuration, animationName } = getComputedStyle(one);
        return animationName !== 'none' || transitionDuration.split(',').some((time) => Number.parseFloat(time) > 0);
      })
      .map((one) => one.id || one.className),
  );
  expect(moving).toEqual([]);
});
