/** The sheet of terrains: those of the scenarios, generated ones, and files of one's own. */

import { button, byId, html, setText } from '../base/dom.ts';
import { messageOf } from '../base/messageOf.ts';
import { readTheme } from '../colours/theme.ts';
import { kept, works } from '../experiment/autosave.ts';
import { CATALOGUE, entry, isKnown } from '../experiment/catalogue.ts';
import { type Experiment, FAMILIES, HOLES, type Holes, MAX_SEED, type Terrain } from '../experiment/experiment.ts';
import type { Setup } from '../experiment/setting.ts';
import { pngHead } from '../files/pngHead.ts';
import type { Ground, NamedFile, SessionInfo, TerrainPreview } from '../protocol/simulationProtocol.ts';
import type { Replay } from '../trials/campaignRows.ts';
import { courseOf } from '../trials/course.ts';
import { drawRelief } from './reliefPicture.ts';

/** Generated terrains shown at once. */
const GENERATED = 4;

export interface TerrainActions {
  /** A terrain, coarsely, for a picture. */
  preview(terrain: Terrain): Promise<TerrainPreview>;
  runScenario(scenario: string, setup?: Partial<Setup>, seed?: number): Promise<void>;
  /** Loads a scenario, which then stands at its start. */
  load(scenario: string): Promise<void>;
  pause(): Promise<void>;
  /** What is loaded. */
  readonly info: SessionInfo | undefined;
  readonly field: Ground | undefined;
  runTerrain(terrain: Terrain, name: string): Promise<void>;
  run(source: { readonly experiment: Experiment }): Promise<void>;
  /** `holes`: what becomes of samples without a height. */
  runFiles(files: readonly NamedFile[], holes: Holes): Promise<void>;
  /** Says what goes wrong. */
  attempt(action: Promise<void>): void;
}

export class TerrainsSheet {
  readonly #actions: TerrainActions;
  readonly #planner: (file: NamedFile) => Promise<void>;
  readonly #recording: (file: File) => Promise<void>;
  readonly #savedRun: (file: File) => Promise<boolean>;
  readonly #sheet = byId('terrains-sheet', HTMLDialogElement);
  readonly #cards = byId('terrain-cards', HTMLElement);
  readonly #generated = byId('generated-cards', HTMLElement);
  readonly #family = byId('family', HTMLSelectElement);
  readonly #seed = byId('terrain-seed', HTMLInputElement);
  readonly #files = byId('files', HTMLInputElement);
  readonly #address = byId('address', HTMLInputElement);
  readonly #addressSaid = byId('address-said', HTMLElement);
  #fetching: AbortController | undefined;
  readonly #works = byId('earlier-work', HTMLElement);
  readonly #holes = byId('holes', HTMLSelectElement);

  /** `planner` has somebody's own planner drive, `recording` opens a robot's recording, `savedRun` a run if the page saved it. */
  constructor(
    actions: TerrainActions,
    planner: (file: NamedFile) => Promise<void>,
    recording: (file: File) => Promise<void>,
    savedRun: (file: File) => Promise<boolean>,
  ) {
    [this.#actions, this.#planner, this.#recording, this.#savedRun] = [actions, planner, recording, savedRun];
    byId('generate', HTMLFormElement).addEventListener('submit', (event) => event.preventDefault());
    for (const input of [this.#family, this.#seed]) input.addEventListener('change', () => this.#generate());
    byId('more-terrains', HTMLButtonElement).addEventListener('click', () => {
      const next = this.#seed.valueAsNumber + GENERATED;
      this.#seed.valueAsNumber = next <= MAX_SEED - GENERATED ? next : 0;
      this.#generate();
    });
    byId('open-files', HTMLButtonElement).addEventListener('click', () => this.#files.click());
    this.#files.addEventListener('change', () => {
      actions.attempt(this.#open(this.#files.files ?? []));
      this.#files.value = '';
    });
    byId('from-address', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      actions.attempt(this.#openAddress(this.#address.value.trim()));
    });
    this.#sheet.addEventListener('close', () => {
      this.#fetching?.abort();
      this.#say('');
    });
    document.addEventListener('dragover', (event) => {
      if (event.dataTransfer?.types.includes('Files')) event.preventDefault();
    });
    document.addEventListener('drop', (event) => {
      if (!event.dataTransfer?.files.length) return;
      event.preventDefault();
      actions.attempt(this.#open(event.dataTransfer.files));
    });
  }

  open(): void {
    // Pictures follow light and dark, so they are drawn for each visit.
    this.#cards.replaceChildren(...TERRAINS.map(([name, title, scenario]) => this.#catalogued(name, title, scenario)));
    this.#generate();
    this.#listWork().catch(() => this.#showWork([]));
    if (!this.#sheet.open) this.#sheet.showModal();
  }

  #catalogued(name: string, title: string, scenario: string): HTMLElement {
    return this.#card({ catalogue: name }, title, () => this.#actions.runScenario(scenario));
  }

  async #listWork(): Promise<void> {
    this.#showWork(
      (await works()).map(({ id, name, saved }) => {
        const work = button('plain', `${entry(name).title}, ${saved.toLocaleString()}`, () => {
          this.#sheet.close();
          this.#actions.attempt(this.#reopen(id));
        });
        return html('li', '', [work]);
      }),
    );
  }

