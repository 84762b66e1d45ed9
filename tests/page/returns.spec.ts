import { expect, openLab, state, test, until } from './page.ts';

test('returns in rain and on the robot are counted in the key, which follows the layers', async ({ mapless: page }) => {
  const key = page.locator('#view-key');
  await expect(key).toBeHidden();
  const overrides = { reality: { sensing: { stray_probability: 0.02, self_returns: 20 } } };
  await page.evaluate((values) => window.mapless?.setOverrides(values), overrides);
  await page.evaluate(() => window.mapless?.play());
  await until(page, ({ setAside }) => setAside.stray > 0 && setAside.body > 0);
  await page.evaluate(() => window.mapless?.still());
  const { setAside, mountMisfit } = await state(page);
  // At some ticks a stray return counts as one overhead.
  const overhead = setAside.overhead > 0 ? [`overhead${setAside.overhead}`] : [];
  const counts = [`stray${setAside.stray}`, `on the robot${setAside.body}`, ...overhead];
  await expect(key.locator('li:visible')).toHaveText(counts);
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

test('a mount is chosen in the drawer, and the robot drives with it', async ({ mapless: page }) => {
  await openLab(page, 'Parameters');
  await page.getByRole('heading', { name: 'Sensor mount' }).click();
  await page.getByRole('button', { name: '15° down' }).click();
  await until(page, (now) => JSON.stringify(now.overrides) === '{"sensor":{"pitch_rad":-0.2618}}' && now.v_m_s > 0.2);
  await page.getByRole('button', { name: 'Upside down' }).click();
  await until(page, (now) => now.overrides.sensor !== undefined && !('pitch_rad' in Object(now.overrides.sensor)));
  const roll = page.getByRole('spinbutton', { name: 'roll', exact: true });
  await expect(roll).toHaveValue('3.1416');
  await until(page, (now) => now.v_m_s > 0.2);
  // As shown it is a little more than half a turn; as meant it is half a turn.
  await roll.fill('-3.1416');
  await roll.blur();
  await until(page, (now) => JSON.stringify(now.overrides) === `{"sensor":{"roll_rad":${-Math.PI}}}`);
  await page.getByRole('button', { name: 'Level' }).click();
  await until(page, (now) => Object.keys(now.overrides).length === 0);
});
