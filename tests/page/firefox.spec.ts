import { expect, test } from '@playwright/test';
import type { MaplessState } from '../../web/src/api.ts';
import { driven } from './commandLine.ts';
import { FIREFOX, Firefox } from './firefox.ts';

/** Opens the page and waits for its first scenario. */
async function opened(address: string | undefined): Promise<Firefox> {
  const firefox = await Firefox.open(FIREFOX ?? '', address ?? '');
  await expect.poll(() => firefox.evaluate<boolean>('window.mapless?.state() !== undefined')).toBe(true);
  return firefox;
}

const state = (firefox: Firefox) => firefox.evaluate<MaplessState>('mapless.state()');

test.describe('in Firefox', () => {
  test.skip(!FIREFOX, 'No Firefox was found: install it, or name it in the environment variable FIREFOX.');

  test('a run has the digest of the command line', async ({ baseURL }) => {
    test.setTimeout(600_000);
    const firefox = await opened(baseURL);
    try {
      await firefox.evaluate('mapless.setSpeed(Infinity)');
      await firefox.evaluate('mapless.loadScenario("ht", { seed: 3 })');
      await firefox.evaluate('mapless.play()');
      await expect.poll(async () => (await state(firefox)).outcome, { timeout: 500_000 }).not.toBe('running');
      const { outcome, digest } = await state(firefox);
      const run = driven('terrains/scenarios/ht.toml', '--seed', '3');
      expect({ outcome, digest }).toEqual({ outcome: run.outcome, digest: run.digest });
    } finally {
      await firefox.close();
    }
  });

  test('ground and goal change, are undone, and the page says what it cannot do', async ({ baseURL }) => {
    const firefox = await opened(baseURL);
    try {
      await firefox.evaluate('mapless.pause()');
      const height = () => firefox.evaluate<number>('mapless.heightAt({ x: 30, y: 30 })');
      const before = await height();
      await firefox.evaluate(
        'mapless.sculpt({ kind: "raise", radius_m: 2, strength_m: 0.5, points_cm: [3000, 3000] })',
      );
      expect(await height()).toBeCloseTo(before + 0.5, 3);
      await firefox.evaluate('mapless.undo()');
      expect(await height()).toBe(before);
      await firefox.evaluate('mapless.setGoal({ x: 30, y: 31 })');
      expect((await state(firefox)).goal).toEqual({ x: 30, y: 31 });
      expect(await firefox.evaluate<string>('mapless.link()')).toContain('#e=');
      // Where nothing draws WebGL, as in a Firefox without a screen, the view says so; and nothing else is amiss.
      const graphics = await firefox.evaluate<boolean>(
        'document.createElement("canvas").getContext("webgl2") !== null',
      );
      const seen = 'getComputedStyle(document.getElementById("no-view")).display !== "none"';
      await expect.poll(() => firefox.evaluate<boolean>(seen)).toBe(!graphics);
      expect(await firefox.evaluate<boolean>('document.getElementById("notice").hidden')).toBe(true);
    } finally {
      await firefox.close();
    }
  });
});
