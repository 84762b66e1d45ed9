/** Undo and redo: buttons, and the keys that everybody knows. */

import type { App } from '../app/app.ts';
import { byId } from '../base/dom.ts';
import type { Workbench } from '../editor/editor.ts';

export class UndoButtons {
  readonly #undo = byId('undo', HTMLButtonElement);
  readonly #redo = byId('redo', HTMLButtonElement);

  constructor(app: App) {
    const [undo, redo] = [() => app.attempt(app.undo()), () => app.attempt(app.redo())];
    this.#undo.addEventListener('click', undo);
    this.#redo.addEventListener('click', redo);
    document.addEventListener('keydown', (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || document.querySelector('dialog[open]')) return;
      const key = event.key.toLowerCase();
      const act = key === 'z' ? (event.shiftKey ? redo : undo) : key === 'y' ? redo : undefined;
      if (!act || typing(event.target)) return;
      event.preventDefault();
      act();
    });
  }

  show(bench: Workbench): void {
    this.#undo.disabled = !bench.canUndo;
    this.#redo.disabled = !bench.canRedo;
  }
}

/** Fields have an undo of their own. */
function typing(target: EventTarget | null): boolean {
  return target instanceof HTMLInputElement && (target.type === 'number' || target.type === 'text');
}
