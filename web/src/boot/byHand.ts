/** The Gaussian process and the cost by hand: each is loaded when it is first wanted. */

import type { App } from '../app/app.ts';
import { byId } from '../base/dom.ts';
import type { Theme } from '../colours/theme.ts';
import type { Inspector } from '../inspector/inspector.ts';
import type { Method } from '../method/method.ts';
import type { Weighing } from '../method/weighing.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Stage } from '../view/stage.ts';

export class ByHand {
  readonly #app: App;
  readonly #inspector: Inspector;
  readonly #stage: Stage | undefined;
  readonly #view: HTMLCanvasElement;
  readonly #besideFixed: () => Promise<void>;
  readonly #page = byId('app', HTMLElement);
  readonly #seen = byId('seen', HTMLElement);
  readonly #opener = byId('by-hand', HTMLButtonElement);
  readonly #keyTrue = byId('key-true', HTMLElement);
  readonly #weigh = byId('weigh', HTMLButtonElement);
  readonly #scales = byId('weighing', HTMLElement);
  #method: Method | undefined;
  #weighing: Weighing | undefined;
  /** Whether the image is large only because the process was opened beside it. */
  #enlarged = false;

  /** `besideFixed` has a ghost with fixed hyperparameters drive beside the robot. */
  constructor(
    app: App,
    inspector: Inspector,
    stage: Stage | undefined,
    view: HTMLCanvasElement,
    besideFixed: () => Promise<void>,
  ) {
    [this.#app, this.#inspector, this.#stage, this.#view] = [app, inspector, stage, view];
    this.#besideFixed = besideFixed;
    this.#opener.addEventListener('click', () => this.toggleProcess());
    this.#weigh.addEventListener('click', () => this.toggleCost());
  }

  session(info: SessionInfo): void {
    this.#method?.session(info);
    this.#weighing?.session(info);
  }

  frame(frame: Frame): void {
    this.#method?.frame(frame);
  }

  theme(theme: Theme): void {
    this.#method?.theme(theme);
  }

  /** The image has become large, which has a handle on its threshold, or small, beside which there is no room. */
  imageEnlarged(large: boolean): void {
    if (large) void this.#app.attempt(this.#load().then(() => undefined));
    else if (this.#method?.isOpen) this.#show(this.#method, false);
  }

  toggleProcess(): void {
    void this.#app.attempt(this.process(!this.#method?.isOpen));
  }

  /** Opens the Gaussian process beside a large image, or closes it and leaves the image as it was before. */
  async process(open: boolean): Promise<void> {
    if (!open && !this.#method) return;
    const method = await this.#load();
    if (method.isOpen === open) return;
    if (open) {
      this.#enlarged = !this.#inspector.imageIsLarge;
      this.#inspector.enlargeImage(true);
    }
    this.#show(method, open);
    if (!open && this.#enlarged) this.#inspector.enlargeImage(false);
  }

  toggleCost(): void {
    void this.#app.attempt(this.#toggleCost());
  }

  async #load(): Promise<Method> {
    const { Method } = await import('../method/method.ts');
    const canvas = byId('variance', HTMLCanvasElement);
    this.#method ??= new Method(this.#app, this.#inspector.image, this.#seen, canvas, this.#besideFixed);
    return this.#method;
  }

  #show(method: Method, open: boolean): void {
    this.#page.toggleAttribute('data-method', open);
    this.#opener.setAttribute('aria-expanded', String(open));
    this.#keyTrue.hidden = !open;
    method.show(open);
  }

  async #toggleCost(): Promise<void> {
    if (!this.#weighing) {
      const { Weighing } = await import('../method/weighing.ts');
      this.#weighing ??= new Weighing(this.#app, this.#stage, this.#view);
      this.#scales.replaceChildren(this.#weighing.element);
    }
    const open = this.#scales.hidden;
    this.#scales.hidden = !open;
    this.#weigh.setAttribute('aria-expanded', String(open));
    if (open) this.#scales.scrollIntoView({ block: 'nearest' });
    else this.#weighing.close();
  }
}
