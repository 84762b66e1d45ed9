/** Every parameter of sensor, robot and planner, made from the core's own table. A change is tried at the pose, or begins the run anew. */

import type { App } from '../app/app.ts';
import { button, html, setText } from '../base/dom.ts';
import { messageOf } from '../base/messageOf.ts';
import { countOverrides, type Overrides, type OverrideValue, override, withOverride } from '../experiment/overrides.ts';
import { departures } from '../experiment/paperValues.ts';
import { complaintAbout, label, type ParameterGroup } from '../experiment/parameters.ts';
import { isEffects, isOn, withReality } from '../experiment/reality.ts';
import type { Learning } from '../experiment/setting.ts';
import type { SessionInfo } from '../protocol/simulationProtocol.ts';
import type { CompareTab } from './compareTab.ts';
import type { Tab } from './lab.ts';
import { type MountPreset, mountOf, presetButtons, withMount } from './mount.ts';
import { ParameterField } from './parameterField.ts';
import { IDEAL_RIVAL } from './planners.ts';
import { RealityCard } from './realityCard.ts';

/** This one is chosen in the bar; the field here and the bar are the same setting. */
const LEARNING_MODE = 'planner.perception.learning.mode';

interface Section {
  readonly group: ParameterGroup;
  readonly element: HTMLDetailsElement;
  readonly count: HTMLElement;
  readonly fields: readonly ParameterField[];
}

/** Its sections are within it. */
interface Card {
  readonly card: RealityCard;
  readonly sections: readonly Section[];
}

export class ParametersTab implements Tab {
  readonly title = 'Parameters';
  readonly element = html('div');
  readonly #app: App;
  readonly #search = html('input');
  readonly #resetAll = html('button', 'plain', ['Reset all']);
  readonly #summary = html('p', 'lab-note');
  readonly #fault = html('p', 'parameter-fault');
  readonly #list = html('div', 'parameter-list');
  readonly #compare: CompareTab;
  #sections: readonly Section[] = [];
  #reality: Card | undefined;
  #made = '';

