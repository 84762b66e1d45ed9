/** What shows how the planner decides: image, decision, layers, cameras, what is pointed at, and the tour. */

import type { App } from '../app/app.ts';
import { byId, setText } from '../base/dom.ts';
import { readTheme, type Theme } from '../colours/theme.ts';
import type { HeightField } from '../ground/heightField.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import { type Layers, needsSurfaces } from '../scene/layers.ts';
import { type Finder, SelectionModel } from '../scene/selection.ts';
import type { TourHost } from '../tour/tour.ts';
import type { Stage } from '../view/stage.ts';
import type { CameraMode } from '../view/viewpoint.ts';
import { bindPointing, bindStepping } from './bindPointing.ts';
import { DecisionPanel } from './decision.ts';
import { DetailCard } from './detail.ts';
import { LayersPanel } from './layersPanel.ts';
import { neighbour, VarianceImage } from './varianceImage.ts';
import { ViewKey } from './viewKey.ts';
import { WhatIf } from './whatIf.ts';

const element = (id: string) => byId(id, HTMLElement);
const button = (id: string) => byId(id, HTMLButtonElement);

/** What is loaded when somebody opens it. */
export interface Opens {
  /** The image has become large or small. */
  enlarged(large: boolean): void;
  /** Opens the Gaussian process by hand, or closes it. */
  byHand(open: boolean): Promise<void>;
}

