/** Why this subgoal: the cheapest candidates with their cost, term by term. */

import type { Frame, SessionInfo, Subgoal } from '../core/protocol.ts';
import { html, setText } from '../ui/dom.ts';
import { fixed } from '../ui/format.ts';
import { costColour, css } from '../ui/scale.ts';

const SHOWN = 5;

interface Line {
  readonly row: HTMLElement;
  readonly dot: HTMLElement;
  readonly where: HTMLElement;
  readonly bars: HTMLElement[];
  readonly total: HTMLElement;
}

export class DecisionPanel {
  readonly #list: HTMLElement;
  readonly #legend: HTMLElement;
  readonly #summary: HTMLElement;
  #lines: Line[] = [];

  constructor(list: HTMLElement, legend: HTMLElement, summary: HTMLElement) {
    this.#list = list;
    this.#legend = legend;
    this.#summary = summary;
  }

  session({ terms }: SessionInfo): void {
    this.#legend.replaceChildren(
      ...terms.map((name, index) => html('li', `legend-item term-${index % 6}`, [html('i', 'legend-key'), name])),
    );
    this.#lines = Array.from({ length: SHOWN }, () => newLine(terms.length));
    this.#list.replaceChildren(...this.#lines.map((line) => line.row));
  }

  show({ subgoals, segments }: Frame): void {
    const allowed = subgoals.filter((one) => !one.refused).sort((a, b) => a.total - b.total);
    const valid = segments.filter((one) => one.verdict === 'valid').length;
    setText(
      this.#summary,
      `${allowed.length} ${allowed.length === 1 ? 'candidate' : 'candidates'} on ${valid} of ${segments.length} segments`,
    );
    const highest = allowed.at(-1)?.total ?? 1;
    const lowest = allowed[0]?.total ?? 0;
    const chosen = allowed.findIndex((one) => one.chosen);
    const shown = allowed.slice(0, SHOWN);
    const last = allowed[chosen];
    if (chosen >= SHOWN && last) shown[SHOWN - 1] = last;
    const longest = Math.max(...shown.map((one) => positive(one)), 1e-9);
    this.#lines.forEach((line, index) => {
      const one = shown[index];
      line.row.classList.toggle('is-empty', !one);
      line.row.classList.toggle('is-chosen', one?.chosen === true);
      if (!one) return;
      line.dot.style.backgroundColor = css(costColour(one.total, lowest, highest));
      setText(line.where, direction(one.azimuth_rad));
      line.bars.forEach((bar, term) => {
        bar.style.width = `${((100 * Math.max(one.terms[term] ?? 0, 0)) / longest).toFixed(2)}%`;
      });
      setText(line.total, fixed(one.total, 2));
    });
  }
}

/** Length of a candidate's bar: the terms that charge something. */
function positive(one: Subgoal): number {
  return one.terms.reduce((sum, term) => sum + Math.max(term, 0), 0);
}

function direction(azimuth_rad: number): string {
  const degrees = Math.round((azimuth_rad * 180) / Math.PI);
  if (degrees === 0) return 'ahead';
  return `${Math.abs(degrees)}° ${degrees > 0 ? 'left' : 'right'}`;
}

function newLine(terms: number): Line {
  const dot = html('i', 'candidate-dot');
  const where = html('span', 'candidate-where');
  const bars = Array.from({ length: terms }, (_, index) => html('i', `candidate-bar term-${index % 6}`));
  const total = html('span', 'candidate-total');
  const row = html('li', 'candidate is-empty', [dot, where, html('span', 'candidate-bars', bars), total]);
  return { row, dot, where, bars, total };
}
