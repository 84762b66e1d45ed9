import { expect, state, test, until } from './page.ts';

test('returns in rain and on the robot are counted in the key, which follows the layers', async ({ mapless: page }) => {
  const key = page.locator('#return-key');
  await expect(key).toBeHidden();
  const overrides = { sensor: { stray_probability: 0.02, self_returns: 20 } };
  await page.evaluate((values) => window.mapless?.setOverrides(values), overrides);
  await page.evaluate(() => window.mapless?.play());
  await until(page, ({ setAside }) => setAside.stray > 0 && setAside.body > 0);
  await page.evaluate(() => window.mapless?.still());
  const { setAside, mountMisfit } = await state(page);
  await expect(key.locator('li:visible')).toHaveText([`stray${setAside.stray}`, `on the robot${setAside.body}`]);
  expect(mountMisfit).toBeUndefined();

  await page.locator('#layers-open').click();
  await page.getByLabel('Point cloud by').selectOption('none');
  await expect(key).toBeHidden();
  await page.getByLabel('Point cloud by').selectOption('range');
  await expect(key).toBeVisible();

  await page.evaluate(() => window.mapless?.setOverrides({}));
  await page.evaluate(() => window.mapless?.step());
  await expect(key).toBeHidden();
});
