/** The scenarios and terrains that come with the page, and what each one shows. */

import { FAMILIES } from './experiment.ts';

export interface CatalogueEntry {
  readonly id: string;
  readonly group: string;
  readonly title: string;
  /** What to watch for. */
  readonly lesson: string;
}

const HILLS = 'Challenging hilly terrain';

/** In the order in which the page goes through them. */
export const CATALOGUE: readonly CatalogueEntry[] = [
  {
    id: 'cht-ad',
    group: HILLS,
    title: 'A to D',
    lesson: 'The straight line is too steep: the robot leaves it and finds a pass.',
  },
  {
    id: 'ml',
    group: 'Martian landscape',
    title: 'Among craters',
    lesson: 'Rims and hills everywhere: watch it choose the gaps between them.',
  },
  {
    id: 'vta',
    group: 'Valley trail ascent',
    title: 'Up the trail',
    lesson: 'Two tight bends, where a planner without memory would waver.',
  },
  {
    id: 'gsb',
    group: 'Gentle slope bypass',
    title: 'Around, then up',
    lesson: 'It passes the hill until the slope is gentle enough to climb.',
  },
  { id: 'ht', group: 'Hilly terrain', title: 'Past the hill', lesson: 'A short drive with one hill to avoid.' },
  {
    id: 'cht-ab',
    group: HILLS,
    title: 'A to B',
    lesson: 'A longer path with less roll beats the short one along the flank.',
  },
  { id: 'cht-ac', group: HILLS, title: 'A to C', lesson: 'Which of the three valleys? The skyline decides.' },
  { id: 'cht-ae', group: HILLS, title: 'A to E', lesson: 'The far corner: many choices, one safe chain of subgoals.' },
  {
    id: 'cht-ba',
    group: HILLS,
    title: 'B to A',
    lesson: 'The return is a different problem: other slopes face the robot.',
  },
  {
    id: 'cht-bd',
    group: HILLS,
    title: 'B to D',
    lesson: 'Skirting the hill tilts the robot; climbing it gently does not.',
  },
];

/** At hand: fetching two of them, one after the other, would delay the first scenario. */
const texts = import.meta.glob<string>(['../../../terrains/*.toml', '../../../terrains/scenarios/*.toml'], {
  query: '?raw',
  import: 'default',
  eager: true,
});
const prefix = '../../../terrains/';

/** The text of a file under `terrains/`, with the folders `.` and `..` of its path resolved. */
export function terrainFile(path: string): string {
  const text = texts[prefix + resolve(path)];
  if (text === undefined) throw new Error(`There is no file terrains/${resolve(path)} in this page.`);
  return text;
}

function resolve(path: string): string {
  const parts: string[] = [];
  for (const part of path.split('/')) {
    if (part === '..') parts.pop();
    else if (part !== '.' && part !== '') parts.push(part);
  }
  return parts.join('/');
}

/** Names like those of generated tasks; the core says what is wrong with one. */
export const TASK = new RegExp(`^(${FAMILIES.join('|')})-\\d`);

/** Whether a scenario comes with the page, or is drawn by it. */
export function isKnown(name: string): boolean {
  return CATALOGUE.some(({ id }) => id === name) || TASK.test(name);
}

export function entry(id: string): CatalogueEntry {
  const task = {
    id,
    group: 'Generated task',
    title: id,
    lesson: 'Drawn by seed: nobody shaped it for a planner, and a safe path exists.',
  };
  const own = { id, group: 'Scenario', title: id, lesson: '' };
  return CATALOGUE.find((one) => one.id === id) ?? (TASK.test(id) ? task : own);
}

/** The scenario after `id`, going round. */
export function following(id: string): CatalogueEntry {
  const index = CATALOGUE.findIndex((one) => one.id === id);
  const next = CATALOGUE[(index + 1) % CATALOGUE.length];
  if (!next) throw new Error('The catalogue of scenarios is empty.');
  return next;
}
