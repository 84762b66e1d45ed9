/** One parameter over values and seeds, in the background: what it buys, as a plot, a table to replay from, and files. */

import type { App } from '../app/app.ts';
import { button, html, setText } from '../base/dom.ts';
import { clock, fixed } from '../base/format.ts';
import { messageOf } from '../base/messageOf.ts';
import { label, type Parameter } from '../experiment/parameters.ts';
import { download } from '../files/download.ts';
import { OUTCOME_WORDS } from '../inspector/status.ts';
import { METRIC_ROWS } from '../measurements/metrics.ts';
import type { NamedFile, SessionInfo } from '../protocol/simulationProtocol.ts';
import { campaignArchive, routeOf, trialsCsv } from '../trials/batchFiles.ts';
import { courseKey, courseOf, drivenWith } from '../trials/course.ts';
import { overridesWith, type Sweep, SweepRun, type SweptTrial, valuesIn } from '../trials/sweep.ts';
import type { Summary } from '../trials/trialsProtocol.ts';
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
import { sweepPlot } from './sweepPlot.ts';

const [MOST_VALUES, MOST_SEEDS] = [20, 100];
const FIRST_PATH = 'planner.perception.variance_threshold';

export class SweepTab implements Tab {
  readonly title = 'Sweep';
  readonly element = html('div');
  readonly #app: App;
  readonly #planner: PlannerChoice;
  readonly #parameter = named('select', 'Parameter');
  readonly #values = named('input', 'Values');
  readonly #count = numberInput('sweep', 'Seeds', 1, MOST_SEEDS, 5);
  readonly #metric = named('select', 'Metric');
  readonly #start = button('lab-action', 'Run', () => this.#begin());
  readonly #cancel = button('plain', 'Cancel', () => this.#end(`Cancelled after ${this.#trials.length} trials.`));
  readonly #csv = button('plain', 'Save as CSV', () => this.#saveCsv());
  readonly #campaign = button('plain', 'Save as campaign', () => this.#saveCampaign());
  readonly #note = html('p', 'lab-note');
  readonly #fault = html('p', 'parameter-fault');
  readonly #plot = html('div');
  readonly #rows = html('tbody');
  readonly #table = html('table', 'comparison trials-table');
  readonly #shown = html('div', '', [html('div', 'sweep-form', labelled(this.#metric)), this.#plot]);
  readonly #saves = html('div', 'lab-row', [this.#csv, this.#campaign]);
  #run: SweepRun | undefined;
  #sweep: Sweep | undefined;
  /** Who drives, or drove, its trials, and how one of them is seen. */
  #driver: (Driver & { readonly seen: string }) | undefined;
  /** What the command line reads, of the experiment as it was when the sweep began. */
  #files: Promise<NamedFile[]> | undefined;
  #trials: SweptTrial[] = [];
  #summaries = new Map<number, Summary>();
  #course: string | undefined;

