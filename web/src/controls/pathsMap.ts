/** A map of the ways that a campaign's planners take on one route, each driven again in the background. */

import { button, html, setText, svg } from '../base/dom.ts';
import { readTheme } from '../colours/theme.ts';
import { RIVALS } from '../lab/planners.ts';
import type { Solid } from '../protocol/simulationProtocol.ts';
import { type CampaignRow, nameOf } from '../trials/campaignRows.ts';
import { type RunningJob, startJob } from '../trials/trialsClient.ts';
import { type Course, type FromTrials, type Rider, ROW } from '../trials/trialsProtocol.ts';
import { drawRelief } from './reliefPicture.ts';

/** More lines are told apart by nobody. */
const MOST = 8;
/** Of variants, after the planners' own colours. */
const COLOURS = ['#c2185b', '#17becf', '#8c564b', '#111111'];
/** To their end. */
const ALL = 1e9;

/** A route as the view has it. */
export interface Scene {
  readonly course: Course;
  readonly solids: readonly Solid[];
}

/** One planner's first seed on the route. */
interface Way {
  readonly row: CampaignRow;
  readonly line: SVGPolylineElement;
  readonly said: HTMLElement;
  points: string;
}

export class PathsMap {
  readonly element = html('section', 'paths');
  readonly #rows: readonly CampaignRow[];
  readonly #scene: (route: string) => Promise<Scene>;
  readonly #route = html('select');
  readonly #draw = button('plain', 'Draw the paths', () => void this.#begin());
  readonly #note = html('p', 'sheet-note');
  readonly #map = html('div', 'paths-map');
  readonly #legend = html('ul', 'paths-legend');
  #jobs: RunningJob[] = [];
  #ways = new Map<string, Way>();

  constructor(rows: readonly CampaignRow[], scene: (route: string) => Promise<Scene>) {
    [this.#rows, this.#scene] = [rows.filter(({ rider }) => typeof rider !== 'string'), scene];
    const routes = [...new Set(this.#rows.map(({ route }) => route))];
    this.#route.append(...routes.map((route) => new Option(route, route)));
    this.#note.setAttribute('role', 'status');
    const choice = html('div', 'row', [
      html('label', 'field', [html('span', '', ['Route']), this.#route]),
      this.#draw,
      this.#note,
    ]);
    this.element.append(choice, html('div', 'paths-drawn', [this.#map, this.#legend]));
    this.element.hidden = routes.length === 0;
    this.#map.hidden = true;
  }

  /** Ends what is still driven. */
  stop(): void {
    for (const job of this.#jobs) job.stop();
    this.#jobs = [];
  }

  async #begin(): Promise<void> {
    this.stop();
    this.#draw.disabled = true;
    try {
      const { course, solids } = await this.#scene(this.#route.value);
      const first = firstOfEach(this.#rows.filter(({ route }) => route === this.#route.value));
      this.#show(course, solids, first.slice(0, MOST));
      setText(this.#note, first.length > MOST ? `The first ${MOST} of ${first.length}.` : '');
      for (const seed of new Set([...this.#ways.values()].map(({ row }) => row.seed))) this.#start(course, seed);
    } catch (error) {
      setText(this.#note, String(error));
    }
    this.#draw.disabled = false;
  }

  #start(course: Course, seed: number): void {
    const riders = [...this.#ways.values()].flatMap(({ row }) => (row.seed === seed ? [row.rider as Rider] : []));
    const job = startJob({ type: 'ghosts', course, riders, seed }, (message) => this.#hear(message));
    job.send({ type: 'until', tick: ALL });
    this.#jobs.push(job);
  }

  #show({ ground, start, goal }: Course, solids: readonly Solid[], rows: readonly CampaignRow[]): void {
    const { columns, cell_m } = ground;
    const canvas = html('canvas');
    drawRelief(canvas, { ground: { ...ground }, solids: [...solids] }, readTheme());
    const [width_m, height_m] = [columns * cell_m, ground.rows * cell_m];
    const over = svg('svg', { viewBox: `${-cell_m / 2} ${cell_m / 2 - height_m} ${width_m} ${height_m}`, role: 'img' });
    over.setAttribute('aria-label', `Paths on ${this.#route.value}, from above, north up`);
    const radius = width_m / 90;
    over.append(
      svg('circle', { class: 'paths-start', cx: start.x, cy: -start.y, r: radius }),
      svg('circle', { class: 'paths-goal', cx: goal.x, cy: -goal.y, r: radius }),
    );
    const free = [...COLOURS];
    const used = new Set<string>();
    this.#ways = new Map(
      rows.map((row) => {
        const own = RIVALS.find(({ planner }) => planner === row.planner)?.colour;
        const colour = (own && !used.has(own) ? own : free.shift()) ?? '#7f7f7f';
        used.add(colour);
        const line = svg('polyline', { stroke: colour, class: 'paths-line' });
        over.append(line);
        return [nameOf(row), { row, line, said: html('span', 'paths-said', ['driving']), points: '' }];
      }),
    );
    this.#legend.replaceChildren(
      ...[...this.#ways].map(([name, { row, line, said }]) => {
        const swatch = html('i', 'swatch');
        swatch.style.setProperty('--swatch', line.getAttribute('stroke') ?? '');
        return html('li', '', [swatch, `${name}, seed ${row.seed}: `, said]);
      }),
    );
    this.#map.replaceChildren(canvas, over);
    this.#map.hidden = false;
  }

  #hear(message: FromTrials): void {
    if (message.type === 'ghost') {
      const { planner, outcome, digest } = message.result;
      const way = this.#ways.get(planner);
      if (!way) return;
      way.points += pointsOf(message.rows);
      way.line.setAttribute('points', way.points);
      if (outcome === 'running') return;
      const same =
        way.row.digest === '' ? '' : digest === way.row.digest ? ', as in the table' : ', not as in the table';
      setText(way.said, `${outcome.replaceAll('_', ' ')}${same}`);
    } else if (message.type === 'refused') {
      const way = this.#ways.get(message.planner);
      if (way) setText(way.said, message.message);
    } else if (message.type === 'failed') setText(this.#note, message.message);
  }
}

/** Each planner and variant with its lowest seed. */
function firstOfEach(rows: readonly CampaignRow[]): readonly CampaignRow[] {
  const first = new Map<string, CampaignRow>();
  for (const row of rows) {
    const before = first.get(nameOf(row));
    if (!before || row.seed < before.seed) first.set(nameOf(row), row);
  }
  return [...first.values()];
}

/** North is up, where y goes down. */
function pointsOf(rows: Float64Array): string {
  const [stride, x, y] = [ROW.length, ROW.indexOf('x'), ROW.indexOf('y')];
  let points = '';
  for (let at = 0; at + stride <= rows.length; at += stride)
    points += `${(rows[at + x] ?? 0).toFixed(2)},${(-(rows[at + y] ?? 0)).toFixed(2)} `;
  return points;
}
