/** Why this subgoal: the cheapest candidates with their cost, term by term. */

import { html, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import { costColours } from '../colours/costColours.ts';
import { css } from '../colours/scale.ts';
import { type Frame, type SessionInfo, type Subgoal, TERMS } from '../protocol/simulationProtocol.ts';
import { type Finder, type SelectionModel, subgoalTarget, type Target } from '../scene/selection.ts';

const SHOWN = 5;
/** The paper knows direction, distance and steepness. */
const PAPER_TERMS = 3;

interface Line {
  readonly row: HTMLButtonElement;
  readonly dot: HTMLElement;
  readonly where: HTMLElement;
  readonly bars: HTMLElement[];
  readonly total: HTMLElement;
}

export class DecisionPanel {
  readonly #list: HTMLElement;
  readonly #legend: HTMLElement;
  readonly #summary: HTMLElement;
  readonly #selection: SelectionModel;
  #lines: Line[] = [];
  /** Index of the subgoal in each line. */
  #shown: number[] = [];

  constructor(list: HTMLElement, legend: HTMLElement, summary: HTMLElement, selection: SelectionModel) {
    this.#selection = selection;
    this.#list = list;
    this.#legend = legend;
    this.#summary = summary;
  }

  session({ preset }: SessionInfo): void {
    const terms = preset === 'paper' ? TERMS.slice(0, PAPER_TERMS) : TERMS;
    this.#legend.replaceChildren(
      ...terms.map((name, index) => html('li', `legend-item term-${index % 6}`, [html('i', 'legend-key'), name])),
    );
    this.#lines = Array.from({ length: SHOWN }, () => newLine(terms.length));
    this.#list.replaceChildren(...this.#lines.map(({ row }) => html('li', '', [row])));
    this.#lines.forEach(({ row }, place) => {
      const find: Finder = (frame) => subgoalTarget(frame, this.#shown[place] ?? -1);
      for (const begin of ['pointerenter', 'focus']) row.addEventListener(begin, () => this.#selection.hover(find));
      for (const end of ['pointerleave', 'blur']) row.addEventListener(end, () => this.#selection.hover(undefined));
      row.addEventListener('click', () => this.#selection.pin(find));
    });
  }

  /** Marks what somebody points at. */
  mark(target: Target | undefined): void {
    this.#lines.forEach(({ row }, place) => {
      const index = this.#shown[place];
      row.classList.toggle('is-marked', index !== undefined && index === target?.subgoal);
    });
  }

  show({ activity, subgoals, segments }: Frame): void {
    const colourOf = costColours(subgoals);
    const total = ({ cost }: Subgoal) => cost?.total ?? Number.NaN;
    const candidates = subgoals.filter(({ cost }) => cost).sort((a, b) => total(a) - total(b));
    setText(
      this.#summary,
      activity === 'arrived' ? 'nothing left to decide' : summary(candidates.length, subgoals, segments),
    );
    const chosen = subgoals.find((one) => one.chosen);
    const shown = candidates.slice(0, SHOWN);
    // The choice is always in the list, also when it is the goal itself.
    if (chosen && !shown.includes(chosen)) shown.splice(candidates.length === 0 ? 0 : SHOWN - 1, 1, chosen);
    this.#shown = shown.map((one) => subgoals.indexOf(one));
    const longest = Math.max(...shown.map(positive), 1e-9);
    this.#lines.forEach((line, index) => {
      const one = shown[index];
      line.row.classList.toggle('is-empty', !one);
      line.row.disabled = !one;
      line.row.classList.toggle('is-chosen', one?.chosen === true);
      if (!one) return;
      const colour = colourOf(one);
      line.dot.style.backgroundColor = colour ? css(colour) : '';
      setText(line.where, one.cost ? direction(one.azimuth_rad) : 'the goal');
      line.bars.forEach((bar, index) => {
        const term = TERMS[index];
        bar.style.width = `${((100 * Math.max((term && one.cost?.[term]) ?? 0, 0)) / longest).toFixed(2)}%`;
      });
      setText(line.total, fixed(total(one), 2));
    });
  }
}

/** Length of a candidate's bar: the terms that charge something. */
function positive({ cost }: Subgoal): number {
  return TERMS.reduce((sum, term) => sum + Math.max(cost?.[term] ?? 0, 0), 0);
}

function summary(candidates: number, subgoals: Frame['subgoals'], segments: Frame['segments']): string {
  const counted = `${candidates} ${candidates === 1 ? 'candidate' : 'candidates'}`;
  const refused = (['tilt', 'unseen'] as const)
    .map((refusal) => ({ refusal, count: subgoals.filter((one) => one.refusal === refusal).length }))
    .filter(({ count }) => count > 0)
    .map(({ refusal, count }) => (refusal === 'tilt' ? `${count} would tilt` : `${count} unseen`));
  const valid = segments.filter((one) => one.verdict === 'valid').length;
  return [counted, ...refused, `${valid}/${segments.length} segments`].join(' · ');
}

export function direction(azimuth_rad: number): string {
  const degrees = Math.round((azimuth_rad * 180) / Math.PI);
  if (degrees === 0) return 'ahead';
  return `${Math.abs(degrees)}° ${degrees > 0 ? 'left' : 'right'}`;
}

function newLine(terms: number): Line {
  const dot = html('i', 'candidate-dot');
  const where = html('span', 'candidate-where');
  const bars = Array.from({ length: terms }, (_, index) => html('i', `candidate-bar term-${index % 6}`));
  const total = html('span', 'candidate-total');
  const row = html('button', 'candidate is-empty', [dot, where, html('span', 'candidate-bars', bars), total]);
  row.type = 'button';
  return { row, dot, where, bars, total };
}
