/** The drawer beside the view: parameters, other planners on the same course, and many seeds. */

import '../style/lab.css';
import type { App } from '../app/app.ts';
import { html } from '../base/dom.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Stage } from '../view/stage.ts';
import { CompareTab } from './compareTab.ts';
import { ParametersTab } from './parametersTab.ts';
import { FIXED_RIVAL } from './planners.ts';
import { SeedsTab } from './seedsTab.ts';
import { SweepTab } from './sweepTab.ts';

/** One page of the drawer. */
export interface Tab {
  readonly title: string;
  readonly element: HTMLElement;
  session(info: SessionInfo): void;
  frame?(frame: Frame): void;
  /** The ground was sculpted. */
  sculpted?(): void;
  /** It is in sight from now on. */
  shown?(): void;
}

export class Lab {
  readonly #opener: HTMLButtonElement;
  readonly #drawer = html('section', 'lab');
  readonly #tabs: readonly Tab[];
  readonly #buttons: readonly HTMLButtonElement[];
  readonly #compare: CompareTab;

  constructor(app: App, stage: Stage | undefined, opener: HTMLButtonElement) {
    this.#opener = opener;
    const compare = new CompareTab(app, stage);
    this.#compare = compare;
    this.#tabs = [new ParametersTab(app, compare), compare, new SeedsTab(app, compare), new SweepTab(app, compare)];
    this.#buttons = this.#tabs.map((tab, index) => this.#button(tab, index));
    const list = html('div', 'lab-tabs', this.#buttons);
    list.setAttribute('role', 'tablist');
    list.setAttribute('aria-label', 'Experiment');
    list.addEventListener('keydown', (event) => this.#turn(event));
    const close = html('button', 'round lab-close', ['×']);
    close.type = 'button';
    close.setAttribute('aria-label', 'Close');
    close.addEventListener('click', () => this.toggle());
    this.#drawer.append(html('header', 'lab-head', [list, close]), ...this.#tabs.map(({ element }) => element));
    this.#drawer.setAttribute('aria-label', 'Parameters, comparison, many seeds');
    this.#drawer.hidden = true;
    this.#drawer.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || event.defaultPrevented) return;
      event.preventDefault();
      event.stopPropagation();
      this.toggle();
    });
    document.querySelector('.app')?.append(this.#drawer);
    this.#select(0);
    if (app.info) this.session(app.info);
    // While the run stands still, no other frame comes.
    if (app.frame) this.frame(app.frame);
  }

  toggle(): void {
    const open = this.#drawer.hidden;
    this.#drawer.hidden = !open;
    this.#opener.setAttribute('aria-expanded', String(open));
    if (open) this.#buttons.find((button) => button.tabIndex === 0)?.focus();
    else this.#opener.focus();
  }

  /** Has somebody's own planner drive beside the robot in view. */
  planner(name: string, bytes: Uint8Array<ArrayBuffer>): void {
    this.#select(this.#tabs.indexOf(this.#compare));
    if (this.#drawer.hidden) this.toggle();
    this.#compare.open(name, bytes);
  }

  /** Has the planner in view drive beside it, with its own, fixed hyperparameters. */
  besideFixed(): void {
    this.#compare.drive(FIXED_RIVAL);
  }

  session(info: SessionInfo): void {
    for (const tab of this.#tabs) tab.session(info);
  }

  frame(frame: Frame): void {
    for (const tab of this.#tabs) tab.frame?.(frame);
  }

  sculpted(): void {
    for (const tab of this.#tabs) tab.sculpted?.();
  }

  #button({ title, element }: Tab, index: number): HTMLButtonElement {
    const button = html('button', 'lab-tab', [title]);
    button.type = 'button';
    button.id = `lab-tab-${index}`;
    button.setAttribute('role', 'tab');
    button.setAttribute('aria-controls', `lab-page-${index}`);
    button.addEventListener('click', () => this.#select(index));
    element.id = `lab-page-${index}`;
    element.classList.add('lab-page');
    element.setAttribute('role', 'tabpanel');
    element.setAttribute('aria-labelledby', button.id);
    return button;
  }

  #select(index: number): void {
    for (const [at, button] of this.#buttons.entries()) {
      button.setAttribute('aria-selected', String(at === index));
      button.tabIndex = at === index ? 0 : -1;
    }
    for (const [at, { element }] of this.#tabs.entries()) element.hidden = at !== index;
    this.#tabs[index]?.shown?.();
  }

  /** Arrow keys go along the tabs, as in every list of tabs. */
  #turn(event: KeyboardEvent): void {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const now = this.#buttons.findIndex((button) => button.tabIndex === 0);
    const next = (now + step + this.#buttons.length) % this.#buttons.length;
    this.#select(next);
    this.#buttons[next]?.focus();
  }
}
