import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readExperiment } from '../src/experiment/readExperiment.ts';
import { recipeFile, scenarioFile, strokeKeys } from '../src/experiment/scenarioFiles.ts';
import { EXPERIMENT, OBJECTS, STROKE } from './example.ts';

/** The document with one part replaced, by the path of its keys. */
function changed(path: readonly (string | number)[], value: unknown): unknown {
  // It is to become what no experiment is.
  const copy = structuredClone(EXPERIMENT) as unknown as Record<string | number, unknown>;
  let part = copy;
  for (const key of path.slice(0, -1)) part = part[key] as Record<string | number, unknown>;
  part[path.at(-1) ?? ''] = value;
  return copy;
}

test('a document is read as it was written', () => {
  assert.deepEqual(readExperiment(JSON.parse(JSON.stringify(EXPERIMENT))), EXPERIMENT);
  const imported = { recipe: 'name = "x"', imported: { name: 'terrain.png', base64: 'AAAA' } };
  assert.deepEqual(readExperiment(changed(['terrain'], imported)), { ...EXPERIMENT, terrain: imported });
  const goal = { x: 14, y: 57, heading_rad: 2.5 };
  assert.deepEqual(readExperiment(changed(['goal'], goal)), { ...EXPERIMENT, goal });
  const generated = { generated: { difficulty: 'hard', seed: 7 } };
  assert.deepEqual(readExperiment(changed(['terrain'], generated)), { ...EXPERIMENT, terrain: generated });
});

const FAULTS: readonly (readonly [path: readonly (string | number)[], value: unknown, message: string])[] = [
  [['version'], 2, 'version = 2: expected 1: this page reads no other version of experiments'],
  [['colour'], 1, 'experiment.colour = 1: expected one of the keys version, name'],
  [['goal'], undefined, 'experiment.goal = absent: expected a value'],
  [['goal', 'heading_rad'], 'east', 'goal.heading_rad = "east": expected a number from -1000 to 1000'],
  [['goal', 'x'], Number.NaN, 'goal.x = NaN: expected a number from -1000000 to 1000000'],
  [['goal', 'heading_rad'], null, 'goal.heading_rad = null: expected a number from -1000 to 1000'],
  [['goal', 'heading'], 1, 'goal.heading = 1: expected one of the keys x, y, heading_rad'],
  [['start', 'heading_rad'], '1', 'start.heading_rad = "1": expected a number'],
  [['seed'], 1.5, 'seed = 1.5: expected a whole number'],
  [['seed'], -1, 'seed = -1: expected a number from 0'],
  [['preset'], 'best', 'preset = "best": expected default or paper'],
  [['terrain'], { catalogue: '../x' }, 'terrain.catalogue = "../x": expected the name of a terrain'],
  [['terrain'], { catalogue: 'cht', recipe: '' }, 'terrain.recipe = "": expected one of the keys catalogue'],
  [['terrain'], { generated: { difficulty: 'wild', seed: 1 } }, 'terrain.generated.difficulty = "wild": expected easy'],
  [['terrain'], { recipe: 'x'.repeat(1_000_001) }, 'terrain.recipe = "1000001 characters": expected at most 1000000'],
  [['terrain'], { recipe: '', imported: { name: 'a/b.png', base64: '' } }, 'terrain.imported.name = "a/b.png"'],
  [
    ['terrain'],
    { recipe: '', imported: { name: 'a.png', base64: '<>' } },
    'terrain.imported.base64 = "<>": expected base64',
  ],
  [['strokes', 0, 'kind'], 'explode', 'strokes[0].kind = "explode": expected raise or lower'],
  [['strokes', 0, 'points_cm', 3], 0.5, 'strokes[0].points_cm[3] = 0.5: expected a whole number'],
  [['strokes', 0, 'points_cm'], [1, 2, 3], 'strokes[0].points_cm = "3 numbers": expected pairs of x and y'],
  [['strokes', 1, 'height_m'], undefined, 'strokes[1].height_m = absent'],
  [['overrides'], { page: {} }, 'overrides.page = {}: expected one of the keys planner, sensor, robot'],
  [['overrides', 'planner', 'decision'], { 'a"\n[x]': 1 }, 'expected a key of letters, digits and _'],
];

for (const [path, value, message] of FAULTS) {
  test(`refused: ${message}`, () => {
    assert.throws(
      () => readExperiment(changed(path, value)),
      (error) => error instanceof Error && error.message.includes(message),
    );
  });
}

