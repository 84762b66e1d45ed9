/** The robot of the page beside its ghosts: outcome, time and the six metrics, with what is different. */

import type { Frame, SessionInfo } from '../core/protocol.ts';
import { METRIC_ROWS } from '../panel/metrics.ts';
import { OUTCOME_WORDS } from '../panel/status.ts';
import type { TrialResult } from '../trials/protocol.ts';
import { html, setText } from '../ui/dom.ts';
import { clock, fixed } from '../ui/format.ts';
import { RIVALS, type Rival } from './planners.ts';

interface Column {
  readonly planner: string | undefined;
  readonly cells: readonly HTMLElement[];
}

const HEADS = ['Outcome', 'Time', ...METRIC_ROWS.map(({ name, unit }) => `${name}, ${unit}`)];

export class ComparisonTable {
  readonly element = html('table', 'comparison');
  #own = '';
  #columns: readonly Column[] = [];

  constructor() {
    this.element.hidden = true;
  }

  session({ preset }: SessionInfo): void {
    this.#own = RIVALS.find(({ planner }) => planner === preset)?.name ?? preset;
  }

  choose(rivals: readonly Rival[]): void {
    this.element.hidden = rivals.length === 0;
    const cells = () => HEADS.map(() => html('td', '', ['–']));
    this.#columns = [undefined, ...rivals].map((rival) => ({ planner: rival?.planner, cells: cells() }));
    const head = html('tr', '', [html('td'), heading(`${this.#own} (in view)`), ...rivals.map(rivalHeading)]);
    const rows = HEADS.map((name, row) => {
      const title = html('th', '', [name]);
      title.scope = 'row';
      return html('tr', '', [title, ...this.#columns.flatMap(({ cells }) => cells[row] ?? [])]);
    });
    const caption = html('caption', 'hidden-text', ['Metrics, and the difference to the robot in view']);
    this.element.replaceChildren(caption, html('thead', '', [head]), html('tbody', '', rows));
  }

  show(frame: Frame, results: ReadonlyMap<string, TrialResult>): void {
    for (const { planner, cells } of this.#columns) {
      const result = planner === undefined ? frame : results.get(planner);
      if (!result) continue;
      const [outcome, time, ...metrics] = cells;
      if (outcome) {
        setText(outcome, OUTCOME_WORDS[result.outcome]);
        outcome.dataset.outcome = result.outcome;
      }
      if (time) setText(time, clock(result.time_s));
      for (const [index, { key, decimals }] of METRIC_ROWS.entries()) {
        const cell = metrics[index];
        if (!cell) continue;
        const value = fixed(result.metrics[key], decimals);
        const difference = result.metrics[key] - frame.metrics[key];
        const sign = difference > 0 ? '+' : '';
        setText(cell, planner === undefined ? value : `${value} (${sign}${fixed(difference, decimals)})`);
      }
    }
  }
}

function heading(words: string): HTMLElement {
  const head = html('th', '', [words]);
  head.scope = 'col';
  return head;
}

function rivalHeading({ name, colour }: Rival): HTMLElement {
  const head = heading(name);
  const swatch = html('i', 'swatch');
  swatch.style.setProperty('--swatch', colour);
  head.prepend(swatch);
  return head;
}
