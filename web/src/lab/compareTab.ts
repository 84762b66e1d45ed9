/** Other planners on the same course, in step with the robot of the page: ghosts in the view, differences in a table. */

import type { App } from '../app/app.ts';
import { button, html, setText } from '../base/dom.ts';
import { differences } from '../experiment/differences.ts';
import { withoutHyperparameters } from '../experiment/hyperparameters.ts';
import { inIdealWorld } from '../experiment/reality.ts';
import { download } from '../files/download.ts';
import type { OwnPlanner } from '../guest/confinement.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import { routeOf, trialsCsv } from '../trials/batchFiles.ts';
import { courseOf, drivenWith } from '../trials/course.ts';
import type { GhostRun } from '../trials/ghostRun.ts';
import type { Rider, TrialResult } from '../trials/trialsProtocol.ts';
import type { Stage } from '../view/stage.ts';
import { ComparisonTable } from './comparisonTable.ts';
import { GhostTrails } from './ghostTrails.ts';
import { shownTick } from './inStep.ts';
import { KeptSets } from './keptSets.ts';
import type { Tab } from './lab.ts';
import { OwnPlannerCard } from './ownPlanner.ts';
import { OwnRider, type OwnRiderHeard } from './ownRider.ts';
import { FIXED_RIVAL, IDEAL_RIVAL, OWN_RIVAL, RIVALS, type Rival, SET_RIVALS } from './planners.ts';
import { Riders } from './riders.ts';

/** More at once would starve each other, and the table would not fit. */
const MOST = 3;
/** Strokes come many in a row: the ghosts begin anew when they have ended. */
const SCULPTING_MS = 600;
/** Beyond the page's own run, ghosts run to their end. */
const TO_THE_END = 1e9;

/** One that can be compared with. */
interface Choice {
  readonly rival: Rival;
  readonly box: HTMLInputElement;
  readonly meaning: HTMLElement;
  readonly element: HTMLElement;
}

