/** One message at a time over the view, for what went wrong and what happens now. */

import { byId, setText } from '../base/dom.ts';

export class Notice {
  readonly #box = byId('notice', HTMLElement);
  readonly #text = byId('notice-text', HTMLElement);
  readonly #act = byId('notice-act', HTMLButtonElement);

  constructor() {
    byId('notice-close', HTMLButtonElement).addEventListener('click', () => this.hide());
  }

  /** What went wrong. */
  show(message: string): void {
    this.#open(message, 'fault');
  }

  /** News, with something to do about it, where there is something. */
  tell(message: string, label?: string, act?: () => void): void {
    this.#open(message, 'news');
    if (!label || !act) return;
    this.#act.hidden = false;
    setText(this.#act, label);
    this.#act.onclick = () => {
      this.hide();
      act();
    };
  }

  #open(message: string, tone: 'fault' | 'news'): void {
    setText(this.#text, message);
    this.#box.dataset.tone = tone;
    this.#act.hidden = true;
    this.#box.hidden = false;
  }

  /** Hides this message, if it is the one shown. */
  withdraw(message: string): void {
    if (this.#text.textContent === message) this.hide();
  }

  hide(): void {
    this.#box.hidden = true;
  }
}
