/** The guided tour: a card that says what the scene shows, one step after the other. Everything is put back at its end. */

import { button, html, setText } from '../base/dom.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Layers } from '../scene/layers.ts';
import type { Finder } from '../scene/selection.ts';
import type { CameraMode } from '../view/viewpoint.ts';
import { BARE, STEPS } from './steps.ts';

/** What a tour does to the page. */
export interface TourHost {
  readonly layers: Layers;
  readonly camera: CameraMode;
  readonly imageIsLarge: boolean;
  readonly isByHand: boolean;
  readonly playing: boolean;
  /** The newest frame of a running trial, with a decision in it. */
  decided(): Promise<{ frame: Frame; info: SessionInfo }>;
  showLayers(layers: Layers): void;
  view(camera: CameraMode): void;
  enlargeImage(large: boolean): void;
  /** Opens the Gaussian process to be changed by hand, or closes it. */
  byHand(open: boolean): Promise<void>;
  play(playing: boolean): Promise<void>;
  pin(finder: Finder | undefined): void;
}

export class Tour {
  readonly #host: TourHost;
  readonly #before: Pick<TourHost, 'layers' | 'camera' | 'imageIsLarge' | 'isByHand' | 'playing'>;
  readonly #card: HTMLElement;
  readonly #ended: () => void;
  readonly #count = html('p', 'tour-count');
  readonly #title = html('h2', 'tour-title');
  readonly #text = html('p', 'tour-text');
  readonly #back = button('plain', 'Back', () => void this.#go(this.#at - 1));
  readonly #next = button('tour-next', 'Next', () => void this.#go(this.#at + 1));
  #at = -1;

  /** Shows the tour in `card`, which is empty and hidden before and after. */
  constructor(card: HTMLElement, host: TourHost, ended: () => void) {
    this.#card = card;
    this.#host = host;
    this.#ended = ended;
    const { layers, camera, imageIsLarge, isByHand, playing } = host;
    this.#before = { layers, camera, imageIsLarge, isByHand, playing };
    const words = html('div', 'tour-words', [this.#title, this.#text]);
    words.setAttribute('aria-live', 'polite');
    const end = button('plain', 'End the tour', () => this.end());
    card.replaceChildren(words, html('div', 'tour-foot', [this.#count, end, this.#back, this.#next]));
    // What is pressed on the way, such as “Learned…”, has the focus then.
    document.addEventListener('keydown', this.#key, true);
  }

  async begin(): Promise<void> {
    await this.#go(0);
    this.#card.hidden = false;
    this.#next.focus({ preventScroll: true });
  }

  end(): void {
    document.removeEventListener('keydown', this.#key, true);
    this.#card.hidden = true;
    this.#card.replaceChildren();
    const { layers, camera, imageIsLarge, isByHand, playing } = this.#before;
    this.#host.pin(undefined);
    this.#host.showLayers(layers);
    // What the last step leaves running goes on.
    this.#host.view(this.#at === STEPS.length - 1 ? 'chase' : camera);
    this.#host.enlargeImage(imageIsLarge);
    void this.#host.byHand(isByHand);
    void this.#host.play(playing || this.#at === STEPS.length - 1);
    this.#ended();
  }

  async #go(to: number): Promise<void> {
    const step = STEPS[to];
    if (to >= STEPS.length) this.end();
    if (!step) return;
    this.#at = to;
    await this.#host.play(false);
    const { frame, info } = await this.#host.decided();
    this.#host.showLayers({ ...BARE, ...step.layers });
    this.#host.enlargeImage(step.image ?? false);
    await this.#host.byHand(step.byHand ?? false);
    this.#host.view(step.camera);
    this.#host.pin(step.marks);
    setText(this.#count, `${to + 1} of ${STEPS.length}`);
    setText(this.#title, step.title);
    setText(this.#text, step.text(frame, info));
    setText(this.#next, to === STEPS.length - 1 ? 'Done' : 'Next');
    this.#back.disabled = to === 0;
    if (step.drives) await this.#host.play(true);
  }

  #key = (event: KeyboardEvent): void => {
    const act = { ArrowRight: () => this.#next.click(), ArrowLeft: () => this.#back.click(), Escape: () => this.end() }[
      event.key
    ];
    if (!act || !this.#isFor(event)) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  };

  /** Keys pressed in the card, or on what has no use for them itself. */
  #isFor({ key, target }: KeyboardEvent): boolean {
    if (!(target instanceof Element) || this.#card.contains(target)) return true;
    if (document.querySelector('dialog[open], :popover-open')) return false;
    return key === 'Escape' || target.matches('button:not([role])');
  }
}
