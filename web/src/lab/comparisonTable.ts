/** The robot of the page beside its ghosts: outcome, time and the six metrics, with what is different. */

import { html, setText } from '../base/dom.ts';
import { clock, fixed } from '../base/format.ts';
import { OUTCOME_WORDS } from '../inspector/status.ts';
import { METRIC_ROWS } from '../measurements/metrics.ts';
import type { Frame, Metrics, Outcome, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { RunRecord } from '../run/record.ts';
import { OWN_PLANNER, type TrialResult } from '../trials/trialsProtocol.ts';
import { counterpart, isBehind } from './inStep.ts';
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

  /** A ghost that is behind is compared with what `record` has of its own last tick. `ownBroke` says that somebody's own planner broke off. */
  show(frame: Frame, record: RunRecord, results: ReadonlyMap<string, TrialResult>, ownBroke: boolean): void {
    for (const { planner, cells } of this.#columns) {
      if (planner === undefined) {
        fill(cells, frame.outcome, clock(frame.time_s), (key, decimals) => fixed(frame.metrics[key], decimals));
        continue;
      }
      const ghost = results.get(planner);
      if (!ghost) continue;
      const own = counterpart(ghost, frame, record);
      const stands = ownBroke && planner === OWN_PLANNER;
      const time = `${clock(ghost.time_s)}${isBehind(ghost, frame) && !stands ? ', catching up' : ''}`;
      fill(cells, stands ? 'broken' : ghost.outcome, time, (key, decimals) => {
        const difference = own ? ghost.metrics[key] - own[key] : Number.NaN;
        const gap = Number.isNaN(difference) ? '–' : `${difference > 0 ? '+' : ''}${fixed(difference, decimals)}`;
        return `${fixed(ghost.metrics[key], decimals)} (${gap})`;
      });
    }
  }
}

function fill(
  [outcomeCell, timeCell, ...cells]: readonly HTMLElement[],
  outcome: Outcome | 'broken',
  time: string,
  metric: (key: keyof Metrics, decimals: number) => string,
): void {
  if (outcomeCell) {
    setText(outcomeCell, outcome === 'broken' ? 'Broke off' : OUTCOME_WORDS[outcome]);
    outcomeCell.dataset.outcome = outcome;
  }
  if (timeCell) setText(timeCell, time);
  for (const [index, { key, decimals }] of METRIC_ROWS.entries()) {
    const cell = cells[index];
    if (cell) setText(cell, metric(key, decimals));
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
