/** From scenarios and files to experiments, and from an experiment's terrain to the text that the core reads. */

import { base64, fromBase64 } from '../base/base64.ts';
import { messageOf } from '../base/messageOf.ts';
import { loadHeights } from '../bindings/heightsModule.ts';
import type { Core } from '../bindings/simulationModule.ts';
import { loadTrials } from '../bindings/trialsModule.ts';
import { CATALOGUE, TASK, terrainFile } from '../experiment/catalogue.ts';
import {
  type Experiment,
  type Holes,
  MAX_FILE_BYTES,
  MAX_SEED,
  type Stroke,
  type Terrain,
  VERSION,
} from '../experiment/experiment.ts';
import { readExperiment } from '../experiment/readExperiment.ts';
import { recipeFile, scenarioFile } from '../experiment/scenarioFiles.ts';
import type { Setup } from '../experiment/setting.ts';
import { unzip } from '../files/archive.ts';
import type { Loaded, NamedFile, Source, TerrainPreview } from '../protocol/simulationProtocol.ts';
import type { ScenarioRead, TerrainFiles } from '../wasm/mapless_wasm.js';

const ARCHIVE = /\.zip$/i;
/** What a campaign says and no scenario or recipe does. */
const CAMPAIGN = /^\s*routes\s*=/m;
const GRIDS = /\.(png|asc|tiff?)$/i;
/** Samples along the longer side of a preview. */
const PREVIEW_SAMPLES = 96;
const encoder = new TextEncoder();

const TERRAIN_FILE = 'terrain.toml';

/** The files of a run: the scenario, the recipe with the strokes and, last, the grid that it imports, if it does. */
export function filesOf(core: Core, experiment: Experiment): [NamedFile, NamedFile, ...NamedFile[]] {
  const scenario = encoder.encode(scenarioFile(experiment, TERRAIN_FILE));
  return [{ name: 'scenario.toml', bytes: scenario }, ...filesOfTerrain(core, experiment.terrain, experiment.strokes)];
}

/** What is loaded, and the scenario that it is named after, as that comes; nothing where there is none. */
type Opening = Pick<Loaded, 'experiment' | 'scenario'>;

/** A terrain as the core takes it, and what is to be said of the file that it imports. */
interface ReadTerrain {
  readonly files: TerrainFiles;
  readonly warnings: readonly string[];
}

/** Reads the grid that a recipe imports, if it does. */
export async function readTerrain(
  core: Core,
  [recipe, grid]: readonly [NamedFile, ...NamedFile[]],
): Promise<ReadTerrain> {
  const request = grid && core.import_of(recipe.name, new TextDecoder().decode(recipe.bytes));
  if (!request) return { files: recipe, warnings: [] };
  const { read_heights } = await loadHeights();
  const { cell_m, height_min_m, height_max_m, holes } = request;
  const heights = read_heights(grid.name, grid.bytes, cell_m, height_min_m, height_max_m, holes);
  const { columns, rows, cell_m: spacing_m, warnings } = heights;
  const heights_m = heights.take_heights_m() as Float32Array<ArrayBuffer>;
  heights.free();
  return { files: { ...recipe, imported: { columns, rows, cell_m: spacing_m, heights_m } }, warnings };
}

/** The files of a terrain with strokes. */
function filesOfTerrain(core: Core, terrain: Terrain, strokes: readonly Stroke[]): [NamedFile, ...NamedFile[]] {
  const imported = 'imported' in terrain ? terrain.imported : undefined;
  const recipe = encoder.encode(recipeFile(baseRecipe(core, terrain), strokes));
  return [
    { name: TERRAIN_FILE, bytes: recipe },
    ...(imported ? [{ name: imported.name, bytes: fromBase64(imported.base64) }] : []),
  ];
}

function baseRecipe(core: Core, terrain: Terrain): string {
  if ('catalogue' in terrain) return terrainFile(`${terrain.catalogue}.toml`);
  if ('recipe' in terrain) return terrain.recipe;
  return core.generated_recipe(terrain.generated.difficulty, terrain.generated.seed);
}

