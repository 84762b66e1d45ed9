import { spawnSync } from 'node:child_process';
import { expect, state, test, until } from './page.ts';

test('the page and the command line drive the same way, bit by bit', async ({ mapless: page }) => {
  test.setTimeout(600_000);
  await page.evaluate(() => window.mapless?.setSpeed(Number.POSITIVE_INFINITY));
  await page.evaluate(() => window.mapless?.loadScenario('ht', { seed: 3 }));
  await page.evaluate(() => window.mapless?.play());
  await until(page, (now) => now.outcome !== 'running', 500_000);
  const { outcome, metrics, tick, digest } = await state(page);
  const command = ['run', 'terrains/scenarios/ht.toml', '--seed', '3', '--json'];
  const { stdout, stderr, error } = spawnSync('target/release/mapless', command, { encoding: 'utf8' });
  if (error)
    throw new Error('Build the command line first: cargo build --release --package mapless-cli', { cause: error });
  expect(stdout, stderr).not.toBe('');
  const run = JSON.parse(stdout);
  expect({ outcome, metrics, ticks: tick, digest }).toEqual({
    outcome: run.outcome,
    metrics: run.metrics,
    ticks: run.ticks,
    digest: run.digest,
  });
});
