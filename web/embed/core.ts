/**
 * The simulation and the planner by themselves, in Node or a page: the WebAssembly core with the scenarios of
 * the page.
 *
 * SI units and radians. World: x east, y north, z up. Robot and sensor: x forward, y left, z up.
 */

import { CATALOGUE, terrainFile } from '../src/experiment/catalogue.ts';
import { newFrameBuffers } from '../src/simulation/frameBuffers.ts';
import init, {
  type Frame,
  type FrameBuffers,
  type Learning,
  type Overrides,
  type Preset,
  read_scenario,
  Session,
  type SessionOptions,
  type Tick,
} from '../src/wasm/mapless_wasm.js';

export type { Frame, FrameBuffers, Overrides, Session, Tick };

export interface RunOptions {
  /** `default` unless given; `paper` is the paper taken literally. */
  readonly preset?: Preset;
  readonly learning?: Learning;
  /** The scenario's own unless given. */
  readonly seed?: number;
  /** Parameters as tables of a scenario file: `{ sensor: { range_noise_m: 0.1 } }`. */
  readonly overrides?: Overrides;
}

/** A scenario of one's own: the text of its file, and of the recipe that it names as its terrain. */
export interface OwnScenario {
  readonly scenario: string;
  readonly terrain: string;
}

/** The names of the scenarios that come along. */
export const SCENARIOS: readonly string[] = CATALOGUE.map(({ id }) => id);

let started: Promise<unknown> | undefined;

/** Loads the core once. Node reads the file; browsers fetch it. */
function start(): Promise<unknown> {
  const file = new URL(/* @vite-ignore */ './wasm/mapless_wasm_bg.wasm', import.meta.url);
  started ??= (async () => {
    const bytes = file.protocol === 'file:' ? await (await import('node:fs/promises')).readFile(file) : fetch(file);
    await init({ module_or_path: bytes });
  })();
  return started;
}

/**
 * Opens a scenario by its name, or one of one's own. Rejected with file, place, value and expectation where something is
 * wrong with it.
 */
export async function open(scenario: string | OwnScenario, options: RunOptions = {}): Promise<Run> {
  await start();
  const { text, recipe } = typeof scenario === 'string' ? catalogued(scenario) : ownFiles(scenario);
  const given: SessionOptions = {
    scenario: { name: 'scenario.toml', text },
    terrain: { name: 'terrain.toml', bytes: new TextEncoder().encode(recipe) },
    preset: 'default',
    ...options,
  };
  return new Run(new Session(given));
}

/** One trial: a robot on its way. */
export class Run {
  /** Everything else that the core can do, as the page uses it. */
  readonly session: Session;
  readonly #buffers: FrameBuffers;
  #running = true;

  constructor(session: Session) {
    this.session = session;
    this.#buffers = newFrameBuffers(session.scene().image);
  }

  /** Whether the trial goes on. */
  get running(): boolean {
    return this.#running;
  }

  /** One planning period: scan, decision, motion. Does nothing once the trial has ended. */
  tick(): Tick {
    const tick = this.session.tick();
    this.#running = tick.after.outcome === 'running';
    return tick;
  }

  /** Drives to the end; how that was. */
  drive(): Tick {
    let last = this.tick();
    while (this.#running) last = this.tick();
    return last;
  }

  /** All that is known of this tick: pose, segments, subgoals with their costs, path. `buffers` has the scan and the skyline, and the variance image if asked for; the next call fills them anew. */
  look(surfaces = false): { readonly frame: Frame; readonly buffers: FrameBuffers } {
    return { frame: this.session.frame(this.#buffers, surfaces, false), buffers: this.#buffers };
  }

  /** Of the trajectory so far: the same as that of the command line. */
  digest(): string {
    return this.session.digest();
  }
}

function catalogued(name: string): { text: string; recipe: string } {
  if (!SCENARIOS.includes(name)) throw new Error(`scenario = ${name}: expected one of ${SCENARIOS.join(', ')}`);
  const text = terrainFile(`scenarios/${name}.toml`);
  const { terrain } = read_scenario(`${name}.toml`, text);
  return { text, recipe: terrainFile(`scenarios/${terrain}`) };
}

function ownFiles({ scenario, terrain }: OwnScenario): { text: string; recipe: string } {
  return { text: scenario, recipe: terrain };
}
