/** The table of a campaign (`trials.csv` or `trials.parquet`), row by row, and which of its trials the page can drive itself. */

import { MAX_SEED, PRESETS } from '../experiment/experiment.ts';
import { type Overrides, withOverride } from '../experiment/overrides.ts';
import type { Preset } from '../experiment/setting.ts';
import type { Row } from '../files/csv.ts';
import { METRICS } from '../run/columns.ts';
import type { OverrideValue } from '../wasm/mapless_wasm.js';

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
  /** How the page drives it, or why it does not. */
  readonly replay: Replay | string;
}

export interface Replay {
  readonly scenario: string;
  readonly preset: Preset;
  readonly overrides: Overrides;
  readonly seed: number;
}

const NEEDED = ['planner', 'route', 'seed', 'outcome'];

/** Throws what the rows lack. `knows`: whether a route comes with the page. */
export function campaignRows(rows: readonly Row[], knows: (route: string) => boolean): readonly CampaignRow[] {
  const [first] = rows;
  if (!first) throw new Error('no rows: expected those of a campaign’s trials');
  const missing = NEEDED.filter((name) => first[name] === undefined);
  if (missing.length > 0) throw new Error(`no column ${missing.join(', ')}: expected those of a campaign’s trials`);
  return rows.map((row) => campaignRow(row, knows(row.route ?? '')));
}

function campaignRow(row: Row, known: boolean): CampaignRow {
  const { planner = '', route = '', parameters = '', truth = 'none', reality = '', outcome = '', digest = '' } = row;
  const numbers = METRICS.map((name) => [name, row[name] ? Number(row[name]) : Number.NaN]);
  const variant = [parameters, truth === 'none' ? '' : `truth=${truth}`, reality && `reality=${reality}`];
  return {
    planner,
    route,
    variant: variant.filter((part) => part !== '').join(' '),
    seed: Number(row.seed),
    outcome,
    metrics: Object.fromEntries(numbers),
    digest,
    replay: known
      ? replayOf(planner, route, parameters, truth, reality, Number(row.seed))
      : 'Its route does not come with the page.',
  };
}

function replayOf(
  planner: string,
  route: string,
  parameters: string,
  truth: string,
  reality: string,
  seed: number,
): Replay | string {
  const preset = PRESETS.find((one) => one === planner);
  if (!preset) return 'The view drives the planners default and paper; Compare has ghosts of the others.';
  if (truth !== 'none') return 'The page has no perception override.';
  if (reality !== '') return 'The table does not say what its reality sets.';
  if (!(Number.isInteger(seed) && seed >= 0 && seed <= MAX_SEED)) return 'Its seed is none of the page’s.';
  return { scenario: route, preset, overrides: overridesIn(parameters), seed };
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
