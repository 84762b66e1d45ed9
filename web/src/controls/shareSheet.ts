/** The sheet for links and files. */

import { byId, setText } from '../base/dom.ts';
import { clock } from '../base/format.ts';
import { messageOf } from '../base/messageOf.ts';
import type { Experiment } from '../experiment/experiment.ts';
import { linkTo, MAX_LINK_CHARACTERS } from '../experiment/link.ts';
import { zip } from '../files/archive.ts';
import { download, plainName } from '../files/download.ts';
import { heightsAscii, heightsPng } from '../files/heights.ts';
import type { HeightField } from '../ground/heightField.ts';
import type { NamedFile } from '../protocol/simulationProtocol.ts';

/** What there is to share: the page's experiment, and its ground as it is now. */
export interface Shared {
  readonly editor: { readonly experiment: Experiment | undefined };
  readonly field: HeightField | undefined;
  /** When the run stands, and whether ground, route or planner changed during it. */
  state(): { readonly disturbed: boolean; readonly time_s: number } | undefined;
  /** What the run drives with, where other settings are tried. */
  readonly info: { readonly runsWith: unknown } | undefined;
  /** The files with which `mapless run` drives the same run. */
  files(): Promise<NamedFile[]>;
}

export class ShareSheet {
  readonly #shared: Shared;
  readonly #sheet = byId('share-sheet', HTMLDialogElement);
  readonly #note = byId('share-note', HTMLElement);
  readonly #state = byId('share-state', HTMLElement);
  readonly #link = byId('link', HTMLInputElement);
  readonly #copy = byId('copy-link', HTMLButtonElement);
  readonly #moment = byId('link-moment', HTMLInputElement);
  readonly #momentSaid = byId('link-moment-said', HTMLElement);

  constructor(shared: Shared) {
    this.#shared = shared;
    this.#copy.addEventListener('click', () => this.#copyLink());
    this.#moment.addEventListener('change', () => this.#show());
    this.#saves('save-experiment', async (name) => {
      const json = `${JSON.stringify(shared.editor.experiment, undefined, 1)}\n`;
      download(`${name}.json`, new Blob([json], { type: 'application/json' }));
    });
    this.#saves('save-scenario', async (name) => download(`${name}.zip`, zip(await shared.files())));
    this.#saves('save-png', async (name) => download(`${name}.png`, await heightsPng(ground(shared))));
    this.#saves('save-asc', async (name) => download(`${name}.asc`, heightsAscii(ground(shared))));
  }

  async open(): Promise<void> {
    this.#moment.checked = false;
    await this.#show();
    if (!this.#sheet.open) this.#sheet.showModal();
    if (!this.#copy.disabled) this.#copy.focus();
  }

  async #show(): Promise<void> {
    const { editor, info } = this.#shared;
    const { experiment } = editor;
    const { disturbed = false, time_s = 0 } = this.#shared.state() ?? {};
    if (!experiment) return;
    setText(this.#state, '');
    const obstacle = disturbed
      ? 'ground, route or planner changed during this run, and a link drives from the start'
      : info?.runsWith && 'other settings are only tried here';
    this.#moment.disabled = Boolean(obstacle);
    setText(
      this.#momentSaid,
      obstacle ? `Not from this moment: ${obstacle}.` : `From this moment (${clock(time_s)}), paused`,
    );
    const moment_s = this.#moment.checked && !obstacle ? time_s : undefined;
    const link = await linkTo(location.href.split('?')[0] ?? '', experiment, moment_s);
    const short = link.length <= MAX_LINK_CHARACTERS;
    this.#link.value = short ? link : '';
    this.#copy.disabled = !short;
    this.#link.hidden = !short;
    const changed = disturbed ? ' Ground or route changed during this run: restart it to see that run.' : '';
    setText(
      this.#note,
      short
        ? `The link holds terrain, strokes, start, route and settings (${link.length} characters) and ${moment_s === undefined ? 'drives the same run from its start' : 'opens the same run at this moment, paused'}.${changed}`
        : `This is too much for a link that chats carry (${link.length} characters, ${MAX_LINK_CHARACTERS} at most). Save the experiment as a file and send that.`,
    );
  }

  async #copyLink(): Promise<void> {
    this.#link.select();
    try {
      await navigator.clipboard.writeText(this.#link.value);
      setText(this.#state, 'Copied.');
    } catch {
      setText(this.#state, 'The browser does not let the page copy: the link is selected, copy it from there.');
    }
  }

  #saves(id: string, save: (name: string) => Promise<void>): void {
    byId(id, HTMLButtonElement).addEventListener('click', () => {
      const name = plainName(this.#shared.editor.experiment?.name ?? 'experiment');
      // What goes wrong is said in the sheet, which covers the notice.
      save(name).then(
        () => setText(this.#state, ''),
        (error: unknown) => setText(this.#state, messageOf(error)),
      );
    });
  }
}

function ground({ field }: Shared): HeightField {
  if (!field) throw new Error('There is no ground yet.');
  return field;
}
