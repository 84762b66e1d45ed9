/** What an experiment has that the scenario it is named after has not: for files, which are to say what was run. */

import { crc32 } from '@foxglove/crc';
import { type Experiment, FIRST_SETUP, tidyGoal, tidyHeading, tidyPlace } from './experiment.ts';
import { assignmentsOf, literal } from './overrides.ts';

/** In the words of a scenario file, one change each; planner and seed are no changes. Without a scenario, the terrain is one. */
export function changesOf(experiment: Experiment, scenario: Experiment | undefined): readonly string[] {
  const { strokes, objects, start, waypoints, goal, learning, overrides, terrain } = experiment;
  const changed = (part: (of: Experiment) => unknown) =>
    scenario !== undefined && JSON.stringify(part(experiment)) !== JSON.stringify(part(scenario));
  const places = waypoints.map(({ x, y }) => `[${x}, ${y}]`).join(', ');
  const changes: [is: boolean, words: string][] = [
    [scenario === undefined || changed((of) => of.terrain), terrainWords(terrain)],
    [strokes.length > 0, `${strokes.length} ${strokes.length === 1 ? 'stroke' : 'strokes'} on the ground`],
    [changed((of) => of.objects), `${objects?.length ?? 0} ${objects?.length === 1 ? 'object' : 'objects'} in all`],
    [changed((of) => tidyHeading(of.start)), `start = ${literal(Object.values(start))}`],
    [changed((of) => of.waypoints.map(tidyPlace)), `waypoints = [${places}]`],
    [changed((of) => tidyGoal(of.goal)), `goal = ${literal(Object.values(goal))}`],
    [learning !== FIRST_SETUP.learning, `learning = "${learning}"`],
    ...assignmentsOf(overrides).map((words): [boolean, string] => [true, words]),
  ];
  return changes.flatMap(([is, words]) => (is ? [words] : []));
}

function terrainWords(terrain: Experiment['terrain']): string {
  if ('catalogue' in terrain) return `terrain = "${terrain.catalogue}"`;
  if ('recipe' in terrain) return 'a terrain of its own';
  return `terrain = "${terrain.generated.difficulty}", seed ${terrain.generated.seed}`;
}

/** Eight digits that another experiment has by chance alone. */
export function hashOf(experiment: Experiment): string {
  return crc32(new TextEncoder().encode(JSON.stringify(experiment)))
    .toString(16)
    .padStart(8, '0');
}
