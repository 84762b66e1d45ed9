/** What to place, which object is in hand, and what to do with it. */

import { byId, html, setText } from '../base/dom.ts';
import { objectName, PALETTE, type PaletteKind, sizeWords, turns, type WorldObject } from '../experiment/objects.ts';
import type { Tool } from '../view/groundTools.ts';

export interface ObjectPanelActions {
  kind(kind: PaletteKind): void;
  hold(object: number | undefined): void;
  turn(times: number): void;
  grow(times: number): void;
  remove(): void;
}

export class ObjectPanel {
  readonly #panel = byId('object-tools', HTMLElement);
  readonly #list = byId('object-list', HTMLSelectElement);
  readonly #turn = byId('object-turn', HTMLButtonElement);
  readonly #buttons = [
    this.#turn,
    ...['smaller', 'larger', 'delete'].map((id) => byId(`object-${id}`, HTMLButtonElement)),
  ];
  readonly #said = byId('object-said', HTMLElement);

  constructor(actions: ObjectPanelActions) {
    for (const input of document.querySelectorAll<HTMLInputElement>('input[name="object-kind"]')) {
      input.addEventListener('change', () => actions.kind(PALETTE.find((kind) => kind === input.value) ?? 'post'));
    }
    this.#list.addEventListener('change', () => {
      actions.hold(this.#list.value === '' ? undefined : Number(this.#list.value));
    });
    const acts = [() => actions.turn(1), () => actions.grow(-1), () => actions.grow(1), () => actions.remove()];
    for (const [index, button] of this.#buttons.entries()) button.addEventListener('click', () => acts[index]?.());
  }

  tool(tool: Tool): void {
    this.#panel.hidden = tool !== 'objects';
  }

  show(objects: readonly WorldObject[], held: number | undefined): void {
    const none = html('option', '', [objects.length === 0 ? 'No object yet' : 'None']);
    none.value = '';
    const options = objects.map((object, index) => {
      const option = html('option', '', [`${objectName(object, index)}, ${sizeWords(object)}`]);
      option.value = String(index);
      return option;
    });
    this.#list.replaceChildren(none, ...options);
    this.#list.value = held === undefined ? '' : String(held);
    this.#list.disabled = objects.length === 0;
    const object = held === undefined ? undefined : objects[held];
    for (const button of this.#buttons) button.disabled = object === undefined;
    if (object) this.#turn.disabled = !turns(object);
  }

  say(words: string): void {
    setText(this.#said, words);
  }
}
