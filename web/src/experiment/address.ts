/** What the page's address asks for: `?scenario=cht-ad`, with `&seed=7`, `&preset=paper` and `&reality=field`. */

import { fail, oneOf, whole } from '../base/checks.ts';
import { MAX_SEED, PRESETS, REALITIES } from './experiment.ts';
import type { Preset } from './setting.ts';

export interface Asked {
  readonly scenario: string;
  readonly preset: Preset | undefined;
  /** The scenario's own without it. */
  readonly seed: number | undefined;
  /** The preset of what goes wrong; the scenario's own without it. */
  readonly reality: string | undefined;
}

/** Nothing when no scenario is asked for; throws where the address makes no sense. */
export function askedFor(options: URLSearchParams): Asked | undefined {
  const names = ['scenario', 'preset', 'seed', 'reality'];
  const [scenario, preset, seed, reality] = names.map((name) => options.get(name) ?? undefined);
  if (scenario === undefined) {
    if (preset !== undefined || seed !== undefined || reality !== undefined)
      fail('?scenario', undefined, 'a name, since a seed, a preset or a reality is given');
    return undefined;
  }
  return {
    scenario,
    preset: preset === undefined ? undefined : oneOf(preset, '?preset', PRESETS),
    seed: seed === undefined ? undefined : whole(/^\d+$/.test(seed) ? Number(seed) : seed, '?seed', 0, MAX_SEED),
    reality: reality === undefined ? undefined : oneOf(reality, '?reality', REALITIES),
  };
}
