/** Trials of a batch as files: a table, and what the command line needs to drive the same ones. */

import { hashOf } from '../experiment/changes.ts';
import type { Experiment } from '../experiment/experiment.ts';
import { assignmentsOf, type Overrides } from '../experiment/overrides.ts';
import { zip } from '../files/archive.ts';
import { plainName } from '../files/download.ts';
import type { NamedFile } from '../protocol/simulationProtocol.ts';
import { METRICS } from '../run/columns.ts';
import type { TrialResult } from './trialsProtocol.ts';

/** Columns by the names of a campaign's `trials.csv`. */
const COLUMNS = ['planner', 'route', 'parameters', 'seed', 'outcome', ...METRICS, 'sim_time_s', 'ticks', 'digest'];

/** What all trials of a batch have in common. */
export interface Drawn {
  readonly planner: string;
  /** As a file is called. */
  readonly route: string;
  readonly seeds: readonly number[];
}

/** One parameter over several values. */
export interface Swept {
  /** Its table and name, as one path. */
  readonly path: string;
  readonly whole: boolean;
  readonly values: readonly number[];
}

/** A name for the course in tables and files: that of the scenario only where ground, objects and route are its own. */
export function routeOf(scenario: string, experiment: Experiment, asItComes: boolean | undefined): string {
  const name = plainName(scenario);
  if (asItComes) return name;
  return `${name === 'terrain' ? 'scenario' : name}-changed-${hashOf({ ...experiment, seed: 0, overrides: {} })}`;
}

/** A trial as a line of a table. */
export interface TrialLine {
  readonly planner: string;
  /** Those with which it was driven. */
  readonly overrides: Overrides;
  readonly result: Omit<TrialResult, 'planner'>;
}

/** A table of trials; one that is under way has no digest in it. */
export function trialsCsv(route: string, trials: readonly TrialLine[]): string {
  const lines = trials.map(({ planner, overrides, result }) => {
    const { seed, outcome, metrics, time_s, tick } = result;
    const digest = outcome === 'running' ? '' : result.digest;
    const numbers = METRICS.map((name) => metrics[name]);
    const parameters = quoted(assignmentsOf(overrides).map((one) => one.replace(' = ', '=')));
    return [planner, route, parameters, seed, outcome, ...numbers, time_s, tick, digest].join(',');
  });
  return `${[COLUMNS.join(','), ...lines].join('\n')}\n`;
}

/** Lists have commas, names quotes. */
function quoted(words: readonly string[]): string {
  const text = words.join(' ');
  return /[",]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** The campaign file of a batch over the scenario file `route`.toml beside it. */
export function campaignFile({ planner, route, seeds }: Drawn, swept?: Swept): string {
  return `# The same trials as in the page:
#   mapless trials campaign.toml
planners = ["${planner}"]
routes = ["${route}.toml"]
seeds = [${seeds.join(', ')}]
${swept ? sweptLines(swept) : ''}`;
}

function sweptLines({ path, whole, values }: Swept): string {
  const literals = values.map((value) => (!whole && Number.isInteger(value) ? value.toFixed(1) : String(value)));
  return `combine = "grid"

[[parameters]]
path = "${path}"
values = [${literals.join(', ')}]
`;
}

/** A campaign, the scenario and its terrain, with which `mapless trials` drives the same trials. */
export function campaignArchive(files: readonly NamedFile[], drawn: Drawn, swept?: Swept): Blob {
  const named = files.map((one) => (one.name === 'scenario.toml' ? { ...one, name: `${drawn.route}.toml` } : one));
  const campaign = { name: 'campaign.toml', bytes: new TextEncoder().encode(campaignFile(drawn, swept)) };
  return zip([campaign, ...named]);
}
