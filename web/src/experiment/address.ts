/** What the page's address asks for: `?scenario=cht-ad`, with `&seed=7`, `&preset=paper`, `&learning=once`, `&reality=field` and `&t=8.9`. */

import { fail, number, oneOf, whole } from '../base/checks.ts';
import { type Experiment, FIRST_SETUP, LEARNING, MAX_SEED, PRESETS, REALITIES, sameCourse } from './experiment.ts';
import type { Learning, Preset } from './setting.ts';

export interface Asked {
  readonly scenario: string;
  readonly preset: Preset | undefined;
  readonly learning: Learning | undefined;
  /** The scenario's own without it. */
  readonly seed: number | undefined;
  /** The preset of what goes wrong; the scenario's own without it. */
  readonly reality: string | undefined;
  /** The time at which its run stands; without it, it drives. */
  readonly moment_s: number | undefined;
}

/** The options of an address that say what to run. */
export const ASKED = ['scenario', 'preset', 'learning', 'seed', 'reality', 't'] as const;
/** As long as a run is recorded. */
const LAST_MOMENT_S = 3600;

/** Nothing when no scenario is asked for; throws where the address makes no sense. */
export function askedFor(options: URLSearchParams): Asked | undefined {
  const [scenario, preset, learning, seed, reality, t] = ASKED.map((name) => options.get(name) ?? undefined);
  if (scenario === undefined) {
    if (ASKED.some((name) => options.has(name)))
      fail('?scenario', undefined, 'a name, since a seed, a preset, a learning, a reality or a time is given');
    return undefined;
  }
  return {
    scenario,
    preset: preset === undefined ? undefined : oneOf(preset, '?preset', PRESETS),
    learning: learning === undefined ? undefined : oneOf(learning, '?learning', LEARNING),
    seed: seed === undefined ? undefined : whole(/^\d+$/.test(seed) ? Number(seed) : seed, '?seed', 0, MAX_SEED),
    reality: reality === undefined ? undefined : oneOf(reality, '?reality', REALITIES),
    moment_s: momentOf(t),
  };
}

/** The moment that a link's fragment has behind its experiment. */
export function momentIn(hash: string): number | undefined {
  return momentOf(new URLSearchParams(hash.replace(/^[^&]*/, '')).get('t') ?? undefined);
}

function momentOf(text: string | undefined): number | undefined {
  if (text === undefined) return undefined;
  return number(/^\d+(\.\d+)?$/.test(text) ? Number(text) : text, 't', 0, LAST_MOMENT_S);
}

/** What asks for an experiment again, which `scenario` comes nearest to; nothing where no address can say it. */
export function askingFor(experiment: Experiment, scenario: Experiment | undefined): URLSearchParams | undefined {
  if (!scenario || !sameCourse(experiment, scenario)) return undefined;
  const { name, preset, learning, seed, overrides } = experiment;
  const reality = realityOf(experiment);
  if (reality === undefined && JSON.stringify(overrides) !== '{}') return undefined;
  const asked: [(typeof ASKED)[number], string | undefined][] = [
    ['scenario', name],
    ['preset', preset === FIRST_SETUP.preset ? undefined : preset],
    ['learning', learning === FIRST_SETUP.learning ? undefined : learning],
    ['seed', seed === scenario.seed ? undefined : String(seed)],
    ['reality', reality],
  ];
  return new URLSearchParams(asked.flatMap(([key, value]) => (value === undefined ? [] : [[key, value]])));
}

/** The preset of what goes wrong, where that is all that is set. */
function realityOf({ overrides }: Experiment): string | undefined {
  return REALITIES.find((preset) => JSON.stringify(overrides) === JSON.stringify({ reality: { preset } }));
}
