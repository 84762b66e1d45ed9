/** Says that a decision is being made, where that takes long: learning on every scan takes seconds. */

import { byId, setText } from '../base/dom.ts';
import type { Computing } from '../protocol/simulationProtocol.ts';

/** What takes no longer is no wait. */
const STEP_MS = 500;

export class ComputingSign {
  readonly #element = byId('computing', HTMLElement);
  #timer: ReturnType<typeof setInterval> | undefined;

  /** Nothing once it is made. */
  show(what: Computing | undefined): void {
    if (this.#timer !== undefined) {
      clearInterval(this.#timer);
      this.#timer = undefined;
      this.#element.hidden = true;
    }
    if (!what) return;
    const words = `${what.learns ? 'Learning hyperparameters' : 'Planning'}, tick ${what.tick}`;
    let passed_ms = 0;
    this.#timer = setInterval(() => {
      passed_ms += STEP_MS;
      const seconds = Math.floor(passed_ms / 1000);
      setText(this.#element, seconds > 0 ? `${words}, ${seconds}\u00a0s` : `${words} …`);
      this.#element.hidden = false;
    }, STEP_MS);
  }
}