/** A small picture's worth of a terrain. */
export async function preview(core: Core, terrain: Terrain): Promise<TerrainPreview> {
  const { files } = await readTerrain(core, filesOfTerrain(core, terrain, []));
  return core.terrain_preview(files, PREVIEW_SAMPLES);
}

export async function openingFrom(core: Core, source: Source): Promise<Opening> {
  if ('scenario' in source) {
    const { scenario: name, setup, seed } = source;
    const { read, terrain } = TASK.test(name) ? await task(core, name) : catalogued(core, name);
    const scenario = fromScenario(read, name, terrain, setup);
    return { experiment: seed === undefined ? scenario : { ...scenario, seed }, scenario };
  }
  const experiment = await experimentFrom(core, source);
  return { experiment, scenario: scenarioOf(core, experiment) };
}

async function experimentFrom(core: Core, source: Exclude<Source, { scenario: string }>): Promise<Experiment> {
  if ('experiment' in source) return source.experiment;
  if ('terrain' in source) return onLevelPlaces(core, source.terrain, source.name, source.setup);
  return fromFiles(core, source.files, source.holes, source.setup);
}

function scenarioOf(core: Core, experiment: Experiment): Experiment | undefined {
  const { name, terrain: own } = experiment;
  // Files of one's own may bear any name.
  if (!('catalogue' in own) || !CATALOGUE.some(({ id }) => id === name)) return undefined;
  const { read, terrain } = catalogued(core, name);
  return fromScenario(read, name, terrain, experiment);
}

function catalogued(core: Core, scenario: string): { read: ScenarioRead; terrain: Terrain } {
  const file = `scenarios/${scenario}.toml`;
  const read = core.read_scenario(file, terrainFile(file));
  return { read, terrain: { catalogue: stem(read.terrain) } };
}

/** A generated task, as `mapless generate` writes it. What the oracle cannot solve is drawn anew, so this needs the oracle. */
async function task(core: Core, name: string): Promise<{ read: ScenarioRead; terrain: Terrain }> {
  const { scenario, recipe } = (await loadTrials()).generated_task(name);
  return { read: core.read_scenario(`${name}.toml`, scenario), terrain: { recipe } };
}

function fromScenario(read: ScenarioRead, name: string, terrain: Terrain, setup: Setup): Experiment {
  if (read.seed > MAX_SEED) throw new Error(`seed = ${read.seed}: expected at most ${MAX_SEED} in this page`);
  return {
    version: VERSION,
    name,
    terrain,
    strokes: [],
    ...(read.objects ? { objects: read.objects } : {}),
    start: read.start,
    waypoints: read.waypoints,
    goal: read.goal,
    seed: read.seed,
    preset: setup.preset,
    learning: setup.learning,
    // What is set in the page stays set, unless the scenario sets parameters itself; a file says all there is to it.
    overrides: Object.keys(read.overrides).length > 0 ? read.overrides : setup.overrides,
  };
}

/** A scenario with the terrain it names, a terrain by itself, or a saved experiment, each also within an archive. */
async function fromFiles(core: Core, given: readonly NamedFile[], holes: Holes, setup: Setup): Promise<Experiment> {
  const archive = given.find(({ name }) => ARCHIVE.test(name));
  const files = given.flatMap((file) => {
    if (!ARCHIVE.test(file.name)) return [file];
    // A grid of the largest size, and what says how to read it.
    limit(file, 2 * MAX_FILE_BYTES);
    return unzip(file, 2 * MAX_FILE_BYTES);
  });
  for (const file of files) limit(file, MAX_FILE_BYTES);
  const all = files.filter(({ name }) => /\.(toml|json)$/i.test(name)).map((file) => ({ ...file, text: text(file) }));
  // Beside a scenario, what the page saves with it for the command line.
  const texts = all.filter((file) => !CAMPAIGN.test(file.text));
  const saved = texts.find(({ name }) => /\.json$/i.test(name));
  if (saved) return readFile(saved.name, saved.text);
  const scenario = texts.find((file) => /^\s*terrain\s*=/m.test(file.text));
  const grid = files.find(({ name }) => GRIDS.test(name));
  const recipe = texts.find((file) => file !== scenario);
  if (scenario) {
    const read = core.read_scenario(scenario.name, scenario.text);
    const own = terrainOf(recipe, grid, holes);
    const terrain = own ?? cataloguedTerrain(scenario.name, read.terrain);
    return fromScenario(read, shortName((archive ?? scenario).name), terrain, { ...setup, overrides: {} });
  }
  const terrain = terrainOf(recipe, grid, holes);
  const [first] = given;
  if (!terrain || !first) {
    const expected =
      'a scenario or recipe (.toml), heights (.png, .asc, .tif), a saved experiment (.json), or a .zip of them; by itself a table of trials (.csv, .parquet), a planner (.js, .wasm) or a recording (.mcap)';
    const found = all.length > texts.length ? 'a campaign, which `mapless trials` drives: ' : '';
    throw new Error(`${first?.name ?? 'Nothing'}: ${found}expected ${expected}`);
  }
  return onLevelPlaces(core, terrain, shortName(recipe?.name ?? first.name), setup);
}

