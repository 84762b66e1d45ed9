/** Has the page's address say what is shown, as far as an address can, and has Back go through what was opened. */

import type { Editor } from '../editor/editor.ts';
import { ASKED, askingFor } from '../experiment/address.ts';
import { sameWork } from '../experiment/autosave.ts';
import type { Experiment } from '../experiment/experiment.ts';

export class AddressBar {
  readonly #open: (experiment: Experiment) => Promise<void>;
  readonly #entries = new Map<string, Experiment>();
  #shown: Experiment | undefined;
  #goingBack = false;

  /** `open` shows an experiment that Back or Forward leads to. */
  constructor(open: (experiment: Experiment) => Promise<void>) {
    this.#open = open;
    addEventListener('popstate', () => this.#come());
  }

  /** Shows what has changed; `byItself`: nobody asked for it, so Back does not lead to what was before. Returns whether the address says all of it. */
  show(editor: Editor, byItself: boolean): boolean {
    const { experiment, scenario } = editor;
    if (!experiment || experiment === this.#shown) return true;
    const before = this.#shown;
    this.#shown = experiment;
    if (!before) {
      // What the page began with came by this very address, or without one.
      history.replaceState(this.#entry(experiment), '');
      return true;
    }
    const asking = askingFor(experiment, scenario);
    const options = new URLSearchParams(location.search);
    for (const name of ASKED) options.delete(name);
    const query = new URLSearchParams([...(asking ?? []), ...options]).toString().replaceAll('embed=', 'embed');
    const address = location.pathname + (query && `?${query}`);
    const inPlace = byItself || this.#goingBack || sameWork(before, experiment) || options.has('embed');
    if (inPlace) history.replaceState(this.#entry(experiment), '', address);
    else history.pushState(this.#entry(experiment), '', address);
    return asking !== undefined;
  }

  #entry(experiment: Experiment): string {
    const key = `${performance.timeOrigin} ${this.#entries.size}`;
    this.#entries.set(key, experiment);
    return key;
  }

  async #come(): Promise<void> {
    const experiment = this.#entries.get(String(history.state));
    // An entry of an earlier visit, or an address that somebody typed.
    if (!experiment) return location.reload();
    this.#goingBack = true;
    try {
      await this.#open(experiment);
    } finally {
      this.#goingBack = false;
    }
  }
}
