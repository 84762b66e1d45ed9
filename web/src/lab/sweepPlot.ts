/** What a parameter buys: how often the goal is reached with each value, with Wilson's 95 % interval, and one metric, mean ± deviation. */

import { html, svg } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import type { MetricRow } from '../measurements/metrics.ts';
import type { Summary } from '../trials/trialsProtocol.ts';

const [WIDTH, HEIGHT, LEFT, RIGHT] = [400, 110, 52, 12];
const [TOP, BOTTOM] = [8, 22];

interface Mark {
  readonly middle: number;
  readonly low: number;
  readonly high: number;
}

/** `summaries` are in the order of the values; nothing for one that is still to come. */
export function sweepPlot(
  values: readonly number[],
  summaries: readonly (Summary | undefined)[],
  metric: MetricRow,
): HTMLElement {
  const reached = summaries.map((one) => one && { middle: one.reached / one.trials, low: one.low, high: one.high });
  const means = summaries.map((one) => {
    const spread = one?.metrics[metric.key];
    if (!spread || !Number.isFinite(spread.mean)) return undefined;
    const half = Number.isFinite(spread.deviation) ? spread.deviation : 0;
    return { middle: spread.mean, low: spread.mean - half, high: spread.mean + half };
  });
  const ends = means.flatMap((mark) => (mark ? [mark.low, mark.high] : []));
  const span: [number, number] = ends.length > 0 ? [Math.min(0, ...ends), Math.max(...ends)] : [0, 1];
  return html('div', 'sweep-plot', [
    html('p', 'lab-note', ['Goal reached, with 95 % interval']),
    panel(values, reached, [0, 1], (share) => `${fixed(100 * share, 0)} %`),
    html('p', 'lab-note', [`${metric.name}, ${metric.unit}: mean ± deviation of the trials that reached it`]),
    panel(values, means, span, (value) => fixed(value, metric.decimals)),
  ]);
}

function panel(
  values: readonly number[],
  marks: readonly (Mark | undefined)[],
  [low, high]: [number, number],
  words: (value: number) => string,
): SVGSVGElement {
  const x = (index: number) => LEFT + ((index + 0.5) / values.length) * (WIDTH - LEFT - RIGHT);
  const y = (value: number) => TOP + (1 - (value - low) / Math.max(high - low, 1e-9)) * (HEIGHT - TOP - BOTTOM);
  const grid = [low, high].flatMap((value) => [
    svg('line', { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), class: 'sweep-grid' }),
    svg('text', { x: LEFT - 6, y: y(value) + 4, class: 'sweep-words sweep-end' }, [words(value)]),
  ]);
  const drawn = values.flatMap((value, index) => {
    const label = svg('text', { x: x(index), y: HEIGHT - 6, class: 'sweep-words sweep-middle' }, [String(value)]);
    const mark = marks[index];
    if (!mark) return [label];
    const whole = `${value}: ${words(mark.middle)} (${words(mark.low)} to ${words(mark.high)})`;
    return [
      label,
      svg('line', { x1: x(index), x2: x(index), y1: y(mark.low), y2: y(mark.high), class: 'sweep-interval' }),
      svg('circle', { cx: x(index), cy: y(mark.middle), r: 4, class: 'sweep-dot' }, [svg('title', {}, [whole])]),
    ];
  });
  const said = values.map((value, index) => `${value}: ${marks[index] ? words(marks[index].middle) : 'to come'}`);
  const attributes = { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img', 'aria-label': said.join('; ') };
  return svg('svg', attributes, [...grid, ...drawn]);
}
