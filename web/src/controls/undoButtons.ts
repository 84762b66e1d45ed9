/** Undo and redo: buttons, and the keys that everybody knows. */

import { byId } from '../base/dom.ts';

export interface Undoing {
  undo(): Promise<void>;
  redo(): Promise<void>;
  /** Says what goes wrong. */
  attempt(action: Promise<void>): void;
}

export class UndoButtons {
  readonly #undo = byId('undo', HTMLButtonElement);
  readonly #redo = byId('redo', HTMLButtonElement);

  constructor(actions: Undoing) {
    const [undo, redo] = [() => actions.attempt(actions.undo()), () => actions.attempt(actions.redo())];
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

  show({ canUndo, canRedo }: { readonly canUndo: boolean; readonly canRedo: boolean }): void {
    this.#undo.disabled = !canUndo;
    this.#redo.disabled = !canRedo;
  }
}

/** Fields have an undo of their own. */
function typing(target: EventTarget | null): boolean {
  return target instanceof HTMLInputElement && (target.type === 'number' || target.type === 'text');
}
