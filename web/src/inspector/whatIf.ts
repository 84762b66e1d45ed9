/** Says that what is shown was decided again where the robot stands, and asks how to go on. */

import { byId, setText } from '../base/dom.ts';
import type { Frame, Thought } from '../protocol/simulationProtocol.ts';

const WORDS: Record<Thought, string> = {
  run: '',
  again: 'Thought again here: scan and decision again at this pose after the change. Dashed: the skyline before.',
  what_if:
    'What if: scan and decision again at this pose, with your settings instead of the run’s. Dashed: the skyline with the run’s.',
};
const ASKED = 'Go on from here with these settings, or from the start?';

export interface WhatIfActions {
  goOn(): void;
  fromStart(): void;
  forget(): void;
}

export class WhatIf {
  readonly #box = byId('what-if', HTMLElement);
  readonly #words = byId('what-if-words', HTMLElement);
  readonly #buttons = byId('what-if-buttons', HTMLElement);
  readonly #goOn = byId('what-if-go-on', HTMLButtonElement);
  readonly #key = byId('key-former', HTMLElement);

  constructor(actions: WhatIfActions) {
    this.#goOn.addEventListener('click', () => actions.goOn());
    byId('what-if-from-start', HTMLButtonElement).addEventListener('click', () => actions.fromStart());
    byId('what-if-forget', HTMLButtonElement).addEventListener('click', () => actions.forget());
  }

  show({ thought }: Frame): void {
    this.#box.hidden = thought === 'run';
    this.#key.hidden = thought === 'run';
    this.#buttons.hidden = thought !== 'what_if';
    if (this.#box.dataset.thought === thought) return;
    this.#box.dataset.thought = thought;
    setText(this.#words, WORDS[thought]);
  }

  /** Somebody wants to go on: how, they say. */
  ask(): void {
    setText(this.#words, ASKED);
    this.#box.dataset.thought = 'asked';
    this.#goOn.focus();
  }
}
