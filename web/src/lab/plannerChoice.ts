/** Who drives a batch of trials: the planner in view, any other that can be compared with it, or somebody's own. */

import { html } from '../base/dom.ts';
import { confine, type OwnPlanner } from '../guest/confinement.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Guest } from '../trials/batch.ts';
import { FIXED_RIVAL, IDEAL_RIVAL, OWN_RIVAL, RIVALS, type Rival } from './planners.ts';

/** What shows a trial of another planner than that in view, and has somebody's own. */
export interface Beside {
  readonly ownPlanner: OwnPlanner;
  /** Has one drive as a ghost beside the robot in view; throws where there is no room for it. */
  drive(rival: Rival, own?: OwnPlanner): void;
}

/** Who drives the trials of a batch. */
export interface Driver {
  readonly rival: Rival;
  /** Its code, where it is somebody's own. */
  readonly own: OwnPlanner | undefined;
}

const IN_VIEW = '';
const OTHERS = [...RIVALS.filter((rival) => rival !== IDEAL_RIVAL && rival !== FIXED_RIVAL), OWN_RIVAL];

/** The planner in view, by the name that it has in comparisons. */
export function rivalInView({ preset }: Pick<SessionInfo, 'preset'>): Rival {
  return RIVALS.find(({ planner }) => planner === preset) ?? { planner: preset, name: preset, meaning: '', colour: '' };
}

export class PlannerChoice {
  readonly select = html('select');
  readonly #inView = new Option('', IN_VIEW);
  readonly #beside: Beside;

  /** `owner` keeps the choices of several tabs apart. */
  constructor(owner: string, beside: Beside) {
    this.#beside = beside;
    this.select.id = `${owner}-planner`;
    this.select.setAttribute('aria-label', 'Planner');
    const others = OTHERS.map(({ planner, name, meaning }) => new Option(`${name}: ${meaning}`, planner));
    this.select.append(this.#inView, ...others);
  }

  session(info: SessionInfo): void {
    this.#inView.text = `the one in view: ${rivalInView(info).name}`;
  }

  driver(info: SessionInfo): Driver {
    const rival = OTHERS.find(({ planner }) => planner === this.select.value) ?? rivalInView(info);
    return { rival, own: rival === OWN_RIVAL ? this.#beside.ownPlanner : undefined };
  }

  /** Has a trial's planner drive where it is not the one in view, once the view has its seed. */
  show({ rival, own }: Driver, info: SessionInfo | undefined): void {
    if (info?.preset !== rival.planner) this.#beside.drive(rival, own);
  }
}

/** Somebody's own planner, for a batch. */
export function guestOf({ own }: Driver): Guest | undefined {
  return own && { name: own.name, begin: () => confine(own) };
}

/** Who drove, in a sentence. */
function nameOf({ rival, own }: Driver): string {
  return own ? `your ${own.name}` : rival.name;
}

/** How a trial of such a driver is seen. */
export function seenHow({ rival }: Driver, { preset }: Pick<SessionInfo, 'preset'>): string {
  return rival.planner === preset ? 'driven' : 'driven as a ghost beside the robot in view';
}

/** How a batch gets on. */
export function progressWords(done: number, total: number, driver: Driver): string {
  return `${done} of ${total} trials of ${nameOf(driver)} done.`;
}

/** What a batch has driven, and what a press on a `part` of its table does. */
export function drivenWords(
  done: number,
  total: number,
  driver: Driver & { readonly seen: string },
  part: string,
): string {
  const count = done === total ? done : `${done} of ${total}`;
  const campaign = driver.own ? ' The command line does not know this planner, so there is no campaign to save.' : '';
  return `${count} trials of ${nameOf(driver)}. Press a ${part} to see it ${driver.seen}.${campaign}`;
}
