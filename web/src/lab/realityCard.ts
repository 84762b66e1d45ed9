/** The card of reality: presets, the ghost of an ideal world, and each effect by itself, grouped. */

import { button, html, setText } from '../base/dom.ts';
import type { ParameterGroup } from '../experiment/parameters.ts';
import { realityPresets } from '../experiment/reality.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import { IDEAL_RIVAL } from './planners.ts';

/** Of what people call each group, after its table. */
const NAMES: Readonly<Record<string, string>> = {
  'reality.sensing': 'Sensing',
  'reality.pose': 'Pose',
  'reality.motion': 'Motion',
};

export interface RealityActions {
  preset(name: string): void;
  ghost(wanted: boolean): void;
}

/** Whether the ghost of an ideal world is there, and whether there is room for it. */
export interface GhostState {
  readonly chosen: boolean;
  readonly room: boolean;
}

export class RealityCard {
  static readonly title = 'Reality';
  readonly element: HTMLDetailsElement;
  readonly #said = html('span', 'parameter-count');
  readonly #buttons: ReadonlyMap<string, HTMLButtonElement>;
  readonly #ghost = html('input');
  readonly #full = html('p', 'parameter-text');

  /** `parts` are the groups of effects, each a section of its own. */
  constructor(groups: readonly ParameterGroup[], parts: readonly HTMLElement[], actions: RealityActions) {
    this.#buttons = new Map(
      realityPresets(groups).map((name) => {
        const preset = button('plain', name, () => actions.preset(name));
        // By which it has the focus again when the table is made anew.
        preset.id = `reality-${name}`;
        return [name, preset];
      }),
    );
    const presets = html('div', 'lab-row presets', [...this.#buttons.values()]);
    presets.setAttribute('role', 'group');
    presets.setAttribute('aria-label', 'How hard the world is');
    this.#ghost.type = 'checkbox';
    this.#ghost.id = 'reality-ghost';
    this.#ghost.addEventListener('change', () => actions.ghost(this.#ghost.checked));
    const swatch = html('i', 'swatch');
    swatch.style.setProperty('--swatch', IDEAL_RIVAL.colour);
    const ghost = html('label', 'reality-ghost', [this.#ghost, swatch, 'Ghost of an ideal world beside it']);
    setText(this.#full, 'Three ghosts are driving: take one away under Compare first.');
    this.element = html('details', 'parameter-group', [
      html('summary', '', [html('h3', '', [RealityCard.title]), this.#said]),
      presets,
      ghost,
      this.#full,
      html('div', 'reality-effects', parts),
    ]);
    this.ghost({ chosen: false, room: true });
  }

  /** What a group of effects is called, with what it does. */
  static heading({ table, title }: ParameterGroup): HTMLElement[] {
    return [html('h4', '', [NAMES[table] ?? table]), html('span', 'reality-about', [title])];
  }

  show({ reality }: SessionInfo): void {
    setText(this.#said, reality);
    for (const [name, button] of this.#buttons) button.setAttribute('aria-pressed', String(name === reality));
  }

  ghost({ chosen, room }: GhostState): void {
    this.#ghost.checked = chosen;
    this.#ghost.disabled = !chosen && !room;
    this.#full.hidden = chosen || room;
  }
}
