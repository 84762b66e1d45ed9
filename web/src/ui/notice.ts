/** One message at a time over the view, for what went wrong and what happens now. */

import { byId, setText } from './dom.ts';

export class Notice {
  readonly #box = byId('notice', HTMLElement);
  readonly #text = byId('notice-text', HTMLElement);
  readonly #action = byId('notice-action', HTMLButtonElement);

  constructor() {
    byId('notice-close', HTMLButtonElement).addEventListener('click', () => this.hide());
  }

  /** With an action, the notice offers a button for it. */
  show(message: string, action?: { readonly name: string; act(): void }): void {
    setText(this.#text, message);
    this.#action.hidden = action === undefined;
    this.#action.onclick = action ? () => action.act() : null;
    setText(this.#action, action?.name ?? '');
    this.#box.hidden = false;
  }

  hide(): void {
    this.#box.hidden = true;
  }
}
