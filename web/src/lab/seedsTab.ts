/** Many seeds of the present setting, run in the background: how often the goal is reached, and the metrics. */

import type { App } from '../app/app.ts';
import { button, html, setText } from '../base/dom.ts';
import { clock, fixed } from '../base/format.ts';
import { messageOf } from '../base/messageOf.ts';
import { MAX_SEED } from '../experiment/experiment.ts';
import type { Overrides } from '../experiment/overrides.ts';
import { download } from '../files/download.ts';
import { OUTCOME_WORDS } from '../inspector/status.ts';
import { METRIC_ROWS } from '../measurements/metrics.ts';
import type { NamedFile, SessionInfo } from '../protocol/simulationProtocol.ts';
import { Batch, type FromBatch, workersFor } from '../trials/batch.ts';
import { campaignArchive, type Drawn, routeOf, trialsCsv } from '../trials/batchFiles.ts';
import { courseKey, courseOf, drivenWith } from '../trials/course.ts';
import type { Summary, TrialResult } from '../trials/trialsProtocol.ts';
import type { Tab } from './lab.ts';
import { labelled, numberInput } from './numberInput.ts';
import {
  type Beside,
  type Driver,
  drivenWords,
  guestOf,
  PlannerChoice,
  progressWords,
  seenHow,
} from './plannerChoice.ts';

const MOST_SEEDS = 500;

export class SeedsTab implements Tab {
  readonly title = 'Seeds';
  readonly element = html('div');
  readonly #app: App;
  readonly #planner: PlannerChoice;
  readonly #count = numberInput('seeds', 'How many', 1, MOST_SEEDS, 10);
  readonly #first = numberInput('seeds', 'From seed', 0, MAX_SEED, 1);
  readonly #start = button('lab-action', 'Run', () => this.#begin());
  readonly #cancel = button('plain', 'Cancel', () => this.#end(`Cancelled after ${this.#done} of ${this.#total}.`));
  readonly #progress = html('progress', 'lab-progress');
  readonly #note = html('p', 'lab-note');
  readonly #stand = html('p', 'lab-note');
  readonly #fault = html('p', 'parameter-fault');
  readonly #summary = html('table', 'comparison seeds-summary');
  readonly #rows = html('tbody');
  readonly #table = html('table', 'comparison trials-table');
  readonly #campaign = button('plain', 'Save as campaign', () => this.#saveCampaign());
  readonly #saves = html('div', 'lab-row', [button('plain', 'Save as CSV', () => this.#saveCsv()), this.#campaign]);
  /** What is saved: the trials in the order of the seeds, and the files of the experiment as it was when they began. */
  #drawn: (Drawn & { readonly overrides: Overrides; readonly files: Promise<NamedFile[]> }) | undefined;
  /** Who drives, or drove, the trials of the table, and how one of them is seen. */
  #driver: (Driver & { readonly seen: string }) | undefined;
  #results: TrialResult[] = [];
  #batch: Batch | undefined;
  /** The course that the table stands for. */
  #course: { key: string; overrides: Overrides } | undefined;
  #total = 0;

