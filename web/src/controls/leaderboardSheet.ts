/** The sheet of a campaign's table: who reaches the goal how often, and every trial, to be driven in the view. Loaded when such a file is opened. */

import '../style/leaderboard.css';
import { button, html, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import { loadTrials, type TrialsModule } from '../bindings/trialsModule.ts';
import { type CampaignRow, nameOf, type Replay } from '../trials/campaignRows.ts';
import { PathsMap, type Scene } from './pathsMap.ts';

/** Rows in sight: more make no table that anybody reads. */
const MOST_ROWS = 200;

const METRICS = [
  ['Distance, m', 'distance_m', 1],
  ['Roll, rad', 'max_abs_roll_rad', 3],
  ['Pitch, rad', 'max_abs_pitch_rad', 3],
] as const;

const MEANS = 'Means over the trials that reached the goal; roll and pitch are the largest of each trial.';

export class LeaderboardSheet {
  readonly #rows: readonly CampaignRow[];
  readonly #drive: (trial: Replay) => void;
  readonly #sheet = html('dialog', 'sheet sheet-wide');
  readonly #whose = html('select');
  readonly #which = html('select');
  readonly #where = html('select');
  readonly #note = html('p', 'sheet-note');
  readonly #trials = html('tbody');

  /** `scene` brings a route into the view. */
  constructor(
    file: string,
    rows: readonly CampaignRow[],
    drive: (trial: Replay) => void,
    scene: (route: string) => Promise<Scene>,
  ) {
    [this.#rows, this.#drive] = [rows, drive];
    const title = html('h2', '', [`Trials of ${file}`]);
    title.id = 'leaderboard-title';
    this.#sheet.setAttribute('aria-labelledby', title.id);
    this.#note.setAttribute('role', 'status');
    const close = button('round sheet-close', '×', () => this.#sheet.close());
    close.setAttribute('aria-label', 'Close');
    this.#whose.append(new Option('all planners', ''), ...[...groups(rows).keys()].map((one) => new Option(one, one)));
    this.#which.append(
      new Option('all outcomes', ''),
      new Option('failed', 'failed'),
      new Option('reached', 'reached'),
    );
    const routes = [...new Set(rows.map(({ route }) => route))];
    this.#where.append(new Option('all routes', ''), ...routes.map((one) => new Option(one, one)));
    for (const select of [this.#whose, this.#which, this.#where]) select.addEventListener('change', () => this.#list());
    const filters = html('div', 'row', [
      field('Planner', this.#whose),
      field('Outcome', this.#which),
      field('On route', this.#where),
    ]);
    const trials = table('Trials', ['Drive', 'Planner', 'Outcome', ...METRICS.map(([name]) => name)], this.#trials);
    const map = new PathsMap(rows, scene);
    const means = html('p', 'sheet-note', [MEANS]);
    this.#sheet.append(close, title, html('div', 'leaderboard'), means, map.element, filters, this.#note, trials);
    this.#sheet.addEventListener('close', () => {
      map.stop();
      this.#sheet.remove();
    });
  }

  async show(): Promise<void> {
    const board = standings(this.#rows, await loadTrials());
    this.#sheet.querySelector('.leaderboard')?.replaceWith(board);
    this.#list();
    document.body.append(this.#sheet);
    this.#sheet.showModal();
  }

  #list(): void {
    const [whose, which, where] = [this.#whose.value, this.#which.value, this.#where.value];
    const chosen = this.#rows.filter(
      (row) =>
        (whose === '' || nameOf(row) === whose) &&
        (where === '' || row.route === where) &&
        (which === '' || (row.outcome === 'reached') === (which === 'reached')),
    );
    const seen = Math.min(chosen.length, MOST_ROWS);
    const count = seen < chosen.length ? `The first ${seen} of ${chosen.length} trials.` : `${seen} trials.`;
    // Why some cannot be driven in the view.
    const reasons = new Set(chosen.flatMap(({ replay }) => (typeof replay === 'string' ? [replay] : [])));
    setText(this.#note, reasons.size > 0 ? `${count} What cannot be pressed: ${[...reasons].join(' ')}` : count);
    this.#trials.replaceChildren(...chosen.slice(0, MOST_ROWS).map((row) => this.#row(row)));
  }

  #row(row: CampaignRow): HTMLElement {
    const { replay, route, seed, outcome, metrics } = row;
    const drive = button('plain', `${route}, ${seed}`, () => {
      if (typeof replay === 'string') return;
      this.#sheet.close();
      this.#drive(replay);
    });
    drive.setAttribute('aria-label', `Drive ${route}, ${seed} with ${nameOf(row)}`);
    if (typeof replay === 'string') {
      drive.disabled = true;
      drive.title = replay;
    }
    const numbers = METRICS.map(([, key, decimals]) => fixed(metrics[key], decimals));
    return line(drive, [nameOf(row), outcome.replaceAll('_', ' '), ...numbers]);
  }
}

function groups(rows: readonly CampaignRow[]): Map<string, CampaignRow[]> {
  const all = new Map<string, CampaignRow[]>();
  for (const row of rows) {
    const group = all.get(nameOf(row));
    if (group) group.push(row);
    else all.set(nameOf(row), [row]);
  }
  return all;
}

/** The best first. Metrics are means over the trials that reached the goal, as in the project's own reports. */
function standings(rows: readonly CampaignRow[], module: TrialsModule): HTMLElement {
  const lines = [...groups(rows)].map(([name, all]) => {
    const reached = all.filter(({ outcome }) => outcome === 'reached');
    const { low, high } = module.wilson(reached.length, all.length);
    const means = METRICS.map(([, key, decimals]) => {
      const values = new Float64Array(reached.map(({ metrics }) => metrics[key]));
      return fixed(module.mean_and_deviation(values).mean, decimals);
    });
    return { share: reached.length / all.length, name, count: all.length, low, high, means };
  });
  lines.sort((one, other) => other.share - one.share);
  const percent = (share: number) => fixed(100 * share, 1);
  const body = lines.map(({ share, name, count, low, high, means }) =>
    line(name, [String(count), `${percent(share)} % (${percent(low)} to ${percent(high)})`, ...means]),
  );
  const head = ['Planner', 'Trials', 'Goal reached (95 %)', ...METRICS.map(([name]) => name)];
  return table('Standings', head, html('tbody', '', body));
}

function line(head: Node | string, cells: readonly string[]): HTMLElement {
  const first = html('th', '', [head]);
  first.scope = 'row';
  return html('tr', '', [first, ...cells.map((words) => html('td', '', [words]))]);
}

/** It scrolls sideways where it is wider than the sheet, by keyboard, too. */
function table(name: string, head: readonly string[], body: HTMLElement): HTMLElement {
  const cells = head.map((words) => {
    const cell = html('th', '', [words]);
    cell.scope = 'col';
    return cell;
  });
  const whole = html('table', 'standings', [html('thead', '', [html('tr', '', cells)]), body]);
  whole.setAttribute('aria-label', name);
  const frame = html('div', 'leaderboard', [whole]);
  frame.tabIndex = 0;
  frame.setAttribute('role', 'region');
  frame.setAttribute('aria-label', `${name}, scrolling`);
  return frame;
}

function field(name: string, select: HTMLSelectElement): HTMLElement {
  return html('label', 'field', [html('span', '', [name]), select]);
}
