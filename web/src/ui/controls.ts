/** The page's buttons, choosers and sliders: each calls one action, and shows the state it is told. */

import { CATALOGUE } from '../core/catalogue.ts';
import type { Learning, SessionInfo, Setting } from '../core/protocol.ts';
import { TOOLS, type Tool } from '../scene/tools.ts';
import { byId, html } from './dom.ts';

export const SPEEDS: readonly number[] = [0.5, 1, 2, 4, Number.POSITIVE_INFINITY];

export interface Actions {
  togglePlay(): void;
  step(): void;
  restart(): void;
  next(): void;
  setSpeed(speed: number): void;
  load(scenario: string, setting: Setting, seed: number | undefined): void;
  selectTool(tool: Tool): void;
  setBrushRadius(radius_m: number): void;
  help(): void;
  /** Whether further goals are added to the route. */
  addStops(adding: boolean): void;
  clearStops(): void;
}

const LEARNING: readonly Learning[] = ['fixed', 'once', 'every_scan'];
const MAX_SEED = 0xffff_ffff;

export class Controls {
  readonly #setup = byId('setup', HTMLFormElement);
  readonly #scenario = byId('scenario', HTMLSelectElement);
  readonly #preset = byId('preset', HTMLSelectElement);
  readonly #learning = byId('learning', HTMLSelectElement);
  readonly #seed = byId('seed', HTMLInputElement);
  readonly #play = byId('play', HTMLButtonElement);
  readonly #brush = byId('brush', HTMLElement);
  readonly #routeTools = byId('route-tools', HTMLElement);
  readonly #routeClear = byId('route-clear', HTMLButtonElement);
  readonly #brushSize = byId('brush-size', HTMLInputElement);
  readonly #brushValue = byId('brush-value', HTMLOutputElement);
  readonly #actions: Actions;

  constructor(actions: Actions) {
    this.#actions = actions;
    this.#fillScenarios();
    // Enter in a field changes the field; there is nothing to send.
    this.#setup.addEventListener('submit', (event) => event.preventDefault());
    this.#scenario.addEventListener('change', () => this.#load(undefined));
    for (const select of [this.#preset, this.#learning]) {
      select.addEventListener('change', () => this.#load(this.#readSeed()));
    }
    this.#seed.addEventListener('change', () => {
      const seed = this.#readSeed();
      if (seed !== undefined) this.#load(seed);
    });
    this.#onClick('play', () => actions.togglePlay());
    this.#onClick('step', () => actions.step());
    this.#onClick('restart', () => actions.restart());
    this.#onClick('help', () => actions.help());
    this.#onClick('next', () => actions.next());
    this.#onClick('route-clear', () => actions.clearStops());
    const add = byId('route-add', HTMLInputElement);
    add.addEventListener('change', () => actions.addStops(add.checked));
    for (const input of this.#radios('tool')) {
      input.addEventListener('change', () => actions.selectTool(TOOLS.find((tool) => tool === input.value) ?? 'look'));
    }
    for (const input of this.#radios('speed')) {
      input.addEventListener('change', () => actions.setSpeed(SPEEDS[Number(input.value)] ?? 1));
    }
    this.#brushSize.addEventListener('input', () => this.#readBrush());
    this.#readBrush();
  }

  showPlaying(playing: boolean): void {
    this.#play.dataset.playing = String(playing);
    const label = playing ? 'Pause' : 'Play';
    this.#play.setAttribute('aria-label', label);
    this.#play.title = `${label} (Space)`;
  }

  showSession({ scenario, preset, learning, seed, waypoints }: SessionInfo): void {
    this.#routeClear.hidden = waypoints.length === 0;
    this.#scenario.value = scenario;
    this.#preset.value = preset;
    this.#learning.value = learning;
    this.#seed.value = String(seed);
    this.#seed.setCustomValidity('');
  }

  showTool(tool: Tool): void {
    for (const input of this.#radios('tool')) input.checked = input.value === tool;
    this.#routeTools.hidden = tool !== 'goal';
    this.#brush.hidden = tool !== 'raise' && tool !== 'lower' && tool !== 'smooth';
  }

  showSpeed(speed: number): void {
    for (const input of this.#radios('speed')) input.checked = SPEEDS[Number(input.value)] === speed;
  }

  /** Moves the brush's slider by whole steps. */
  growBrush(steps: number): void {
    if (steps > 0) this.#brushSize.stepUp(steps);
    else this.#brushSize.stepDown(-steps);
    this.#readBrush();
  }

  #readBrush(): void {
    const radius_m = this.#brushSize.valueAsNumber;
    this.#brushValue.value = `${radius_m.toFixed(1)} m`;
    this.#actions.setBrushRadius(radius_m);
  }

  #load(seed: number | undefined): void {
    const preset = this.#preset.value === 'paper' ? 'paper' : 'default';
    const learning = LEARNING.find((mode) => mode === this.#learning.value) ?? 'fixed';
    this.#actions.load(this.#scenario.value, { preset, learning }, seed);
  }

  /** The seed, or nothing and a complaint at the field. */
  #readSeed(): number | undefined {
    const seed = Number(this.#seed.value);
    const good = this.#seed.value.trim() !== '' && Number.isInteger(seed) && seed >= 0 && seed <= MAX_SEED;
    this.#seed.setCustomValidity(good ? '' : `A seed is a whole number from 0 to ${MAX_SEED}.`);
    if (!good) this.#seed.reportValidity();
    return good ? seed : undefined;
  }

  #fillScenarios(): void {
    const groups = new Map<string, HTMLOptGroupElement>();
    for (const entry of CATALOGUE) {
      const group = groups.get(entry.group) ?? html('optgroup');
      group.label = entry.group;
      groups.set(entry.group, group);
      const option = html('option', '', [entry.title]);
      option.value = entry.id;
      group.append(option);
    }
    this.#scenario.append(...groups.values());
  }

  #onClick(id: string, act: () => void): void {
    byId(id, HTMLButtonElement).addEventListener('click', act);
  }

  #radios(name: string): HTMLInputElement[] {
    return [...document.querySelectorAll<HTMLInputElement>(`input[name="${name}"]`)];
  }
}