  constructor(app: App, beside: Beside) {
    this.#app = app;
    this.#planner = new PlannerChoice('sweep', beside);
    this.#note.setAttribute('role', 'status');
    this.#fault.setAttribute('role', 'alert');
    this.#metric.append(...METRIC_ROWS.map(({ key, name }) => new Option(name, key)));
    this.#metric.addEventListener('change', () => this.#draw());
    this.#values.type = 'text';
    this.#parameter.addEventListener('change', () => this.#suggest());
    const head = ['Value', 'Seed', 'Outcome', 'Time', 'Distance'].map((name) => {
      const cell = html('th', '', [name]);
      cell.scope = 'col';
      return cell;
    });
    this.#table.append(html('thead', '', [html('tr', '', head)]), this.#rows);
    this.element.append(
      html('div', 'sweep-form', [
        ...labelled(this.#planner.select),
        ...labelled(this.#parameter),
        ...labelled(this.#values),
        ...labelled(this.#count),
      ]),
      html('div', 'lab-row', [this.#start, this.#cancel]),
      this.#note,
      this.#fault,
      this.#shown,
      this.#saves,
      this.#table,
    );
    setText(this.#note, 'Each value drives with the same seeds, in the background; the run in view goes on.');
    this.#show();
  }

  session(info: SessionInfo): void {
    this.#planner.session(info);
    if (this.#parameter.options.length === 0) this.#fill(info);
    if (this.#course !== undefined && sweepKey(info) !== this.#course) this.sculpted();
  }

  sculpted(): void {
    if (this.#course === undefined) return;
    this.#course = undefined;
    for (const replay of this.#rows.querySelectorAll('button')) replay.disabled = true;
  }

  #fill({ parameters }: SessionInfo): void {
    for (const { table, title, parameters: all } of parameters) {
      const numbers = all.filter(({ value }) => typeof value === 'number');
      if (numbers.length === 0) continue;
      const group = html(
        'optgroup',
        '',
        numbers.map(({ name }) => new Option(label(name), `${table}.${name}`)),
      );
      group.label = title;
      this.#parameter.append(group);
    }
    this.#parameter.value = FIRST_PATH;
    this.#suggest();
  }

  get #chosen(): Parameter | undefined {
    const path = this.#parameter.value;
    const groups = this.#app.info?.parameters ?? [];
    return groups
      .flatMap(({ table, parameters }) => parameters.map((one) => ({ one, path: `${table}.${one.name}` })))
      .find((known) => known.path === path)?.one;
  }

  /** The ends of what is usual, and what holds by itself. */
  #suggest(): void {
    const { value, range } = this.#chosen ?? {};
    const ends = [range?.[0], value, range?.[1]].filter((one) => typeof one === 'number');
    this.#values.value = [...new Set(ends)].sort((a, b) => a - b).join(', ');
  }

  #begin(): void {
    const { info, field } = this.#app;
    const [chosen, experiment] = [this.#chosen, this.#app.editor.experiment];
    if (!info || !field || !chosen || !experiment || !this.#count.reportValidity()) return;
    setText(this.#fault, '');
    const whole = chosen.kind === 'whole';
    try {
      const values = valuesIn(this.#values.value, whole, MOST_VALUES);
      const seeds = Array.from({ length: this.#count.valueAsNumber }, (_, index) => index + 1);
      const path = this.#parameter.value;
      const route = routeOf(info.scenario, experiment, this.#app.editor.asItComes);
      const driver = this.#planner.driver(info);
      this.#driver = { ...driver, seen: seenHow(driver, info) };
      const [planner, guest] = [driver.rival.planner, guestOf(driver)];
      this.#sweep = { course: courseOf(info, field), planner, guest, route, path, whole, values, seeds };
    } catch (error) {
      setText(this.#fault, messageOf(error));
      this.#values.focus();
      return;
    }
    this.#app.touch();
    [this.#trials, this.#summaries, this.#course] = [[], new Map(), sweepKey(info)];
    this.#files = this.#app.files({ ...experiment, overrides: drivenWith(info) });
    this.#files.catch(() => undefined);
    this.#rows.replaceChildren();
    this.#tellCount();
    this.#run = new SweepRun(this.#sweep, navigator.hardwareConcurrency, {
      trial: (trial) => this.#enter(trial),
      summary: (value, summary) => {
        this.#summaries.set(value, summary);
        this.#draw();
      },
      failed: (message) => this.#fault.append(html('span', 'fault-line', [message])),
      end: () => this.#end(this.#trials.length > 0 ? this.#driven : ''),
    });
    this.#show();
    this.#draw();
  }

  #enter(trial: SweptTrial): void {
    this.#trials.push(trial);
    const { value, result } = trial;
    const replay = button('plain', String(value), () => this.#app.attempt(this.#replay(trial)));
    replay.setAttribute('aria-label', `Show ${value} with seed ${result.seed}`);
    const end = html('td', '', [OUTCOME_WORDS[result.outcome]]);
    end.dataset.outcome = result.outcome;
    const head = html('th', '', [replay]);
    head.scope = 'row';
    const cells = [clock(result.time_s), fixed(result.metrics.distance_m, 1)];
    const seed = html('td', '', [String(result.seed)]);
    this.#rows.append(html('tr', '', [head, seed, end, ...cells.map((words) => html('td', '', [words]))]));
    this.#tellCount();
    this.#show();
  }

  #tellCount(): void {
    if (this.#driver) setText(this.#note, progressWords(this.#trials.length, this.#total, this.#driver));
  }

  get #total(): number {
    const { values = [], seeds = [] } = this.#sweep ?? {};
    return values.length * seeds.length;
  }

  get #driven(): string {
    return this.#driver ? drivenWords(this.#trials.length, this.#total, this.#driver, 'value') : '';
  }

  async #replay({ value, result }: SweptTrial): Promise<void> {
    this.#app.touch();
    if (!this.#sweep || !this.#driver || this.#course === undefined) return;
    const { course, path } = this.#sweep;
    await this.#app.setOverrides(overridesWith(course, path, value), result.seed);
    this.#planner.show(this.#driver, this.#app.info);
    await this.#app.play();
  }

  #end(words: string): void {
    this.#run?.stop();
    this.#run = undefined;
    setText(this.#note, words);
    this.#show();
  }

  #show(): void {
    this.#cancel.hidden = this.#run === undefined;
    this.#start.disabled = this.#run !== undefined;
    for (const part of [this.#table, this.#saves, this.#shown]) part.hidden = this.#trials.length === 0;
    for (const save of [this.#csv, this.#campaign]) save.disabled = this.#run !== undefined;
    this.#campaign.hidden = this.#driver?.own !== undefined;
  }

  #draw(): void {
    const metric = METRIC_ROWS.find(({ key }) => key === this.#metric.value) ?? METRIC_ROWS[0];
    if (!this.#sweep || !metric) return;
    const { values } = this.#sweep;
    this.#plot.replaceChildren(
      sweepPlot(
        values,
        values.map((value) => this.#summaries.get(value)),
        metric,
      ),
    );
  }

  #saveCsv(): void {
    const sweep = this.#sweep;
    if (!sweep) return;
    const rows = this.#trials.map(({ value, result }) => ({
      planner: sweep.planner,
      overrides: overridesWith({ overrides: drivenWith(sweep.course) }, sweep.path, value),
      result,
    }));
    download(`mapless-${sweep.route}-sweep.csv`, new Blob([trialsCsv(sweep.route, rows)], { type: 'text/csv' }));
  }

  async #saveCampaign(): Promise<void> {
    const sweep = this.#sweep;
    if (!sweep || !this.#files) return;
    try {
      download(`mapless-${sweep.route}-sweep.zip`, campaignArchive(await this.#files, sweep, sweep));
    } catch (error) {
      setText(this.#fault, messageOf(error));
    }
  }
}

/** A sweep sets parameters itself. */
function sweepKey(info: SessionInfo): string {
  return courseKey({ ...info, overrides: {} });
}

function named<K extends 'select' | 'input'>(kind: K, name: string): HTMLElementTagNameMap[K] {
  const control = html(kind);
  control.id = `sweep-${name.toLowerCase()}`;
  control.setAttribute('aria-label', name);
  return control;
}
