/** The control of one parameter: a number, two numbers, a switch or a choice, with what it means and a way back. */

import { html, setText } from '../base/dom.ts';
import { degrees } from '../base/format.ts';
import type { OverrideValue } from '../experiment/overrides.ts';
import { label, type Parameter, shown } from '../experiment/parameters.ts';

export interface FieldEvents {
  /** The value somebody chose; nothing for the default. */
  change(value: OverrideValue | undefined): void;
}

type Input = HTMLInputElement | HTMLSelectElement;

export class ParameterField {
  readonly element: HTMLElement;
  readonly path: string;
  readonly #parameter: Parameter;
  readonly #inputs: readonly Input[];
  readonly #reset = html('button', 'plain field-reset', ['Reset']);
  readonly #angle = html('span', 'parameter-unit');
  readonly #unusual = html('p', 'parameter-unusual', ['Outside what is usual: it is taken as it stands.']);
  readonly #fault = html('p', 'parameter-fault');
  readonly #words: string;
  /** What holds; the fields may show it rounded. */
  #values: readonly (number | string | boolean)[] = [];

  constructor(table: string, parameter: Parameter, events: FieldEvents) {
    this.path = `${table}.${parameter.name}`;
    this.#parameter = parameter;
    this.#words = `${table} ${parameter.name} ${label(parameter.name)} ${parameter.text}`.toLowerCase();
    this.#inputs = makeInputs(parameter, this.path);
    for (const input of this.#inputs) {
      input.setAttribute('aria-describedby', `${this.path}-text ${this.path}-fault`);
      input.addEventListener('change', () => this.#changed(events));
    }
    this.#reset.type = 'button';
    this.#reset.setAttribute('aria-label', `Reset ${label(parameter.name)}`);
    this.#reset.addEventListener('click', () => {
      events.change(undefined);
      this.#inputs[0]?.focus();
    });
    this.#fault.id = `${this.path}-fault`;
    this.#fault.setAttribute('role', 'alert');
    this.#fault.hidden = true;
    const name = html('label', 'parameter-name', [label(parameter.name)]);
    name.htmlFor = this.#inputs[0]?.id ?? '';
    name.title = this.path;
    const unit = html('span', 'parameter-unit', [parameter.unit]);
    const controls = html('div', 'parameter-controls', [...this.#inputs, unit, this.#angle, this.#reset]);
    const text = html('p', 'parameter-text', [parameter.text]);
    text.id = `${this.path}-text`;
    this.element = html('div', 'parameter', [
      name,
      controls,
      text,
      html('p', 'parameter-facts', [facts(parameter)]),
      this.#unusual,
      this.#fault,
    ]);
    this.show(undefined);
  }

  /** Whether a search finds it. */
  matches(words: readonly string[]): boolean {
    return words.every((word) => this.#words.includes(word));
  }

  /** Shows the value that holds; nothing for the default. */
  show(value: OverrideValue | undefined): void {
    const now = value ?? this.#parameter.value;
    const values = Array.isArray(now) ? now : [now];
    for (const [index, input] of this.#inputs.entries()) {
      if (input instanceof HTMLInputElement && input.type === 'checkbox') input.checked = now === true;
      else input.value = written(values[index] ?? '', this.#parameter);
    }
    this.#values = values;
    this.#reset.hidden = value === undefined;
    this.element.classList.toggle('is-changed', value !== undefined);
    const { unit, range } = this.#parameter;
    // More than a turn is no angle that anybody reads in degrees.
    const turns = unit === 'rad' && values.every((angle) => Math.abs(Number(angle)) <= 2 * Math.PI);
    setText(this.#angle, turns ? `(${values.map((angle) => degrees(Number(angle), 1)).join(', ')})` : '');
    const [low, high] = range ?? [Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY];
    const unusual = values.some((one) => typeof one === 'number' && (one < low || one > high));
    this.#unusual.hidden = !unusual;
    this.complain(undefined);
  }

  /** The core's message, at the field; nothing takes it away. */
  complain(message: string | undefined): void {
    setText(this.#fault, message ?? '');
    this.#fault.hidden = message === undefined;
    for (const input of this.#inputs) input.setAttribute('aria-invalid', String(message !== undefined));
  }

  focus(): void {
    this.#inputs[0]?.focus();
    this.element.scrollIntoView({ block: 'nearest' });
  }

  #changed(events: FieldEvents): void {
    const values = this.#inputs.map((input, index) => this.#read(input, this.#values[index]));
    const bad = values.find((value) => typeof value === 'number' && !Number.isFinite(value));
    if (bad !== undefined) {
      this.complain('Expected a number.');
      return;
    }
    const value = this.#parameter.kind === 'pair' ? values.map(Number) : values[0];
    const own = JSON.stringify(value) === JSON.stringify(this.#parameter.value);
    events.change(own ? undefined : value);
  }

  /** What somebody entered; a number that reads like the one that holds, or like an end of the range, is that one. */
  #read(input: Input, held: number | string | boolean | undefined): number | string | boolean {
    const exact = [held, ...(this.#parameter.range ?? [])];
    const meant = exact.find((one) => typeof one === 'number' && written(one, this.#parameter) === input.value);
    return meant ?? read(input, this.#parameter);
  }
}

/** What a field holds for a value. */
function written(value: number | string | boolean, { unit }: Parameter): string {
  return typeof value === 'number' ? shown(value, unit) : String(value);
}

function read(input: Input, { kind }: Parameter): number | string | boolean {
  if (kind === 'switch' && input instanceof HTMLInputElement) return input.checked;
  return kind === 'choice' ? input.value : input.value.trim() === '' ? Number.NaN : Number(input.value);
}

function makeInputs(parameter: Parameter, path: string): Input[] {
  if (parameter.kind === 'choice') {
    const select = html('select');
    select.id = path;
    for (const name of parameter.choices ?? []) {
      const option = html('option', '', [shown(name)]);
      option.value = name;
      select.append(option);
    }
    return [select];
  }
  const numbers = parameter.kind === 'pair' ? ['first', 'second'] : ['only'];
  return numbers.map((which) => {
    const input = html('input');
    input.id = which === 'second' ? `${path}-second` : path;
    input.type = parameter.kind === 'switch' ? 'checkbox' : 'number';
    if (input.type === 'number') {
      input.step = parameter.kind === 'whole' ? '1' : 'any';
      input.inputMode = 'decimal';
      if (which === 'second') input.setAttribute('aria-label', `${label(parameter.name)}, second value`);
    }
    return input;
  });
}

/** What is usual, what holds by itself and what the paper says, in one line. */
function facts({ value, paper, presets, range, unit }: Parameter): string {
  const papers = paper === undefined ? 'paper: not given' : `paper ${shown(paper, unit)}`;
  const given =
    presets.length > 0
      ? presets.map((one) => `${one.preset} ${shown(one.value, unit)}`)
      : [`default ${shown(value, unit)}`, papers];
  const usual = range ? [`usual ${range.map((end) => shown(end, unit)).join(' to ')}`] : [];
  const line = [...given, ...usual].join(' · ');
  return line.charAt(0).toUpperCase() + line.slice(1);
}
