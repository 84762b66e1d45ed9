/** A card about what somebody points at: a subgoal with its cost, term by term, or a segment with its verdict. */

import { html, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import { type Cost, type Frame, type SessionInfo, TERMS } from '../protocol/simulationProtocol.ts';
import type { Target } from '../scene/selection.ts';
import { segmentReason, segmentTitle, subgoalReason, subgoalState, subgoalTitle, VERDICT_WORDS } from './explain.ts';

interface Line {
  readonly row: HTMLElement;
  readonly bar: HTMLElement;
  readonly value: HTMLElement;
}

export class DetailCard {
  readonly #card: HTMLElement;
  readonly #title = html('h3', 'detail-title');
  readonly #chip = html('span', 'detail-chip');
  readonly #lines: Line[] = TERMS.map((name, index) => newLine(name, `term-${index}`));
  readonly #total = newLine('total', 'detail-total');
  readonly #terms = html(
    'ul',
    'detail-terms',
    [...this.#lines, this.#total].map(({ row }) => row),
  );
  readonly #reason = html('p', 'detail-reason');
  readonly #segment = html('p', 'detail-segment');
  readonly #close = html('button', 'detail-close', ['×']);
  #info: SessionInfo | undefined;

  /** `close` lets go of what was pinned. */
  constructor(card: HTMLElement, close: () => void) {
    this.#card = card;
    this.#close.type = 'button';
    this.#close.setAttribute('aria-label', 'Close');
    this.#close.addEventListener('click', close);
    const head = html('div', 'detail-head', [this.#title, this.#chip, this.#close]);
    card.append(head, this.#terms, this.#reason, this.#segment);
  }

  session(info: SessionInfo): void {
    this.#info = info;
  }

  show(frame: Frame, target: Target | undefined, pinned: boolean): void {
    const info = this.#info;
    const subgoal = target?.subgoal === undefined ? undefined : frame.subgoals[target.subgoal];
    const segment = target?.segment === undefined ? undefined : frame.segments[target.segment];
    this.#card.hidden = !info || !(subgoal || segment);
    this.#close.hidden = !pinned;
    this.#terms.hidden = !subgoal?.cost;
    if (!info) return;
    if (subgoal) {
      setText(this.#title, subgoalTitle(subgoal));
      setText(this.#reason, subgoalReason(subgoal, frame));
      setText(this.#segment, segment ? `Segment: ${segmentReason(segment, info)}` : '');
      this.#state(subgoalState(subgoal));
      if (subgoal.cost) this.#showTerms(subgoal.cost, info);
    } else if (segment) {
      setText(this.#title, segmentTitle(segment));
      setText(this.#reason, segmentReason(segment, info));
      setText(this.#segment, '');
      this.#state(VERDICT_WORDS[segment.verdict]);
    }
  }

  /** The same in one sentence, for those who listen. */
  get text(): string {
    if (this.#card.hidden) return '';
    const terms = this.#terms.hidden ? [] : [...this.#lines, this.#total].filter(({ row }) => !row.hidden);
    const numbers = terms.map(({ row, value }) => `${row.firstChild?.textContent} ${value.textContent}`);
    const parts = [this.#title, this.#chip, this.#reason, this.#segment].map((one) => one.textContent ?? '');
    return [...parts.slice(0, 2), ...numbers, ...parts.slice(2)].filter((part) => part !== '').join('. ');
  }

  #state(words: string): void {
    setText(this.#chip, words);
    this.#chip.dataset.state = words.replaceAll(' ', '-');
  }

  #showTerms(terms: Cost, { preset }: SessionInfo): void {
    const longest = Math.max(...TERMS.map((name) => terms[name]), 1e-9);
    TERMS.forEach((name, index) => {
      const line = this.#lines[index];
      if (!line) return;
      const { row, bar, value } = line;
      const cost = terms[name];
      // The paper has the first three.
      row.hidden = preset === 'paper' && index > 2;
      bar.style.width = `${((100 * Math.max(cost, 0)) / longest).toFixed(1)}%`;
      setText(value, fixed(cost, 3));
    });
    setText(this.#total.value, fixed(terms.total, 3));
  }
}

function newLine(name: string, className: string): Line {
  const bar = html('i', 'detail-bar');
  const value = html('span', 'detail-value');
  const row = html('li', `detail-line ${className}`, [
    html('span', '', [name]),
    html('span', 'detail-track', [bar]),
    value,
  ]);
  return { row, bar, value };
}
