/** What the page's address asks for: `?scenario=cht-ad`, with `&seed=7` and `&preset=paper`. */

import { MAX_SEED, PRESETS } from './experiment.ts';
import type { Preset } from './protocol.ts';

export interface Asked {
  readonly scenario: string;
  readonly preset: Preset | undefined;
  /** The scenario's own without it. */
  readonly seed: number | undefined;
}

/** Nothing when no scenario is asked for; throws where the address makes no sense. */
export function askedFor(options: URLSearchParams): Asked | undefined {
  const scenario = options.get('scenario');
  const [preset, seed] = [options.get('preset'), options.get('seed')];
  if (scenario === null) {
    if (preset !== null || seed !== null)
      refuse('scenario', 'nothing', 'the name of one, since a seed or a preset is given');
    return undefined;
  }
  return {
    scenario,
    preset:
      preset === null
        ? undefined
        : (PRESETS.find((name) => name === preset) ?? refuse('preset', preset, PRESETS.join(' or '))),
    seed: seed === null ? undefined : wholeSeed(seed),
  };
}

function wholeSeed(text: string): number {
  const seed = Number(text);
  if (!/^\d+$/.test(text) || seed > MAX_SEED) refuse('seed', text, `a whole number from 0 to ${MAX_SEED}`);
  return seed;
}

function refuse(name: string, found: string, expected: string): never {
  throw new Error(`The page’s address says ${name} = ${found.slice(0, 60)}: expected ${expected}.`);
}
