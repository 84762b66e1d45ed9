/** The drawing of the plots: five bands over one time axis, as SVG that the style sheet colours. */

import { html, setText, svg } from '../base/dom.ts';
import { clock, fixed } from '../base/format.ts';
import type { RunRecord } from '../run/record.ts';
import { SERIES, type Series, sample } from './series.ts';
import { levels, type Span, ticks } from './span.ts';

/** What a quantity is held against, in the unit of its series. */
export interface Reference {
  /** The robot's limit on either side. */
  readonly limit?: number;
  /** The mean that the paper reports for this route. */
  readonly paper?: number;
}

export type References = Partial<Record<Series['key'], Reference>>;

/** At the left there is room for numbers. */
const MARGIN = { left: 32, right: 4, axis: 18 };
const HEAD = 17;
/** Room above the largest value in sight. */
const HEADROOM = 1.12;
/** From this share of it on, a limit is in sight, too: a smaller angle would be a flat line under it. */
const NEAR = 0.7;
/** Height for each number of an axis. */
const LEVEL_PX = 22;

interface Band {
  readonly series: Series;
  readonly value: SVGTextElement;
  readonly name: SVGTextElement;
  /** The limit, in sight or not, or the largest value in sight, after the name. */
  readonly bound: SVGTSpanElement;
  readonly line: SVGPathElement;
  readonly marks: SVGGElement;
  readonly dot: SVGCircleElement;
  /** From a value to its height in the drawing, since the last `show`. */
  y: (value: number) => number;
}

export class PlotFigure {
  readonly svg = svg('svg', { class: 'plots-figure', 'aria-hidden': 'true' });
  readonly #bands: Band[];
  readonly #axis = svg('g', { class: 'plot-axis' });
  readonly #cursor = svg('path', { class: 'plot-cursor' });
  #width = 0;
  #height = 0;
  #span: Span = { from_s: 0, to_s: 1 };

