/** One history for ground, start, goal and settings: documents in the order in which they were made. */

import type { Experiment } from '../experiment/experiment.ts';

/** Documents share what they have in common, so many are cheap. */
const MOST = 300;

export class History {
  #documents: Experiment[] = [];
  #at = -1;

  get current(): Experiment | undefined {
    return this.#documents[this.#at];
  }

  /** The document before the current one. */
  get earlier(): Experiment | undefined {
    return this.#documents[this.#at - 1];
  }

  /** The document after it, where something was undone. */
  get later(): Experiment | undefined {
    return this.#documents[this.#at + 1];
  }

  /** Adds a document; what was undone is given up. */
  push(document: Experiment): void {
    this.#documents = [...this.#documents.slice(0, this.#at + 1), document].slice(-MOST);
    this.#at = this.#documents.length - 1;
  }

  back(): void {
    if (this.earlier) this.#at -= 1;
  }

  forth(): void {
    if (this.later) this.#at += 1;
  }
}
