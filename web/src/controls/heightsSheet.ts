/** The sheet that asks how an image is to be read as heights, which it does not say itself. Loaded when such a file is opened. */

import { messageOf } from '../base/messageOf.ts';
import { Newest } from '../base/newest.ts';
import '../style/heights.css';
import { base64 } from '../base/base64.ts';
import { button, html, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import { readTheme } from '../colours/theme.ts';
import { HOLES, type Holes, type Terrain } from '../experiment/experiment.ts';
import type { PngHead } from '../files/pngHead.ts';
import type { NamedFile, TerrainPreview } from '../protocol/simulationProtocol.ts';
import { drawRelief } from './reliefPicture.ts';

/** Where the file says nothing: the spacing that a recipe without one means. */
const CELL_M = 0.25;
/** White, where black is 0: a millimetre a level of 16 bits, as this page saves heights. */
const WHITE_M = { 16: 65.535, 8: 10 };
const HOLE_WORDS: Record<Holes, string> = { refuse: 'refused', fill: 'filled from around', crop: 'cut off' };
/** Typing comes in a row. */
const DELAY_MS = 250;

/** What a recipe says of how its file is read. */
interface Reading {
  readonly cell_m: number;
  readonly low_m: number;
  readonly high_m: number;
  readonly holes: Holes;
}

export class HeightsSheet {
  readonly #file: NamedFile;
  readonly #head: PngHead;
  readonly #encoded: string;
  readonly #preview: (terrain: Terrain) => Promise<TerrainPreview>;
  readonly #sheet = html('dialog', 'sheet heights-sheet');
  readonly #form = html('form', 'heights-form');
  readonly #cell = numberInput('0.01', '1000', '0.01');
  readonly #low = numberInput('-12000', '100000', 'any');
  readonly #high = numberInput('-12000', '100000', 'any');
  readonly #holes = html('select');
  readonly #picture = html('canvas', 'card-picture');
  readonly #note = html('p', 'sheet-note');
  readonly #warning = html('p', 'heights-warning');
  readonly #open = html('button', 'filled', ['Open']);
  #timer: ReturnType<typeof setTimeout> | undefined;
  readonly #newest = new Newest();

  constructor(file: NamedFile, head: PngHead, holes: Holes, preview: (terrain: Terrain) => Promise<TerrainPreview>) {
    [this.#file, this.#head, this.#preview] = [file, head, preview];
    this.#encoded = base64(file.bytes);
    this.#cell.valueAsNumber = head.cell_m ?? CELL_M;
    this.#low.valueAsNumber = 0;
    this.#high.valueAsNumber = head.bits === 16 ? WHITE_M[16] : WHITE_M[8];
    this.#holes.append(...HOLES.map((one) => new Option(HOLE_WORDS[one], one, one === holes, one === holes)));
    const title = html('h2', '', [`How high is ${file.name}?`]);
    title.id = 'heights-title';
    this.#sheet.setAttribute('aria-labelledby', title.id);
    this.#picture.setAttribute('role', 'img');
    this.#note.setAttribute('role', 'status');
    this.#warning.setAttribute('role', 'alert');
    const cancel = button('plain', 'Cancel', () => this.#sheet.close());
    this.#form.method = 'dialog';
    this.#form.append(
      field('Cell size', this.#cell, 'm'),
      field('Black is', this.#low, 'm'),
      field('White is', this.#high, 'm'),
      field('Holes', this.#holes, ''),
      html('div', 'heights-actions', [cancel, this.#open]),
    );
    const seen = html('div', 'heights-seen', [this.#picture, this.#note]);
    const levels = `An image holds levels, no metres: ${head.columns} × ${head.rows} pixels of ${head.bits} bits.`;
    const introduction = html('p', 'sheet-note', [levels]);
    this.#sheet.append(title, introduction, html('div', 'heights-body', [this.#form, seen]), this.#warning);
    this.#form.addEventListener('input', () => this.#changed());
  }

  /** The recipe that reads the file as somebody wants it; nothing where that is called off. */
  ask(): Promise<NamedFile | undefined> {
    document.body.append(this.#sheet);
    return new Promise((resolve) => {
      this.#form.addEventListener('submit', () => this.#sheet.close('open'));
      this.#sheet.addEventListener('close', () => {
        clearTimeout(this.#timer);
        this.#sheet.remove();
        resolve(this.#sheet.returnValue === 'open' ? this.#recipeFile() : undefined);
      });
      this.#sheet.showModal();
      this.#newest.do(() => this.#show());
    });
  }

  get #reading(): Reading {
    const holes = HOLES.find((one) => one === this.#holes.value) ?? 'refuse';
    const [cell_m, low_m, high_m] = [this.#cell, this.#low, this.#high].map((input) => input.valueAsNumber) as [
      number,
      number,
      number,
    ];
    return { cell_m, low_m, high_m, holes };
  }

  #changed(): void {
    const { low_m, high_m } = this.#reading;
    this.#high.setCustomValidity(high_m > low_m ? '' : `White must be higher than black, which is ${low_m} m.`);
    clearTimeout(this.#timer);
    if (this.#form.checkValidity()) this.#timer = setTimeout(() => this.#newest.do(() => this.#show()), DELAY_MS);
  }

  async #show(): Promise<void> {
    try {
      const preview = await this.#preview({ recipe: this.#recipe(), imported: this.#imported() });
      drawRelief(this.#picture, preview, readTheme());
      this.#say(preview);
      setText(this.#warning, this.#warn());
      this.#open.disabled = false;
    } catch (error) {
      setText(this.#note, '');
      setText(this.#warning, messageOf(error));
      this.#open.disabled = true;
    }
  }

  #say({ ground: { heights_m } }: TerrainPreview): void {
    const { cell_m } = this.#reading;
    const [low, high] = heights_m.reduce(
      ([least, most], height) => [Math.min(least, height), Math.max(most, height)],
      [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY],
    );
    const [east_m, north_m] = [this.#head.columns, this.#head.rows].map((count) => fixed((count - 1) * cell_m, 1));
    const words = `${east_m} × ${north_m} m, from ${fixed(low, 2)} m to ${fixed(high, 2)} m: ${fixed(high - low, 1)} m of relief.`;
    setText(this.#note, words);
    this.#picture.setAttribute('aria-label', `Preview: ${words}`);
  }

  /** What is lost for want of bits. */
  #warn(): string {
    if (this.#head.bits >= 16) return '';
    const { low_m, high_m } = this.#reading;
    const step_cm = (100 * (high_m - low_m)) / 255;
    return `Only 256 heights fit into 8 bits: the ground will have steps of ${fixed(step_cm, 1)} cm.`;
  }

  #imported() {
    return { name: 'heights.png', base64: this.#encoded };
  }

  #recipe(): string {
    const { cell_m, low_m, high_m, holes } = this.#reading;
    const stem = this.#file.name.replace(/\.[^.]*$/, '').slice(0, 80);
    const lines = ['file = "heights.png"', `cell_m = ${cell_m}`, `height_min_m = ${low_m}`, `height_max_m = ${high_m}`];
    if (holes !== 'refuse') lines.push(`holes = "${holes}"`);
    return [`name = ${JSON.stringify(stem)}`, '', '[import]', ...lines, ''].join('\n');
  }

  #recipeFile(): NamedFile {
    const name = this.#file.name.replace(/\.[^.]*$/, '.toml');
    return { name, bytes: new TextEncoder().encode(this.#recipe()) };
  }
}

function numberInput(min: string, max: string, step: string): HTMLInputElement {
  const input = html('input');
  [input.type, input.inputMode, input.required] = ['number', 'decimal', true];
  [input.min, input.max, input.step] = [min, max, step];
  return input;
}

function field(name: string, control: HTMLElement, unit: string): HTMLElement {
  return html('label', 'field', [html('span', '', [name]), control, html('span', '', [unit])]);
}
