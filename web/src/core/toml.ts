/** An experiment as the files that the command line reads. The page's own core reads the same text. */

import type { Experiment, Overrides, OverrideValue, Stroke } from './experiment.ts';

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

/** The scenario of an experiment whose terrain is in the file `terrain`. */
export function scenarioFile(experiment: Experiment, terrain: string): string {
  const { start, goal, seed, preset, learning, overrides } = experiment;
  const lines = [
    '# Runs as in the page with',
    `#   mapless run scenario.toml --planner ${preset} --learning ${learning}`,
    `terrain = ${JSON.stringify(terrain)}`,
    `start = [${start.x}, ${start.y}, ${start.heading_rad}]`,
    `goal = [${goal.x}, ${goal.y}]`,
    `seed = ${seed}`,
  ];
  for (const [name, table] of Object.entries(overrides)) lines.push(...tableLines(name, table as Overrides));
  return `${lines.join('\n')}\n`;
}

/** A table with its inner tables after its values, as TOML wants it. */
function tableLines(path: string, table: Overrides): string[] {
  const entries = Object.entries(table);
  const values = entries.filter(([, value]) => !isTable(value)).map(([key, value]) => `${key} = ${literal(value)}`);
  const own = values.length > 0 ? ['', `[${path}]`, ...values] : [];
  const inner = entries.flatMap(([key, value]) => (isTable(value) ? tableLines(`${path}.${key}`, value) : []));
  return [...own, ...inner];
}

function isTable(value: OverrideValue): value is Overrides {
  return typeof value === 'object' && !Array.isArray(value);
}

function literal(value: OverrideValue): string {
  if (Array.isArray(value)) return `[${value.map(literal).join(', ')}]`;
  if (isTable(value))
    return `{ ${Object.entries(value)
      .map(([key, one]) => `${key} = ${literal(one)}`)
      .join(', ')} }`;
  return JSON.stringify(value);
}