  constructor(app: App, compare: CompareTab) {
    this.#app = app;
    this.#compare = compare;
    compare.onChoice(() => this.#showGhost());
    this.#search.type = 'search';
    this.#search.placeholder = 'Search, e.g. noise';
    this.#search.setAttribute('aria-label', 'Search parameters');
    this.#search.addEventListener('input', () => this.#find());
    this.#resetAll.type = 'button';
    this.#resetAll.addEventListener('click', () => void this.#apply({}, undefined));
    this.#fault.setAttribute('role', 'alert');
    this.#fault.hidden = true;
    const asWritten = button('plain', 'The paper as written', () => this.#app.attempt(this.#asWritten()));
    const top = html('div', 'lab-row', [this.#search, asWritten, this.#resetAll]);
    this.element.append(top, this.#summary, this.#fault, this.#list);
  }

  session(info: SessionInfo): void {
    // The table stays as it is while somebody only changes values, so that the focus stays, too.
    const made = JSON.stringify(info.parameters);
    if (made !== this.#made) this.#build(info.parameters);
    this.#made = made;
    for (const { group, fields, count } of this.#sections) {
      let [changed, on] = [0, 0];
      for (const [index, field] of fields.entries()) {
        const parameter = group.parameters[index];
        if (!parameter) continue;
        const { name, value: own } = parameter;
        const set = override(info.overrides, group.table, name);
        const value = field.path === LEARNING_MODE && info.learning !== own ? info.learning : set;
        field.show(value);
        if (value !== undefined) changed += 1;
        if (isOn(parameter, value ?? own)) on += 1;
      }
      const words = [on > 0 ? `${on} on` : '', changed > 0 ? `${changed} changed` : ''];
      setText(count, words.filter(Boolean).join(', '));
    }
    this.#reality?.card.show(info);
    const total = countOverrides(info.overrides);
    this.#resetAll.disabled = total === 0;
    const kept = total === 0 ? 'All values are the defaults.' : `${total} changed.`;
    const other = departures(info.parameters, info).map(({ parameter }) => label(parameter.name));
    const paper = other.length === 0 ? 'The paper as written' : `The paper has another ${other.join(', ')}`;
    setText(
      this.#summary,
      `${kept} ${info.preset === 'paper' ? `${paper}. ` : ''}While the run is paused, a change is tried where the robot stands; while it drives, the run begins anew with the same seed.`,
    );
    this.#complain(undefined);
  }

  #build(groups: readonly ParameterGroup[]): void {
    const [open, focused] = [new Set(this.#openTitles()), document.activeElement?.id];
    if (open.size === 0) open.add(RealityCard.title);
    const section = (group: ParameterGroup) => this.#section(group, open.has(group.title));
    const effects = groups.filter(isEffects).map(section);
    const card = new RealityCard(
      groups,
      effects.map(({ element }) => element),
      {
        preset: (name) => void this.#chooseReality(name),
        ghost: (wanted) => this.#compare.pick(IDEAL_RIVAL, wanted),
      },
    );
    card.element.open = open.has(RealityCard.title);
    this.#reality = { card, sections: effects };
    this.#showGhost();
    // What people try first stands first: the world's faults, then the planner in the order of the method.
    const others = groups
      .filter(({ table }) => !table.startsWith('reality'))
      .flatMap(mountOf)
      .sort((a, b) => Number(a.table.startsWith('planner')) - Number(b.table.startsWith('planner')))
      .map(section);
    this.#sections = [...effects, ...others];
    this.#list.replaceChildren(card.element, ...others.map(({ element }) => element));
    if (focused) document.getElementById(focused)?.focus();
    this.#find();
  }

  #openTitles(): string[] {
    const own = this.#reality?.card.element.open ? [RealityCard.title] : [];
    return [...own, ...this.#sections.filter(({ element }) => element.open).map(({ group }) => group.title)];
  }

  #section(group: ParameterGroup, open: boolean): Section {
    const count = html('span', 'parameter-count');
    const fields = group.parameters.map(
      (parameter) =>
        new ParameterField(group.table, parameter, {
          change: (value) => void this.#change(group.table, parameter.name, value),
        }),
    );
    const element = html('details', 'parameter-group', [
      html('summary', '', [
        ...(isEffects(group) ? RealityCard.heading(group) : [html('h3', '', [group.title])]),
        count,
      ]),
      ...presetButtons(group, (mount) => void this.#mount(mount, group)),
      ...fields.map((field) => field.element),
    ]);
    element.open = open;
    return { group, element, count, fields };
  }

  async #change(table: string, name: string, value: OverrideValue | undefined): Promise<void> {
    const path = `${table}.${name}`;
    const { info } = this.#app;
    if (!info) return;
    if (path === LEARNING_MODE) {
      const learning = (value ?? 'fixed') as Learning;
      this.#app.attempt(this.#app.change({ learning }));
      return;
    }
    await this.#apply(withOverride(info.overrides, table, name, value), path);
  }

  async #chooseReality(preset: string): Promise<void> {
    const overrides = this.#app.info?.overrides;
    if (overrides) await this.#apply(withReality(overrides, preset), undefined);
  }

  /** Its preset and its learning, with nothing of the planner changed. */
  async #asWritten(): Promise<void> {
    this.#app.touch();
    const { planner: _, ...overrides } = this.#app.info?.overrides ?? {};
    await this.#app.adjust({ preset: 'paper', learning: 'every_scan', overrides });
  }

  #showGhost(): void {
    this.#reality?.card.ghost(this.#compare.stateOf(IDEAL_RIVAL));
  }

  /** Mounts the sensor anew; what else was changed stays. */
  async #mount(mount: MountPreset, group: ParameterGroup): Promise<void> {
    const overrides = this.#app.info?.overrides;
    if (overrides) await this.#apply(withMount(overrides, mount, group), undefined);
  }

  /** Tries other values; a message of the core is shown at the field it speaks of, and nothing changes. */
  async #apply(overrides: Overrides, path: string | undefined): Promise<void> {
    try {
      this.#app.touch();
      await this.#app.adjust({ overrides });
    } catch (error) {
      const message = messageOf(error).replace(/^settings: /, '');
      const groups = this.#sections.map(({ group }) => group);
      const about = complaintAbout(message, groups) ?? path;
      const field = this.#sections.flatMap(({ fields }) => fields).find((one) => one.path === about);
      if (field) field.complain(message);
      else this.#complain(message);
    }
  }

  #complain(message: string | undefined): void {
    setText(this.#fault, message ?? '');
    this.#fault.hidden = message === undefined;
  }

  #find(): void {
    const words = this.#search.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const { element, fields } of this.#sections) {
      const found = fields.filter((field) => field.matches(words));
      for (const field of fields) field.element.hidden = !found.includes(field);
      element.hidden = found.length === 0;
      if (words.length > 0) element.open = true;
    }
    if (!this.#reality) return;
    const { card, sections } = this.#reality;
    card.element.hidden = sections.every(({ element }) => element.hidden);
    if (words.length > 0) card.element.open = true;
  }
}
