/** An experiment as the files that the command line reads. The page's own core reads the same text. */

import type { Experiment, Stroke } from './experiment.ts';
import type { WorldObject } from './objects.ts';
import { literal, sectionsOf } from './overrides.ts';

/** The keys of a `[[stroke]]` table. */
export function strokeKeys(stroke: Stroke): string {
  const { kind, radius_m, strength_m, height_m, seed, points_cm } = stroke;
  const points: string[] = [];
  for (let at = 0; at + 1 < points_cm.length; at += 2) {
    points.push(`[${(points_cm[at] ?? 0) / 100}, ${(points_cm[at + 1] ?? 0) / 100}]`);
  }
  const lines = [`kind = "${kind}"`, `radius_m = ${radius_m}`, `strength_m = ${strength_m}`];
  if (height_m !== undefined) lines.push(`height_m = ${height_m}`);
  if (seed !== undefined) lines.push(`seed = ${seed}`);
  return `${[...lines, `points = [${points.join(', ')}]`].join('\n')}\n`;
}

/** A recipe with strokes after all else. */
export function recipeFile(recipe: string, strokes: readonly Stroke[]): string {
  return [recipe.trimEnd(), '', ...strokes.map((stroke) => `\n[[stroke]]\n${strokeKeys(stroke).trimEnd()}\n`)].join(
    '\n',
  );
}

/** The keys of an `[[objects]]` table. */
function objectKeys(object: WorldObject): string[] {
  return Object.entries(object).map(([key, value]) => `${key} = ${literal(value)}`);
}

/** What a scenario file says. */
export type Scenario = Omit<Experiment, 'version' | 'name' | 'terrain' | 'strokes'>;

/** The scenario file of an experiment whose terrain is in the file `terrain`. */
export function scenarioFile(scenario: Scenario, terrain: string): string {
  const { start, waypoints, goal, seed, preset, learning, overrides, objects } = scenario;
  const heading = goal.heading_rad === undefined ? '' : `, ${goal.heading_rad}`;
  const lines = [
    '# Runs as in the page with',
    `#   mapless run scenario.toml --planner ${preset} --learning ${learning}`,
    `terrain = ${JSON.stringify(terrain)}`,
    `start = [${start.x}, ${start.y}, ${start.heading_rad}]`,
    `goal = [${goal.x}, ${goal.y}${heading}]`,
    `seed = ${seed}`,
  ];
  if (waypoints.length > 0) lines.push(`waypoints = [${waypoints.map(({ x, y }) => `[${x}, ${y}]`).join(', ')}]`);
  // None at all is said, too: the terrain may list some.
  if (objects?.length === 0) lines.push('objects = []');
  const sections = sectionsOf(overrides);
  if (sections) lines.push('', sections);
  for (const object of objects ?? []) lines.push('', '[[objects]]', ...objectKeys(object));
  return `${lines.join('\n')}\n`;
}