  constructor(app: App, beside: Beside) {
    this.#app = app;
    this.#planner = new PlannerChoice('seeds', beside);
    this.#note.setAttribute('role', 'status');
    this.#fault.setAttribute('role', 'alert');
    this.#fault.hidden = true;
    this.#progress.setAttribute('aria-label', 'Trials done');
    const head = ['Seed', 'Outcome', 'Time', 'Distance', 'Roll', 'Pitch'].map((name) => {
      const cell = html('th', '', [name]);
      cell.scope = 'col';
      return cell;
    });
    this.#table.append(html('thead', '', [html('tr', '', head)]), this.#rows);
    const row = html('div', 'lab-row', [...labelled(this.#count), ...labelled(this.#first), this.#start, this.#cancel]);
    this.element.append(
      html('div', 'sweep-form', labelled(this.#planner.select)),
      row,
      this.#progress,
      this.#note,
      this.#stand,
      this.#fault,
      this.#summary,
      this.#saves,
      this.#table,
    );
    this.#idle();
    setText(
      this.#note,
      'Each seed gives other sensor noise. They are driven in the background; the run in view goes on.',
    );
  }

  session(info: SessionInfo): void {
    this.#planner.session(info);
    if (this.#course && courseKey(info) !== this.#course.key) this.#stale();
  }

  sculpted(): void {
    if (this.#course) this.#stale();
  }

  /** What the table says still holds, but for another course than the one in view. */
  #stale(): void {
    this.#course = undefined;
    for (const replay of this.#rows.querySelectorAll('button')) replay.disabled = true;
    setText(this.#stand, 'The course has changed since; these trials ran on the one before.');
  }

  #idle(): void {
    for (const part of [this.#cancel, this.#progress]) part.hidden = true;
    const empty = this.#done === 0;
    for (const part of [this.#summary, this.#table, this.#saves]) part.hidden = empty;
    this.#start.disabled = false;
  }

  #begin(): void {
    if (![this.#count, this.#first].every((input) => input.reportValidity())) return;
    const { info, field, editor } = this.#app;
    if (!info || !field || !editor.experiment) return;
    const course = courseOf(info, field);
    this.#app.touch();
    const first = this.#first.valueAsNumber;
    const seeds = Array.from({ length: this.#count.valueAsNumber }, (_, index) => (first + index) % (MAX_SEED + 1));
    const overrides = drivenWith(info);
    const files = this.#app.files({ ...editor.experiment, overrides });
    files.catch(() => undefined);
    const route = routeOf(info.scenario, editor.experiment, editor.asItComes);
    const driver = this.#planner.driver(info);
    this.#driver = { ...driver, seen: seenHow(driver, info) };
    this.#campaign.hidden = driver.own !== undefined;
    const planner = driver.rival.planner;
    this.#drawn = { planner, route, seeds, overrides, files };
    this.#results = [];
    this.#saves.hidden = true;
    this.#rows.replaceChildren();
    this.#summary.replaceChildren();
    this.#fault.replaceChildren();
    this.#fault.hidden = true;
    this.#course = { key: courseKey(info), overrides: info.overrides };
    setText(this.#stand, '');
    this.#total = seeds.length;
    this.#progress.max = seeds.length;
    this.#progress.value = 0;
    for (const part of [this.#cancel, this.#progress, this.#summary, this.#table]) part.hidden = false;
    this.#start.disabled = true;
    this.#tellCount();
    const workers = workersFor(seeds.length, navigator.hardwareConcurrency);
    this.#batch = new Batch({ course, planner, guest: guestOf(driver), seeds }, workers, (message) =>
      this.#hear(message),
    );
  }

  get #done(): number {
    return this.#rows.childElementCount;
  }

  #hear(message: FromBatch): void {
    switch (message.type) {
      case 'trial':
        this.#results.splice(message.place, 0, message.result);
        this.#rows.insertBefore(this.#row(message.result), this.#rows.children[message.place] ?? null);
        this.#progress.value = this.#done;
        this.#tellCount();
        break;
      case 'summary':
        this.#sum(message.summary);
        break;
      case 'failed':
        this.#fault.append(html('span', 'fault-line', [message.message]));
        this.#fault.hidden = false;
        break;
      case 'end': {
        this.#end(this.#done === 0 ? '' : this.#words);
        break;
      }
    }
  }

  #tellCount(): void {
    if (this.#driver) setText(this.#note, progressWords(this.#done, this.#total, this.#driver));
  }

  get #words(): string {
    return this.#driver ? drivenWords(this.#done, this.#total, this.#driver, 'seed') : '';
  }

  #saveCsv(): void {
    const drawn = this.#drawn;
    if (!drawn) return;
    const rows = this.#results.map((result) => ({ planner: drawn.planner, overrides: drawn.overrides, result }));
    download(`mapless-${drawn.route}-seeds.csv`, new Blob([trialsCsv(drawn.route, rows)], { type: 'text/csv' }));
  }

  async #saveCampaign(): Promise<void> {
    const drawn = this.#drawn;
    if (!drawn) return;
    try {
      download(`mapless-${drawn.route}-seeds.zip`, campaignArchive(await drawn.files, drawn));
    } catch (error) {
      setText(this.#fault, messageOf(error));
      this.#fault.hidden = false;
    }
  }

  #end(words: string): void {
    this.#batch?.stop();
    this.#batch = undefined;
    setText(this.#note, words);
    this.#idle();
  }

  #row({ seed, outcome, time_s, metrics }: TrialResult): HTMLElement {
    const replay = button('plain', String(seed), () => this.#app.attempt(this.#replay(seed)));
    replay.setAttribute('aria-label', `Show seed ${seed}`);
    const end = html('td', '', [OUTCOME_WORDS[outcome]]);
    end.dataset.outcome = outcome;
    const head = html('th', '', [replay]);
    head.scope = 'row';
    const cells = [
      clock(time_s),
      fixed(metrics.distance_m, 1),
      fixed(metrics.max_abs_roll_rad, 3),
      fixed(metrics.max_abs_pitch_rad, 3),
    ];
    return html('tr', '', [head, end, ...cells.map((words) => html('td', '', [words]))]);
  }

  #sum({ reached, trials, low, high, metrics }: Summary): void {
    const percent = (share: number) => `${fixed(100 * share, 0)} %`;
    const lines: [string, string][] = [
      ['Goal reached', `${reached} of ${trials} (95 %: ${percent(low)} to ${percent(high)})`],
      ...METRIC_ROWS.map(({ key, name, unit, decimals }): [string, string] => {
        const { mean, deviation } = metrics[key];
        return [name, `${spreadWords(mean, deviation, decimals, reached)} ${unit}`];
      }),
    ];
    const rows = lines.map(([name, words]) => {
      const head = html('th', '', [name]);
      head.scope = 'row';
      return html('tr', '', [head, html('td', '', [words])]);
    });
    const caption = html('caption', 'lab-note', [
      'Metrics: mean ± standard deviation of the trials that reached the goal',
    ]);
    this.#summary.replaceChildren(caption, html('tbody', '', rows));
  }

  /** Drives a seed of the table in the view, on the ground and route that are there. */
  async #replay(seed: number): Promise<void> {
    this.#app.touch();
    if (!this.#course || !this.#driver) return;
    await this.#app.setOverrides(this.#course.overrides, seed);
    this.#planner.show(this.#driver, this.#app.info);
    await this.#app.play();
  }
}

/** A mean with its standard deviation, which needs two trials, with as many decimals as show both. */
function spreadWords(mean: number, deviation: number, decimals: number, trials: number): string {
  if (trials < 2) return fixed(mean, decimals);
  const needed =
    deviation > 0 ? Math.max(decimals, Math.min(Math.ceil(-Math.log10(deviation)), decimals + 3)) : decimals;
  return `${fixed(mean, needed)} ± ${fixed(deviation, needed)}`;
}
