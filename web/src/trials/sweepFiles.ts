/** The trials of a sweep as files: a table, and what the command line needs to drive the same ones. */

import { METRICS } from '../run/columns.ts';
import type { Sweep, SweptTrial } from './sweep.ts';

/** Columns by the names of a campaign's `trials.csv`. */
const COLUMNS = ['planner', 'route', 'parameters', 'seed', 'outcome', ...METRICS, 'sim_time_s', 'ticks', 'digest'];

export function trialsCsv({ planner, route, path }: Sweep, trials: readonly SweptTrial[]): string {
  const lines = trials.map(({ value, result }) => {
    const { seed, outcome, metrics, time_s, tick, digest } = result;
    const numbers = METRICS.map((name) => metrics[name]);
    return [planner, route, `${path}=${value}`, seed, outcome, ...numbers, time_s, tick, digest].join(',');
  });
  return `${[COLUMNS.join(','), ...lines].join('\n')}\n`;
}

/** The campaign file of a sweep over the scenario file `route`.toml beside it. */
export function campaignFile({ planner, route, path, whole, values, seeds }: Omit<Sweep, 'course'>): string {
  const literals = values.map((value) => (!whole && Number.isInteger(value) ? value.toFixed(1) : String(value)));
  return `# The trials of a sweep in the page:
#   mapless trials campaign.toml
planners = ["${planner}"]
routes = ["${route}.toml"]
seeds = [${seeds.join(', ')}]
combine = "grid"

[[parameters]]
path = "${path}"
values = [${literals.join(', ')}]
`;
}
