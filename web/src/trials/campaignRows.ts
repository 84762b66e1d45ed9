/** The table of a campaign (`trials.csv` or `trials.parquet`), row by row, and which of its trials the page can drive itself. */

import { MAX_SEED, PRESETS } from '../experiment/experiment.ts';
import { type Overrides, override, withOverride } from '../experiment/overrides.ts';
import type { Learning, Preset } from '../experiment/setting.ts';
import type { Row } from '../files/csv.ts';
import { METRICS } from '../run/columns.ts';
import type { OverrideValue } from '../wasm/mapless_wasm.js';
import type { Rider } from './trialsProtocol.ts';

export interface CampaignRow {
  readonly planner: string;
  readonly route: string;
  /** What tells its configuration from others of the planner: parameters, perception override, reality. */
  readonly variant: string;
  readonly seed: number;
  readonly outcome: string;
  /** NaN where the trial had none. */
  readonly metrics: Readonly<Record<(typeof METRICS)[number], number>>;
  readonly digest: string;
  /** How the view drives it, or why it does not. */
  readonly replay: Replay | string;
  /** Who drives it again in the background, or why nobody does. */
  readonly rider: Rider | string;
}

export interface Replay {
  readonly scenario: string;
  readonly preset: Preset;
  readonly overrides: Overrides;
  readonly seed: number;
}

const TRAJECTORY =
  'the trajectory of a run, which does not say what was run. To see the run again, open its MCAP, its result (JSON) or the .run.json saved with it. Expected a campaign’s trials';
const NEEDED = ['planner', 'route', 'seed', 'outcome'];

/** Throws what the rows lack. `knows`: whether a route comes with the page. */
export function campaignRows(rows: readonly Row[], knows: (route: string) => boolean): readonly CampaignRow[] {
  const [first] = rows;
  if (!first) throw new Error('no rows: expected those of a campaign’s trials');
  const missing = NEEDED.filter((name) => first[name] === undefined);
  if (first.command_speed_m_s !== undefined) throw new Error(TRAJECTORY);
  if (missing.length > 0) throw new Error(`no column ${missing.join(', ')}: expected those of a campaign’s trials`);
  return rows.map((row) => campaignRow(row, knows(row.route ?? '')));
}

function campaignRow(row: Row, known: boolean): CampaignRow {
  const { planner = '', route = '', parameters = '', truth = 'none', reality = '', outcome = '', digest = '' } = row;
  const numbers = METRICS.map((name) => [name, row[name] ? Number(row[name]) : Number.NaN]);
  const words = [parameters, truth === 'none' ? '' : `truth=${truth}`, reality && `reality=${reality}`];
  const variant = words.filter((part) => part !== '').join(' ');
  const seed = Number(row.seed);
  const reason = obstacle(known, truth, reality, seed);
  const overrides = overridesIn(parameters);
  const learning = (override(overrides, 'planner.perception.learning', 'mode') ?? 'fixed') as Learning;
  return {
    planner,
    route,
    variant,
    seed,
    outcome,
    metrics: Object.fromEntries(numbers),
    digest,
    replay: reason ?? replayOf(planner, route, overrides, seed),
    rider: reason ?? { name: nameOf({ planner, variant }), planner, learning, overrides },
  };
}

/** Why the page cannot drive a trial, whoever drives it. */
function obstacle(known: boolean, truth: string, reality: string, seed: number): string | undefined {
  if (!known) return 'Its route does not come with the page.';
  if (truth !== 'none') return 'The page has no perception override.';
  if (reality !== '') return 'The table does not say what its reality sets.';
  if (!(Number.isInteger(seed) && seed >= 0 && seed <= MAX_SEED)) return 'Its seed is none of the page’s.';
  return undefined;
}

function replayOf(planner: string, scenario: string, overrides: Overrides, seed: number): Replay | string {
  const preset = PRESETS.find((one) => one === planner);
  if (!preset) return 'The view drives the planners default and paper; the map of paths has the others.';
  return { scenario, preset, overrides, seed };
}

/** What its planner and configuration are called together. */
export function nameOf({ planner, variant }: Pick<CampaignRow, 'planner' | 'variant'>): string {
  return variant ? `${planner}, ${variant}` : planner;
}

/** `path=value`, with spaces between. */
function overridesIn(parameters: string): Overrides {
  let overrides: Overrides = {};
  for (const [, table = '', name = '', value = ''] of parameters.matchAll(/([\w.]+)\.(\w+)=(\[[^\]]*\]|\S+)/g)) {
    overrides = withOverride(overrides, table, name, literalOf(value));
  }
  return overrides;
}

function literalOf(text: string): OverrideValue {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}
