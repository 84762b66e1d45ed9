import { driven } from './commandLine.ts';
import { expect, state, test, until } from './page.ts';

test('the page and the command line drive the same way, bit by bit', async ({ mapless: page }) => {
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 3 }));
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome !== 'running');
  const { outcome, metrics, tick, digest } = await state(page);
  const run = driven('terrains/scenarios/ht.toml', '--seed', '3');
  expect({ outcome, metrics, ticks: tick, digest }).toEqual({
    outcome: run.outcome,
    metrics: run.metrics,
    ticks: run.ticks,
    digest: run.digest,
  });
});
