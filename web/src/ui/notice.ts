/** One message at a time over the view, for what went wrong and what happens now. */

import { byId, setText } from './dom.ts';

export class Notice {
  readonly #box = byId('notice', HTMLElement);
  readonly #text = byId('notice-text', HTMLElement);

  constructor() {
    byId('notice-close', HTMLButtonElement).addEventListener('click', () => this.hide());
  }

  show(message: string): void {
    setText(this.#text, message);
    this.#box.hidden = false;
  }

  hide(): void {
    this.#box.hidden = true;
  }
}
