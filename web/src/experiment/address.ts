/** What the page's address asks for: `?scenario=cht-ad`, with `&seed=7` and `&preset=paper`. */

import { fail, oneOf, whole } from '../base/checks.ts';
import { MAX_SEED, PRESETS } from './experiment.ts';
import type { Preset } from './setting.ts';

export interface Asked {
  readonly scenario: string;
  readonly preset: Preset | undefined;
  /** The scenario's own without it. */
  readonly seed: number | undefined;
}

/** Nothing when no scenario is asked for; throws where the address makes no sense. */
export function askedFor(options: URLSearchParams): Asked | undefined {
  const [scenario, preset, seed] = ['scenario', 'preset', 'seed'].map((name) => options.get(name) ?? undefined);
  if (scenario === undefined) {
    if (preset !== undefined || seed !== undefined)
      fail('?scenario', undefined, 'a name, since a seed or a preset is given');
    return undefined;
  }
  return {
    scenario,
    preset: preset === undefined ? undefined : oneOf(preset, '?preset', PRESETS),
    seed: seed === undefined ? undefined : whole(/^\d+$/.test(seed) ? Number(seed) : seed, '?seed', 0, MAX_SEED),
  };
}