  constructor() {
    this.#bands = SERIES.map((series) => {
      const bound = svg('tspan', { class: 'plot-bound', dx: 6 });
      const band: Band = {
        series,
        value: svg('text', { class: 'plot-value', 'text-anchor': 'end' }),
        name: svg('text', { x: MARGIN.left }, [series.name, bound]),
        bound,
        line: svg('path', { class: 'plot-line' }),
        marks: svg('g'),
        dot: svg('circle', { class: 'plot-dot', r: 3 }),
        y: () => 0,
      };
      this.svg.append(svg('g', {}, [band.name, band.value, band.marks, band.line, band.dot]));
      return band;
    });
    this.svg.append(this.#axis, this.#cursor);
  }

  resize(width: number, height: number): void {
    this.#width = width;
    this.#height = height;
    this.svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  }

  /** Time at a distance from the left edge. */
  timeAt(x: number): number {
    const { from_s, to_s } = this.#span;
    return from_s + ((x - MARGIN.left) / (this.#width - MARGIN.left - MARGIN.right)) * (to_s - from_s);
  }

  #x(time_s: number): number {
    const { from_s, to_s } = this.#span;
    const width = this.#width - MARGIN.left - MARGIN.right;
    return MARGIN.left + ((time_s - from_s) / Math.max(to_s - from_s, 1e-9)) * width;
  }

  show(record: RunRecord, span: Span, references: References): void {
    this.#span = span;
    const begin = Math.max(record.at(span.from_s) - 1, 0);
    const end = Math.min(record.at(span.to_s) + 2, record.length);
    const each = (this.#height - MARGIN.axis) / this.#bands.length;
    this.#bands.forEach((band, index) => {
      const { limit, paper } = references[band.series.key] ?? {};
      const top = index * each + HEAD;
      const bottom = (index + 1) * each - 5;
      const { points, lowest, highest } = sample(record, band.series, begin, end, this.#width);
      const largest = Math.max(highest, limit === undefined ? 0 : -lowest);
      const near = limit !== undefined && largest > NEAR * limit;
      const most = Math.max(largest, near ? limit : 0, paper ?? 0, band.series.little);
      const reach = HEADROOM * most;
      const least = limit === undefined ? 0 : -reach;
      band.y = (value) => bottom - ((value - least) / (reach - least)) * (bottom - top);
      for (const text of [band.name, band.value]) text.setAttribute('y', (top - 5).toFixed(1));
      band.value.setAttribute('x', String(this.#width - MARGIN.right));
      band.line.setAttribute('d', this.#path(points, band.y));
      const numbers = levels(least, reach, (bottom - top) / LEVEL_PX);
      band.marks.replaceChildren(
        ...this.#levels(band.y, numbers),
        ...this.#marks(band.y, near ? limit : undefined, paper),
      );
      setText(band.bound, boundText(band.series, limit, highest));
    });
    this.#drawAxis();
  }

  /** The cursor and the readings at a row of the record; without a row, neither. */
  point(record: RunRecord, row: number, marked: boolean): void {
    const time_s = record.get(row, 'time_s');
    const x = this.#x(time_s);
    const inside = marked && x >= MARGIN.left && x <= this.#width - MARGIN.right;
    this.#cursor.setAttribute('d', inside ? `M ${x.toFixed(1)} 0 V ${this.#height - MARGIN.axis}` : '');
    for (const band of this.#bands) {
      const value = band.series.value(record, row);
      setText(band.value, row < 0 ? '' : reading(band.series, value));
      const drawn = inside && Number.isFinite(value);
      band.dot.setAttribute('visibility', drawn ? 'visible' : 'hidden');
      if (!drawn) continue;
      band.dot.setAttribute('cx', x.toFixed(1));
      band.dot.setAttribute('cy', band.y(value).toFixed(1));
    }
  }

  #path(points: readonly number[], y: (value: number) => number): string {
    let path = '';
    let pen = 'M';
    for (let at = 0; at < points.length; at += 2) {
      const value = points[at + 1] ?? Number.NaN;
      if (Number.isNaN(value)) pen = 'M';
      else {
        path += `${pen}${this.#x(points[at] ?? 0).toFixed(1)} ${y(value).toFixed(1)}`;
        pen = 'L';
      }
    }
    return path;
  }

  /** Numbers beside the plot, and faint lines at them. */
  #levels(y: (value: number) => number, values: readonly number[]): SVGElement[] {
    const step = (values[1] ?? 1) - (values[0] ?? 0);
    const decimals = Math.max(Math.ceil(-Math.log10(step) - 1e-9), 0);
    return values.flatMap((value) => {
      const at = y(value).toFixed(1);
      return [
        svg('path', { class: 'plot-level', d: `M ${MARGIN.left} ${at} H ${this.#width - MARGIN.right}` }),
        svg('text', { class: 'plot-number', x: MARGIN.left - 5, y: at, dy: 3.5, 'text-anchor': 'end' }, [
          fixed(value, decimals),
        ]),
      ];
    });
  }

  #marks(y: (value: number) => number, limit: number | undefined, paper: number | undefined): SVGElement[] {
    const line = (value: number, name: string) =>
      svg('path', { class: name, d: `M ${MARGIN.left} ${y(value).toFixed(1)} H ${this.#width - MARGIN.right}` });
    const marks = [line(0, 'plot-zero')];
    if (limit !== undefined) marks.push(line(limit, 'plot-limit'), line(-limit, 'plot-limit'));
    if (paper !== undefined) marks.push(line(paper, 'plot-paper'));
    return marks;
  }

  #drawAxis(): void {
    const bottom = this.#height - MARGIN.axis;
    const marks = ticks(this.#span, this.#width / 70).map((time_s) => {
      const x = this.#x(time_s);
      const anchor = x < 20 ? 'start' : x > this.#width - 20 ? 'end' : 'middle';
      const label = svg('text', { x: x.toFixed(1), y: this.#height - 4, 'text-anchor': anchor }, [axisLabel(time_s)]);
      return svg('g', {}, [svg('path', { d: `M ${x.toFixed(1)} 0 V ${bottom}` }), label]);
    });
    this.#axis.replaceChildren(...marks);
  }
}

export function reading({ decimals, unit }: Series, value: number): string {
  return `${fixed(value, decimals)}${unit === '°' ? unit : ` ${unit}`}`;
}

function boundText(series: Series, limit: number | undefined, highest: number): string {
  if (limit !== undefined) return `limit ${fixed(limit, 0)}°`;
  return Number.isFinite(highest) ? `up to ${reading(series, highest)}` : '';
}

function axisLabel(time_s: number): string {
  const text = clock(time_s);
  return text.endsWith('.0') ? text.slice(0, -2) : text;
}

/** The key of the lines. */
export function plotKey(): HTMLElement {
  return html('p', 'plots-key', [
    html('span', 'plots-key-limit', ['limit']),
    html('span', 'plots-key-paper', ['the paper’s mean']),
  ]);
}
