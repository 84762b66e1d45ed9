/** The sheet that asks which task of a world of Verti-Bench is to be driven. Loaded when such a world is opened. */

import '../style/heights.css';
import { button, html } from '../base/dom.ts';
import { loadVertiBench } from '../bindings/vertiBenchModule.ts';
import type { NamedFile } from '../protocol/simulationProtocol.ts';
import type { VertiBenchTask, VertiBenchWorld } from '../wasm/mapless_wasm_verti_bench.js';

const SCALES = [
  ['1/5', '1/5, for a Husky'],
  ['1', 'full size'],
] as const;

/** The files of the task that somebody chooses; nothing where that is called off. Throws what is wrong with the world's files. */
export async function taskOf(files: readonly NamedFile[]): Promise<NamedFile[] | undefined> {
  const [config, image] = [/\.ya?ml$/i, /\.bmp$/i].map((ending) => files.find(({ name }) => ending.test(name)));
  if (!config) throw new Error(`${image?.name}: heights of Verti-Bench alone: expected its config….yaml, too`);
  if (!image) {
    const heights = `${/\d+/.exec(config.name) ?? 'number'}.bmp`;
    throw new Error(`${config.name}: expected the heights of that world, ${heights}, too`);
  }
  const { read_verti_bench } = await loadVertiBench();
  const world = read_verti_bench(config.name, new TextDecoder().decode(config.bytes), image.name, image.bytes);
  try {
    const chosen = await ask(world);
    return chosen && filesOf(world.task(chosen.pair, chosen.scale));
  } finally {
    world.free();
  }
}

function filesOf(task: VertiBenchTask): NamedFile[] {
  const encoder = new TextEncoder();
  const { scenario_name, scenario, recipe_name, recipe, heights_name, heights } = task;
  task.free();
  return [
    { name: scenario_name, bytes: encoder.encode(scenario) },
    { name: recipe_name, bytes: encoder.encode(recipe) },
    { name: heights_name, bytes: heights as Uint8Array<ArrayBuffer> },
  ];
}

function ask({ number, difficulty, pairs }: VertiBenchWorld): Promise<{ pair: number; scale: string } | undefined> {
  const sheet = html('dialog', 'sheet heights-sheet');
  const title = html('h2', '', [`World ${number} of Verti-Bench`]);
  title.id = 'verti-bench-title';
  sheet.setAttribute('aria-labelledby', title.id);
  const task = html('select', '', []);
  task.append(...Array.from({ length: pairs }, (_, at) => new Option(`${at + 1} of ${pairs}`, String(at + 1))));
  const scale = html('select');
  scale.append(...SCALES.map(([value, words]) => new Option(words, value)));
  const cancel = button('plain', 'Cancel', () => sheet.close());
  const form = html('form', 'heights-form', [
    html('label', 'field', [html('span', '', ['Task']), task]),
    html('label', 'field', [html('span', '', ['Scale']), scale]),
    html('div', 'heights-actions', [cancel, html('button', 'filled', ['Open'])]),
  ]);
  form.method = 'dialog';
  form.addEventListener('submit', () => sheet.close('open'));
  const words = `Steep ground (${difficulty}) with rocks and trees. Each task is a start and a goal. At 1/5 a rock is to the Husky what it is to the benchmark’s own car.`;
  sheet.append(title, html('p', 'sheet-note', [words]), form);
  document.body.append(sheet);
  return new Promise((resolve) => {
    sheet.addEventListener('close', () => {
      sheet.remove();
      resolve(sheet.returnValue === 'open' ? { pair: Number(task.value), scale: scale.value } : undefined);
    });
    sheet.showModal();
  });
}