function limit({ name, bytes }: NamedFile, most: number): void {
  if (bytes.length > most) throw new Error(`${name}: ${bytes.length} bytes: expected at most ${most}`);
}

function terrainOf(
  recipe: { name: string; text: string } | undefined,
  grid: NamedFile | undefined,
  holes: Holes,
): Terrain | undefined {
  if (!grid) return recipe ? { recipe: recipe.text } : undefined;
  const name = gridName(grid.name);
  const imported = { name, base64: base64(grid.bytes) };
  // A recipe says how its grid is to be read, but by the file's own name.
  if (recipe) return { recipe: recipe.text.replace(/^(\s*file\s*=\s*).*$/m, `$1"${name}"`), imported };
  const more = holes === 'refuse' ? '' : `holes = "${holes}"\n`;
  return { recipe: `name = ${JSON.stringify(shortName(grid.name))}\n\n[import]\nfile = "${name}"\n${more}`, imported };
}

/** A file of heights keeps its name, as far as documents and archives take it: messages are to name it. */
function gridName(file: string): string {
  const own =
    stem(file)
      .replace(/[^\w .-]+/g, '-')
      .replace(/^\W+/, '')
      .slice(0, 70) || 'terrain';
  return own + (GRIDS.exec(file)?.[0] ?? '').toLowerCase();
}

/** A terrain of the catalogue that a scenario names without its file being there. */
function cataloguedTerrain(scenario: string, path: string): Terrain {
  try {
    terrainFile(`${stem(path)}.toml`);
  } catch (cause) {
    const wanted = `${scenario}: terrain = "${path}": choose that file together with the scenario`;
    throw new Error(wanted, { cause });
  }
  return { catalogue: stem(path) };
}

/** A terrain by itself: start and goal where it is level. */
async function onLevelPlaces(core: Core, terrain: Terrain, name: string, setup: Setup): Promise<Experiment> {
  const { files } = await readTerrain(core, filesOfTerrain(core, terrain, []));
  const { start, goal } = core.level_places(files);
  const heading_rad = Math.round(1000 * Math.atan2(goal.y - start.y, goal.x - start.x)) / 1000;
  const read = { terrain: '', start: { ...start, heading_rad }, waypoints: [], goal, seed: 1, overrides: {} };
  return fromScenario(read, name, terrain, setup);
}

/** A saved experiment, or the result of a run, which holds one. */
function readFile(name: string, json: string): Experiment {
  try {
    const read = JSON.parse(json);
    return readExperiment(read?.run?.experiment ?? read?.experiment ?? read);
  } catch (cause) {
    throw new Error(`${name}: ${messageOf(cause)}`, { cause });
  }
}

function text({ name, bytes }: NamedFile): string {
  try {
    return new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch (cause) {
    throw new Error(`${name}: expected text in UTF-8`, { cause });
  }
}

/** A path's last part without its extension. */
function stem(path: string): string {
  return (path.split(/[/\\]/).pop() ?? '').replace(/\.[^.]*$/, '');
}

function shortName(file: string): string {
  return stem(file).slice(0, 80);
}