  #showWork(items: readonly HTMLElement[]): void {
    this.#works.replaceChildren(...items);
    byId('earlier', HTMLElement).hidden = items.length === 0;
  }

  async #reopen(id: string): Promise<void> {
    const work = await kept(id);
    if (work) await this.#actions.run({ experiment: work.experiment });
  }

  #generate(): void {
    const first = this.#seed.valueAsNumber;
    if (!this.#seed.reportValidity() || !Number.isInteger(first)) return;
    const family = FAMILIES.find((one) => one === this.#family.value) ?? 'moderate';
    const cards = Array.from({ length: GENERATED }, (_, step) => {
      const seed = first + step;
      const terrain = { generated: { difficulty: family, seed } };
      const name = `${family} ${seed}`;
      return this.#card(terrain, `Seed ${seed}`, () => this.#actions.runTerrain(terrain, name));
    });
    this.#generated.replaceChildren(...cards);
  }

  #card(terrain: Terrain, title: string, choose: () => Promise<void>): HTMLElement {
    const picture = html('canvas', 'card-picture');
    const words = html('span', 'card-title', [title]);
    const button = html('button', 'card', [picture, words]);
    button.type = 'button';
    button.addEventListener('click', () => {
      this.#sheet.close();
      this.#actions.attempt(choose());
    });
    this.#actions.preview(terrain).then(
      (terrain) => drawRelief(picture, terrain, readTheme()),
      (error: unknown) => setText(words, `${title}: ${messageOf(error)}`),
    );
    return html('li', '', [button]);
  }

  /** The table of a campaign. */
  async #openTable({ name, bytes }: NamedFile): Promise<void> {
    const [{ LeaderboardSheet }, { openCampaign }] = await Promise.all([
      import('./leaderboardSheet.ts'),
      import('../trials/campaignFile.ts'),
    ]);
    const rows = await openCampaign(name, bytes, isKnown);
    const drive = ({ scenario, seed, preset, overrides }: Replay) =>
      this.#actions.attempt(this.#actions.runScenario(scenario, { preset, overrides, learning: 'fixed' }, seed));
    const scene = async (route: string) => {
      await this.#actions.load(route);
      await this.#actions.pause();
      const { info, field } = this.#actions;
      if (!info || !field) throw new Error(`${route} could not be opened.`);
      return { course: courseOf(info, field), solids: info.solids };
    };
    await new LeaderboardSheet(name, rows, drive, scene).show();
  }

  /** What is fetched goes the way of files that are chosen. */
  async #openAddress(address: string): Promise<void> {
    this.#fetching?.abort();
    const fetching = new AbortController();
    this.#fetching = fetching;
    this.#say('Fetching…');
    let files: File[];
    try {
      const { filesAt } = await import('../files/addressFiles.ts');
      files = await filesAt(address, this.#files.accept.split(','), fetching.signal);
    } catch (cause) {
      // Whoever closed the sheet or gave another address knows.
      if (!fetching.signal.aborted) this.#say(messageOf(cause), true);
      return;
    }
    if (fetching.signal.aborted) return;
    try {
      await this.#open(files);
    } catch (cause) {
      throw new Error(`From ${address}: ${messageOf(cause)}`, { cause });
    }
  }

  #say(words: string, isFault = false): void {
    setText(this.#addressSaid, words);
    this.#addressSaid.toggleAttribute('data-fault', isFault);
  }

  async #open(list: ArrayLike<File>): Promise<void> {
    this.#sheet.close();
    // The browser empties the list as soon as the input is.
    const given = Array.from(list);
    const [only] = given.length === 1 ? given : [];
    if (only && /\.(mcap|json)$/i.test(only.name) && (await this.#savedRun(only))) return;
    // It may be larger than all memory: it is read as it is shown.
    if (only && /\.mcap$/i.test(only.name)) {
      await this.#recording(only);
      return;
    }
    let files: NamedFile[] = [];
    for (const file of given) {
      files.push({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
    }
    const holes = HOLES.find((one) => one === this.#holes.value) ?? 'refuse';
    const [first] = files;
    if (files.length === 1 && first && /\.(csv|parquet)$/i.test(first.name)) {
      await this.#openTable(first);
      return;
    }
    if (files.length === 1 && first && /\.(m?js|wasm)$/i.test(first.name)) {
      await this.#planner(first);
      return;
    }
    if (files.some(({ name }) => /\.(ya?ml|bmp)$/i.test(name))) {
      const { taskOf } = await import('./vertiBenchSheet.ts');
      files = (await taskOf(files)) ?? [];
    }
    const head = files.length === 1 && first && pngHead(first.bytes);
    if (head) {
      const { HeightsSheet } = await import('./heightsSheet.ts');
      const recipe = await new HeightsSheet(first, head, holes, (terrain) => this.#actions.preview(terrain)).ask();
      if (!recipe) return;
      files.push(recipe);
    }
    if (files.length > 0) await this.#actions.runFiles(files, holes);
  }
}

/** Each terrain once, with the first scenario on it. */
const TERRAINS = [
  ['cht', 'Challenging hilly terrain'],
  ['ml', 'Martian landscape'],
  ['vta', 'Valley trail ascent'],
  ['gsb', 'Gentle slope bypass'],
  ['ht', 'Hilly terrain'],
].map(([name = '', title = '']) => {
  const scenario = CATALOGUE.find(({ id }) => id === name || id.startsWith(`${name}-`));
  return [name, title, scenario?.id ?? name] as const;
});