export class Inspector implements TourHost {
  readonly #app: App;
  readonly #stage: Stage | undefined;
  readonly #page = element('app');
  readonly #selection = new SelectionModel((frame, target) => {
    this.#stage?.mark(target);
    this.#image.mark(target);
    this.#decision.mark(target);
    this.#detail.show(frame, target, this.#selection.pinned);
  });
  readonly #canvas = byId('variance', HTMLCanvasElement);
  readonly #image = new VarianceImage(this.#canvas, readTheme());
  readonly #detail = new DetailCard(element('detail'), () => this.letGo());
  readonly #decision = new DecisionPanel(
    element('candidates'),
    element('terms'),
    element('candidate-count'),
    this.#selection,
  );
  readonly #key = new ViewKey();
  readonly #layers = new LayersPanel((layers) => {
    this.#stage?.layers(layers);
    this.#key.hide(layers.points === 'none');
    this.#watch();
  });
  #imageInSight = false;
  readonly #whatIf: WhatIf;

  readonly #opens: Opens;

  constructor(app: App, stage: Stage | undefined, view: HTMLCanvasElement, opens: Opens) {
    this.#opens = opens;
    this.#app = app;
    this.#stage = stage;
    this.#whatIf = new WhatIf({
      goOn: () => app.attempt(app.play()),
      fromStart: () => app.attempt(app.runTried()),
      forget: () => app.attempt(app.forgetTried()),
    });
    const cameras: [string, () => void][] = [
      ['follow', () => this.toggleFollow()],
      ['eye', () => this.toggleEye()],
      ['top', () => this.toggleTop()],
      ['overview', () => this.overview()],
      ['enlarge', () => this.toggleImage()],
      ['tour-open', () => this.tour()],
    ];
    for (const [id, act] of cameras) button(id).addEventListener('click', act);
    new IntersectionObserver((entries) => {
      this.#imageInSight = entries.at(-1)?.isIntersecting ?? false;
      this.#watch();
    }).observe(this.#canvas);
    bindPointing(this.#canvas, this.#selection, (...at) => this.#image.pointedAt(...at));
    const looks = () => view.dataset.tool === 'look';
    bindPointing(view, this.#selection, (...at) => stage?.pointedAt(...at), looks);
    bindStepping(this.#canvas, (by, segments) => {
      this.#selection.pin((frame) => neighbour(frame, this.#selection.target, by, segments));
      setText(element('pointed'), this.#detail.text);
    });
  }

  session(info: SessionInfo, field: HeightField | undefined): void {
    this.#image.session(info);
    this.#detail.session(info);
    this.#decision.session(info);
    if (field) this.#layers.heights(field.min_m, field.max_m);
    this.#showCamera();
  }

  /** The image, for whoever looks inside it. */
  get image(): VarianceImage {
    return this.#image;
  }

  /** Play was pressed while something is only tried. */
  askHow(): void {
    this.#whatIf.ask();
  }

  frame(frame: Frame): void {
    this.#whatIf.show(frame);
    this.#image.show(frame);
    this.#key.show(frame);
    this.#decision.show(frame);
    this.#selection.show(frame);
  }

  theme(theme: Theme): void {
    this.#image.theme(theme);
  }

  toggleFollow(): void {
    if (this.camera === 'chase') this.#stage?.release();
    else this.#stage?.view('chase');
    this.#showCamera();
  }

  toggleEye(): void {
    this.view(this.camera === 'eye' ? 'chase' : 'eye');
  }

  toggleTop(): void {
    this.view(this.camera === 'top' ? 'chase' : 'top');
  }

  overview(): void {
    this.view('free');
  }

  toggleLayers(): void {
    this.#layers.toggle();
  }

  toggleImage(): void {
    this.enlargeImage(!this.imageIsLarge);
  }

  /** Lets go of what was pointed at. */
  letGo(): void {
    this.#selection.pin(undefined);
  }

  tour(): void {
    this.#app.attempt(this.#tour());
  }

  get layers(): Layers {
    return this.#layers.layers;
  }

  showLayers(layers: Layers): void {
    this.#layers.set(layers);
  }

  get camera(): CameraMode {
    return this.#stage?.camera ?? 'free';
  }

  view(mode: CameraMode): void {
    this.#stage?.view(mode);
    this.#showCamera();
  }

  /** Moves the view over the ground; it follows the robot no longer. */
  moveView(right: number, ahead: number): void {
    this.#stage?.move(right, ahead);
    this.#showCamera();
  }

  get imageIsLarge(): boolean {
    return this.#page.dataset.image === 'large';
  }

  enlargeImage(large: boolean): void {
    this.#page.dataset.image = large ? 'large' : 'small';
    button('enlarge').setAttribute('aria-pressed', String(large));
    this.#opens.enlarged(large);
    // A phone scrolls the large image sideways: it begins with what is ahead.
    const scroller = element('seen-scroll');
    scroller.scrollLeft = (scroller.scrollWidth - scroller.clientWidth) / 2;
    if (large) scroller.scrollIntoView({ block: 'nearest' });
  }

  get playing(): boolean {
    return this.#app.playing;
  }

  /** What was only tried on the tour is taken back before the robot drives on. */
  async play(playing: boolean): Promise<void> {
    if (!playing) return this.#app.pause();
    await this.#app.forgetTried();
    await this.#app.play();
  }

  get isByHand(): boolean {
    return this.#page.hasAttribute('data-method');
  }

  byHand(open: boolean): Promise<void> {
    return this.#app.attempt(this.#opens.byHand(open));
  }

  decided(): Promise<{ frame: Frame; info: SessionInfo }> {
    return this.#app.decided();
  }

  pin(finder: Finder | undefined): void {
    this.#selection.pin(finder);
  }

  /** The surfaces are predicted only while the image is in sight or a layer shows them. */
  #watch(): void {
    this.#app.attempt(this.#app.watch(this.#imageInSight || needsSurfaces(this.layers)));
  }

  #showCamera(): void {
    const buttons = { follow: 'chase', eye: 'eye', top: 'top' };
    for (const [id, mode] of Object.entries(buttons)) {
      button(id).setAttribute('aria-pressed', String(mode === this.camera));
    }
  }

  /** Loaded only for those who take it. */
  async #tour(): Promise<void> {
    if (this.#page.dataset.tour) return;
    this.#page.dataset.tour = 'on';
    const ended = () => {
      delete this.#page.dataset.tour;
      button('tour-open').focus();
    };
    try {
      const { Tour } = await import('../tour/tour.ts');
      await new Tour(element('tour'), this, ended).begin();
    } catch (error) {
      ended();
      throw error;
    }
  }
}
