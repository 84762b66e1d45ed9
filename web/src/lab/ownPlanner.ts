/** The card of somebody's own planner: opened from a file, dropped, or written here. */

import { button, html, setText } from '../base/dom.ts';
import { messageOf } from '../base/messageOf.ts';
import type { OwnPlanner } from '../guest/confinement.ts';
import example from '../guest/example.js?raw';

const WRITTEN = 'planner.js';
const MOST_BYTES = 20_000_000;
/** Where the browser keeps what was written. */
const KEPT = 'mapless-own-planner';

export class OwnPlannerCard {
  readonly element: HTMLDetailsElement;
  readonly #drive: (planner: OwnPlanner) => void;
  readonly #code = html('textarea', 'own-code');
  readonly #said = html('p', 'lab-note');
  readonly #fault = html('p', 'parameter-fault');

  constructor(drive: (planner: OwnPlanner) => void) {
    this.#drive = drive;
    this.#code.id = 'own-code';
    this.#code.spellcheck = false;
    this.#code.rows = 16;
    this.#code.setAttribute('aria-label', 'Your planner, in JavaScript');
    this.#code.value = kept() ?? example;
    this.#code.addEventListener('input', () => keep(this.#code.value));
    this.#said.setAttribute('role', 'status');
    this.#fault.setAttribute('role', 'alert');
    const file = html('input');
    file.type = 'file';
    file.accept = '.js,.mjs,.wasm';
    file.hidden = true;
    file.setAttribute('aria-label', 'File of your planner');
    file.addEventListener('change', () => {
      const [chosen] = file.files ?? [];
      if (chosen) this.#opened(chosen);
      file.value = '';
    });
    const drives = button('lab-action', 'Drive it', () => this.#drive(this.written));
    const open = button('plain', 'Open a file', () => file.click());
    const anew = button('plain', 'The example', () => this.#write(example));
    setText(
      this.#said,
      'Drives as a ghost, on scans of its own and by the same metrics. It has no network and cannot touch the page. Links and files of the run have nothing of it.',
    );
    this.element = html('details', 'parameter-group own-planner', [
      html('summary', '', [html('h3', '', ['Your own planner'])]),
      this.#said,
      this.#fault,
      html('div', 'lab-row', [drives, open, anew, file]),
      this.#code,
    ]);
    this.#fault.hidden = true;
  }

  /** A file that was opened or dropped: its text can then be edited. */
  open(name: string, bytes: Uint8Array<ArrayBuffer>): void {
    this.element.open = true;
    if (bytes.length > MOST_BYTES) this.fault(`${name}: ${bytes.length} bytes: expected at most ${MOST_BYTES}`);
    else if (/\.wasm$/i.test(name)) this.#drive({ name, code: bytes });
    else {
      this.#write(new TextDecoder().decode(bytes));
      this.#drive({ name, code: this.#code.value });
    }
  }

  /** What stands in the field. */
  get written(): OwnPlanner {
    return { name: WRITTEN, code: this.#code.value };
  }

  say(words: string): void {
    setText(this.#said, words);
    this.#fault.hidden = true;
  }

  fault(words: string): void {
    setText(this.#fault, words);
    this.#fault.hidden = false;
  }

  #opened(file: File): void {
    file.arrayBuffer().then(
      (content) => this.open(file.name, new Uint8Array(content)),
      (error: unknown) => this.fault(`${file.name}: ${messageOf(error)}`),
    );
  }

  #write(code: string): void {
    this.#code.value = code;
    keep(code);
  }
}

/** A browser may keep nothing. */
function kept(): string | undefined {
  try {
    return localStorage.getItem(KEPT) ?? undefined;
  } catch {
    return undefined;
  }
}

function keep(code: string): void {
  try {
    localStorage.setItem(KEPT, code);
  } catch {
    // Then it is there until the page is closed.
  }
}