test('endless nesting and too many touches are refused', () => {
  let deep: unknown = 1;
  for (let depth = 0; depth < 1000; depth += 1) deep = { deep };
  assert.throws(() => readExperiment(changed(['overrides', 'planner'], deep)), /at most 8 tables within each other/);
  const many = Array.from({ length: 11 }, () => ({ ...STROKE, points_cm: new Array(10_000).fill(0) }));
  assert.throws(() => readExperiment(changed(['strokes'], many)), /strokes = "55000 touches": expected at most 50000/);
  assert.throws(() => readExperiment(null), /version = absent/);
  assert.throws(() => readExperiment('{}'), /version = absent/);
});

test('objects of every kind are read as they were written, and written as the command line reads them', () => {
  const experiment = { ...EXPERIMENT, objects: OBJECTS };
  assert.deepEqual(readExperiment(JSON.parse(JSON.stringify(experiment))), experiment);
  const scenario = scenarioFile(experiment, 'terrain.toml');
  assert.equal(scenario.split('\n[[objects]]\n').length, OBJECTS.length + 1);
  assert.ok(scenario.includes('[[objects]]\nkind = "wall"\nfrom = [1, 2]\nto = [4, 2]\nheight_m = 1\n'), scenario);
  assert.ok(scenario.includes('\nwalk = { path = [[5, 5]], speed_m_s = 0.8 }\n'), scenario);
  // The terrain may list some.
  assert.ok(scenarioFile({ ...EXPERIMENT, objects: [] }, 'terrain.toml').includes('\nobjects = []\n'));
  assert.ok(!scenarioFile(EXPERIMENT, 'terrain.toml').includes('objects'));
});

test('objects that make no sense are refused in words', () => {
  const refused = (object: unknown, why: RegExp) =>
    assert.throws(() => readExperiment({ ...EXPERIMENT, objects: [object] }), why);
  refused({ kind: 'tree' }, /^Error: objects\[0\]\.kind = "tree": expected post or box or rock/);
  refused({ kind: 'rock', at: [1, 2] }, /objects\[0\]\.radius_m = absent/);
  refused({ kind: 'rock', at: [1], radius_m: 1 }, /objects\[0\]\.at = \[1\]: expected 2 numbers/);
  refused({ kind: 'rock', at: [-1, 2], radius_m: 1 }, /objects\[0\]\.at\[0\] = -1: expected a number from 0/);
  refused({ kind: 'rock', at: [1, 2], radius_m: 1, walk: {} }, /objects\[0\]\.walk = \{\}: expected one of the keys/);
  refused({ kind: 'post', at: [1, 2], radius_m: 1, height_m: 1, walk: { path: [], speed_m_s: 1 } }, /1 to 100 points/);
  assert.throws(() => readExperiment({ ...EXPERIMENT, objects: new Array(1001).fill(OBJECTS[0]) }), /at most 1000/);
});

test('strokes and scenarios are written as the command line reads them', () => {
  const points = 'points = [[12.34, 5.6], [12.4, 5.75]]\n';
  assert.equal(strokeKeys(STROKE), `kind = "raise"\nradius_m = 2\nstrength_m = 0.07\n${points}`);
  const recipe = recipeFile('name = "a"\n\n\n', [STROKE, STROKE]);
  assert.equal(recipe.split('[[stroke]]').length, 3);
  assert.ok(recipe.startsWith('name = "a"\n'));
  const scenario = scenarioFile(EXPERIMENT, 'terrain.toml');
  assert.ok(scenario.includes('--planner default --learning fixed'));
  assert.ok(scenario.includes('\ngoal = [14, 57]\n'));
  const turned = scenarioFile({ ...EXPERIMENT, goal: { x: 14, y: 57, heading_rad: 0 } }, 'terrain.toml');
  assert.ok(turned.includes('\ngoal = [14, 57, 0]\n'));
  assert.ok(scenario.includes('\nwaypoints = [[20, 31.5]]\n'));
  const facing = { ...EXPERIMENT, goal: { ...EXPERIMENT.goal, heading_rad: -1.5 } };
  assert.deepEqual(readExperiment(JSON.parse(JSON.stringify(facing))), facing);
  assert.ok(scenarioFile(facing, 'terrain.toml').includes('\ngoal = [14, 57, -1.5]\n'));
  const tables = '\n[planner]\ngoal_tolerance_m = 0.5\n\n[planner.decision]\nsteepness_weight = 0.8\n';
  assert.ok(scenario.includes(tables), scenario);
  assert.ok(scenario.endsWith('\n[sensor]\nrange_noise_m = 0.02\n'));
});