export class CompareTab implements Tab {
  readonly title = 'Compare';
  readonly element = html('div');
  readonly #app: App;
  readonly #stage: Stage | undefined;
  #choiceChanged: (() => void) | undefined;
  readonly #trails = new GhostTrails();
  readonly #sets = new KeptSets();
  readonly #boxes: readonly Choice[];
  readonly #note = html('p', 'lab-note');
  readonly #fault = html('p', 'parameter-fault');
  readonly #table = new ComparisonTable();
  readonly #save = html('div', 'lab-row', [button('plain', 'Save as CSV', () => this.#saveCsv())]);
  readonly #card = new OwnPlannerCard((planner) => this.#drive(planner));
  #own: OwnPlanner | undefined;
  readonly #heard: OwnRiderHeard = {
    driven: (entered) => {
      if (entered) this.#showGhosts();
      this.#show();
    },
    fault: (planner, message) => this.#refused(planner, message),
    said: (words) => this.#card.say(words),
    broke: (words) => {
      this.#card.fault(words);
      this.#show();
    },
  };
  readonly #riders = new Riders(this.#heard);
  readonly #ownRider = new OwnRider(this.#heard);
  #chosen: readonly Rival[] = [];
  #session = '';
  /** How often the ground has become another one. */
  #grounds = 0;
  #frame: Frame | undefined;
  #sculpted: ReturnType<typeof setTimeout> | undefined;

  constructor(app: App, stage: Stage | undefined) {
    this.#app = app;
    this.#stage = stage;
    this.#boxes = [
      ...[...RIVALS, OWN_RIVAL].map((rival) => this.#box(rival)),
      ...SET_RIVALS.map((one) => this.#set(one)),
    ];
    const choice = html('fieldset', 'rivals', [
      html('legend', 'hidden-text', ['Planners to compare with']),
      ...this.#boxes.map(({ element }) => element),
    ]);
    const keeps = SET_RIVALS.map((rival) => {
      const keep = button('plain', rival.name, () => this.#keep(rival));
      keep.setAttribute('aria-label', `Keep these parameters as ${rival.name}`);
      return keep;
    });
    this.#fault.setAttribute('role', 'alert');
    this.#fault.hidden = true;
    this.element.append(
      choice,
      html('div', 'lab-row kept-sets', ['Keep these parameters as', ...keeps]),
      this.#note,
      this.#fault,
      this.#table.element,
      this.#save,
      this.#card.element,
    );
    this.#save.hidden = true;
    this.#tellChoice();
  }

  session(info: SessionInfo): void {
    this.#table.session(info);
    this.#tellSets();
    // A restart changes nothing: what the ghosts have driven is still right.
    const { parameters: _parameters, ...session } = info;
    const now = JSON.stringify(session);
    if (now === this.#session) return;
    this.#session = now;
    this.#begin();
  }

  sculpted(): void {
    clearTimeout(this.#sculpted);
    this.#sculpted = setTimeout(() => {
      this.#grounds += 1;
      this.#begin();
    }, SCULPTING_MS);
  }

  frame(frame: Frame): void {
    this.#frame = frame;
    this.#riders.until(this.#until);
    this.#ownRider.until(this.#until);
    this.#show();
  }

  shown(): void {
    this.#show();
  }

  #box(rival: Rival): Choice {
    const box = html('input');
    box.type = 'checkbox';
    box.value = rival.planner;
    box.addEventListener('change', () => this.#choose());
    const swatch = html('i', 'swatch');
    swatch.style.setProperty('--swatch', rival.colour);
    const meaning = html('span', 'rival-meaning', [rival.meaning]);
    const element = html('label', 'rival', [box, swatch, html('span', 'rival-name', [rival.name]), meaning]);
    return { rival, box, meaning, element };
  }

  /** That of a parameter set, which the robot in view can get back. */
  #set(rival: Rival): Choice {
    const { element: label, ...choice } = this.#box(rival);
    const use = button('plain', 'Use', () => {
      const kept = this.#sets.get(rival.planner);
      this.#app.touch();
      if (kept) this.#app.attempt(this.#app.adjust(kept));
    });
    use.setAttribute('aria-label', `Use the parameters of ${rival.name}`);
    return { ...choice, element: html('div', 'kept-set', [label, use]) };
  }

  /** Keeps what the robot in view has now, which drives as a ghost where there is room. */
  #keep(rival: Rival): void {
    const { info } = this.#app;
    if (!info) return;
    this.#sets.keep(rival.planner, info);
    this.#tellSets();
    const { chosen, room } = this.stateOf(rival);
    this.pick(rival, chosen || room);
  }

  /** Says how each set that is kept differs from what is in view. */
  #tellSets(): void {
    const { info } = this.#app;
    for (const { rival, meaning, element } of this.#boxes) {
      if (!SET_RIVALS.includes(rival)) continue;
      const kept = this.#sets.get(rival.planner);
      element.hidden = !kept;
      if (!kept || !info) continue;
      const words = differences(kept, info, info.parameters);
      setText(meaning, words.length === 0 ? 'the parameters in view' : words.join('; '));
    }
  }

  /** How one of the planners or sets drives. */
  #rider({ planner }: Rival, { preset, learning, overrides }: SessionInfo): Rider {
    const kept = this.#sets.get(planner);
    if (kept) return { ...kept, name: planner, planner: kept.preset };
    if (planner === IDEAL_RIVAL.planner)
      return { name: planner, planner: preset, learning, overrides: inIdealWorld(overrides) };
    if (planner === FIXED_RIVAL.planner)
      return { name: planner, planner: preset, learning: 'fixed', overrides: withoutHyperparameters(overrides) };
    return { name: planner, planner, learning, overrides };
  }

  /** Who is told whenever others are compared with. */
  onChoice(changed: () => void): void {
    this.#choiceChanged = changed;
  }

  /** Whether one is compared with, and whether there is room for another. */
  stateOf({ planner }: Rival): { chosen: boolean; room: boolean } {
    return { chosen: this.#chosen.some((rival) => rival.planner === planner), room: this.#chosen.length < MOST };
  }

  /** Compares with one, or no longer. */
  pick({ planner }: Rival, picked: boolean): void {
    for (const { rival, box } of this.#boxes) if (rival.planner === planner) box.checked = picked;
    this.#choose();
  }

  /** A file with a planner that was dropped on the page. */
  open(name: string, bytes: Uint8Array<ArrayBuffer>): void {
    this.#card.open(name, bytes);
  }

  /** Somebody's own planner: that which drives from bytes, or what is written in the card. */
  get ownPlanner(): OwnPlanner {
    return this.#own && typeof this.#own.code !== 'string' ? this.#own : this.#card.written;
  }

  /** Has one drive as a ghost; throws where there is no room for it. */
  drive(rival: Rival, own?: OwnPlanner): void {
    const { chosen, room } = this.stateOf(rival);
    if (!chosen && !room) throw new Error(`Compare: ${MOST} others are driving: take one away first.`);
    if (own) this.#drive(own);
    else this.pick(rival, true);
  }

  /** Has somebody's own planner drive from the start, in place of the one before. */
  #drive(planner: OwnPlanner): void {
    const { chosen, room } = this.stateOf(OWN_RIVAL);
    if (!chosen && !room) {
      this.#card.fault(`${MOST} others are driving: take one away first.`);
      return;
    }
    this.#own = planner;
    this.#ownRider.replaced();
    this.pick(OWN_RIVAL, true);
  }

  #choose(): void {
    this.#app.touch();
    this.#chosen = this.#boxes.filter(({ box }) => box.checked).map(({ rival }) => rival);
    if (this.#chosen.includes(OWN_RIVAL)) this.#own ??= this.#card.written;
    this.#tellChoice();
    this.#begin();
  }

  #tellChoice(): void {
    const full = this.#chosen.length >= MOST;
    for (const { box } of this.#boxes) box.disabled = full && !box.checked;
    const how = `All start where the run started, with the same seed. Planners use the parameters in view, A and B those that were kept (in brackets: the value in view). At most ${MOST} at once. One that is catching up is compared at its own time. Links and files of the run do not contain the comparison; A and B stay until this tab is closed.`;
    setText(this.#note, how);
    this.#choiceChanged?.();
  }

  /** Those chosen, on the course as it is now: from its start where anything of theirs has changed. */
  #begin(): void {
    this.#fault.hidden = true;
    const { info, field } = this.#app;
    if (info && field) {
      const { scenario, seed, start, waypoints, goal, objects } = info;
      const key = JSON.stringify([this.#grounds, scenario, seed, start, waypoints, goal, objects]);
      const course = courseOf(info, field);
      const riders = this.#chosen.filter((rival) => rival !== OWN_RIVAL).map((rival) => this.#rider(rival, info));
      this.#riders.set(course, seed, key, riders);
      this.#ownRider.set(course, seed, key, this.#chosen.includes(OWN_RIVAL) ? this.#own : undefined);
    }
    this.#showGhosts();
    this.#table.choose(this.#chosen);
    this.#save.hidden = this.#chosen.length === 0;
    this.#show();
  }

  get #until(): number {
    if (!this.#frame) return 0;
    return this.#frame.outcome === 'running' ? this.#frame.timeline.end : TO_THE_END;
  }

  #refused(planner: string | undefined, message: string): void {
    const whose = this.#chosen.find((rival) => rival.planner === planner);
    setText(this.#fault, whose ? `${whose.name}: ${message}` : message);
    this.#fault.hidden = false;
  }

  /** Those that run, from their start. */
  #showGhosts(): void {
    const running = this.#running();
    this.#trails.set(running.map(([, run]) => run));
    this.#stage?.ghosts(running.map(([{ colour }]) => colour));
  }

  #running(): [Rival, GhostRun][] {
    return this.#chosen.flatMap((rival) => {
      const run = rival === OWN_RIVAL ? this.#ownRider.run : this.#riders.runs.get(rival.planner);
      return run ? [[rival, run] as [Rival, GhostRun]] : [];
    });
  }

  #show(): void {
    const frame = this.#frame;
    if (!frame || this.#chosen.length === 0) return;
    this.#stage?.ghostSteps(this.#trails.steps(this.#running().map(([, run]) => shownTick(run, frame))));
    if (this.element.hidden) return;
    this.#table.show(frame, this.#app.record, this.#results(frame), this.#ownRider.broken);
  }

  /** How those stand that run, by their rivals' planners. */
  #results(frame: Frame): Map<string, TrialResult> {
    return new Map(this.#running().map(([rival, run]) => [rival.planner, run.at(shownTick(run, frame))]));
  }

  /** What the table shows now, with the robot in view first. */
  #saveCsv(): void {
    const [frame, { info, editor }] = [this.#frame, this.#app];
    if (!frame || !info || !editor.experiment) return;
    const [setup, results] = [info.runsWith ?? info, this.#results(frame)];
    const inView = { planner: setup.preset, overrides: drivenWith(setup), result: { ...frame, seed: info.seed } };
    const others = this.#chosen.flatMap((rival) => {
      const [rider, result] = [this.#rider(rival, info), results.get(rival.planner)];
      return result ? [{ planner: rider.planner, overrides: drivenWith(rider), result }] : [];
    });
    const route = routeOf(info.scenario, editor.experiment, editor.asItComes);
    const csv = trialsCsv(route, [inView, ...others]);
    download(`mapless-${route}-comparison.csv`, new Blob([csv], { type: 'text/csv' }));
  }
}
