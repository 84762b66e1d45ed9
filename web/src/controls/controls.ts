/** The page's buttons, choosers and sliders: each calls one action, and shows the state it is told. */

import { byId, html, setText } from '../base/dom.ts';
import { radians, wholeDegrees } from '../base/format.ts';
import { CATALOGUE } from '../experiment/catalogue.ts';
import { LEARNING, MAX_SEED } from '../experiment/experiment.ts';
import type { Setting } from '../experiment/setting.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import { SPEEDS } from '../run/speeds.ts';
import { TOOLS, type Tool } from '../view/groundTools.ts';

const WAYPOINTS_HINT = 'Press the ground for each waypoint before the goal, in order';

export interface Actions {
  togglePlay(): void;
  step(): void;
  restart(): void;
  next(): void;
  setSpeed(speed: number): void;
  load(scenario: string, setting: Setting): void;
  change(part: Setting & { seed: number }): void;
  selectTool(tool: Tool): void;
  terrains(): void;
  share(): void;
  help(): void;
  /** Whether the goal's tool adds waypoints before the goal. */
  addWaypoints(adding: boolean): void;
  clearWaypoints(): void;
  /** The heading to end with at the goal, or any. */
  setGoalHeading(heading_rad: number | undefined): void;
}

export class Controls {
  readonly #setup = byId('setup', HTMLFormElement);
  readonly #scenario = byId('scenario', HTMLSelectElement);
  readonly #preset = byId('preset', HTMLSelectElement);
  readonly #learning = byId('learning', HTMLSelectElement);
  readonly #seed = byId('seed', HTMLInputElement);
  readonly #play = byId('play', HTMLButtonElement);
  readonly #routeTools = byId('route-tools', HTMLElement);
  readonly #routeAdd = byId('route-add', HTMLInputElement);
  readonly #routeClear = byId('route-clear', HTMLButtonElement);
  readonly #goalHeading = byId('goal-heading', HTMLInputElement);
  readonly #lesson = byId('scene-lesson', HTMLElement);
  readonly #hint = byId('tool-hint', HTMLElement);
  readonly #own = html('option');

  constructor(actions: Actions) {
    this.#fillScenarios();
    // Enter in a field changes the field; there is nothing to send.
    this.#setup.addEventListener('submit', (event) => event.preventDefault());
    this.#scenario.addEventListener('change', () => actions.load(this.#scenario.value, this.#setting()));
    for (const field of [this.#preset, this.#learning, this.#seed]) {
      field.addEventListener('change', () => {
        const seed = this.#readSeed();
        if (seed !== undefined) actions.change({ ...this.#setting(), seed });
      });
    }
    this.#onClick('play', () => actions.togglePlay());
    this.#onClick('step', () => actions.step());
    this.#onClick('restart', () => actions.restart());
    this.#onClick('terrains', () => actions.terrains());
    this.#onClick('share', () => actions.share());
    this.#onClick('help', () => actions.help());
    this.#onClick('next', () => actions.next());
    this.#onClick('route-clear', () => actions.clearWaypoints());
    this.#routeAdd.addEventListener('change', () => {
      actions.addWaypoints(this.#routeAdd.checked);
      this.showTool('goal');
    });
    this.#goalHeading.addEventListener('change', () => {
      const { value } = this.#goalHeading;
      if (this.#goalHeading.reportValidity()) actions.setGoalHeading(value ? radians(Number(value)) : undefined);
    });
    for (const input of this.#radios('tool')) {
      input.addEventListener('change', () => actions.selectTool(TOOLS.find((tool) => tool === input.value) ?? 'look'));
    }
    for (const input of this.#radios('speed')) {
      input.addEventListener('change', () => actions.setSpeed(SPEEDS[Number(input.value)] ?? 1));
    }
  }

  showPlaying(playing: boolean): void {
    this.#play.dataset.playing = String(playing);
    const label = playing ? 'Pause' : 'Play';
    this.#play.setAttribute('aria-label', label);
    this.#play.title = `${label} (Space)`;
  }

  showSession({ scenario, preset, learning, seed, waypoints, goal }: SessionInfo): void {
    this.#routeClear.hidden = waypoints.length === 0;
    this.#goalHeading.value = goal.heading_rad === undefined ? '' : String(wholeDegrees(goal.heading_rad));
    // What is not of the catalogue stands first, by its own name.
    const own = !CATALOGUE.some((one) => one.id === scenario);
    if (own) this.#scenario.prepend(this.#own);
    else this.#own.remove();
    this.#own.value = scenario;
    this.#own.textContent = scenario;
    this.#scenario.value = scenario;
    this.#preset.value = preset;
    this.#learning.value = learning;
    this.#seed.value = String(seed);
    this.#seed.setCustomValidity('');
  }

  showTool(tool: Tool): void {
    for (const input of this.#radios('tool')) input.checked = input.value === tool;
    this.showHint(true);
    this.#hint.hidden = tool === 'look';
    this.#lesson.hidden = tool !== 'look';
    this.#routeTools.hidden = tool !== 'goal';
  }

  /** What to do with the tool in hand, or that somebody pressed where no ground is. */
  showHint(onGround: boolean): void {
    // A finger cannot hover: the tool's title is said in the view, too, without its key.
    const tool = this.#radios('tool').find(({ checked }) => checked);
    const adds = tool?.value === 'goal' && this.#routeAdd.checked;
    const hint = adds ? WAYPOINTS_HINT : (tool?.labels?.[0]?.title ?? '').replace(/ \(.\)$/, '');
    setText(this.#hint, onGround ? hint : 'There is no ground: press the terrain');
    this.#hint.classList.toggle('is-missed', !onGround);
  }

  showSpeed(speed: number): void {
    for (const input of this.#radios('speed')) input.checked = SPEEDS[Number(input.value)] === speed;
  }

  #setting(): Setting {
    const preset = this.#preset.value === 'paper' ? 'paper' : 'default';
    return { preset, learning: LEARNING.find((mode) => mode === this.#learning.value) ?? 'fixed' };
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
