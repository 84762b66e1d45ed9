/** The worker of ghosts and batches: runs whole trials beside the page's own, and tells how they stand. */

import { messageOf } from '../base/messageOf.ts';
import { loadTrials, type TrialsModule } from '../bindings/trialsModule.ts';
import { GuestRun } from './guestRun.ts';
import { type Runner, RunnerFactory, summary } from './runner.ts';
import { type FromTrials, type Job, OWN_PLANNER, type Rider, type ToTrials } from './trialsProtocol.ts';

/** How long it runs before it listens and tells again, in milliseconds. */
const SLICE_MS = 40;

let until = 0;
let wake: (() => void) | undefined;

function post(message: FromTrials, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

/** Lets messages in. */
function rest(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve));
}

/** Until more ticks are asked for. */
function woken(): Promise<void> {
  return new Promise((resolve) => {
    wake = resolve;
  });
}

interface Ghost {
  readonly runner: Runner;
  tick: number;
}

/** Who is to drive as a ghost. */
let wanted: readonly Rider[] = [];

async function ghosts({ course, riders, seed }: Extract<Job, { type: 'ghosts' }>): Promise<void> {
  wanted = riders;
  const factory = new RunnerFactory(await loadTrials(), course);
  /** By the rider's name; nothing for one that cannot drive here. */
  const begun = new Map<string, Ghost | undefined>();
  for (;;) {
    for (const [name, ghost] of begun) {
      if (wanted.some((rider) => rider.name === name)) continue;
      ghost?.runner.free();
      begun.delete(name);
    }
    for (const rider of wanted) {
      if (!begun.has(rider.name)) begun.set(rider.name, entered(factory, rider, seed));
    }
    // The one that is farthest behind comes first, so that all stay in step.
    const running = [...begun.values()].filter((ghost) => ghost?.runner.running);
    const [next] = running.sort((a, b) => (a?.tick ?? 0) - (b?.tick ?? 0));
    if (!next || next.tick >= until) {
      await woken();
      continue;
    }
    const began_ms = performance.now();
    const rows: number[] = [];
    while (next.runner.running && next.tick < until && performance.now() - began_ms < SLICE_MS) {
      next.runner.tick();
      next.tick += 1;
      rows.push(...next.runner.row);
    }
    post({ type: 'ghost', rows: new Float64Array(rows), result: next.runner.result });
    await rest();
  }
}

/** One at its start. */
function entered(factory: RunnerFactory, rider: Rider, seed: number): Ghost | undefined {
  try {
    const runner = factory.runner(rider, seed);
    post({ type: 'ghost', rows: new Float64Array(runner.row), result: runner.result });
    return { runner, tick: 0 };
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
    post({ type: 'refused', planner: rider.name, message: messageOf(error) });
    return undefined;
  }
}

/** What is wrong with the planner is said; the trial stands where it then was. */
async function own({ course, seed, port }: Extract<Job, { type: 'own' }>): Promise<void> {
  const run = new GuestRun(new RunnerFactory(await loadTrials(), course).guest(seed), seed, port);
  try {
    await run.begin();
    post({ type: 'ghost', rows: new Float64Array(run.row), result: run.result });
    while (run.running) {
      if (run.ticks >= until) await woken();
      const began_ms = performance.now();
      const rows: number[] = [];
      try {
        while (run.running && run.ticks < until && performance.now() - began_ms < SLICE_MS) {
          await run.tick();
          rows.push(...run.row);
        }
      } finally {
        post({ type: 'ghost', rows: new Float64Array(rows), result: run.result });
      }
      post({ type: 'took', decision_ms: run.decision_ms });
    }
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
    post({ type: 'refused', planner: OWN_PLANNER, message: messageOf(error) });
  }
}

interface Batch {
  readonly module: TrialsModule;
  readonly factory: RunnerFactory;
  readonly rider: Rider;
}

/** There once the job is a batch. */
let batch: Promise<Batch> | undefined;

async function opened({ course, planner }: Extract<Job, { type: 'seeds' }>): Promise<Batch> {
  const module = await loadTrials();
  const { learning, overrides } = course;
  const rider = { name: planner, planner, learning, overrides };
  return { module, factory: new RunnerFactory(module, course), rider };
}

function drive({ factory, rider }: Batch, seed: number): void {
  const runner = factory.runner(rider, seed);
  while (runner.running) runner.tick();
  post({ type: 'trial', result: runner.result });
  runner.free();
}

/** Whatever is asked of a batch while it loads is done in its order afterwards. */
function carryOut(message: ToTrials): Promise<void> | undefined {
  switch (message.type) {
    case 'until':
      until = message.tick;
      wake?.();
      return;
    case 'riders':
      wanted = message.riders;
      wake?.();
      return;
    case 'ghosts':
      return ghosts(message);
    case 'own':
      return own(message);
    case 'seeds':
      batch = opened(message);
      return;
    case 'drive':
      return batch?.then((open) => drive(open, message.seed));
    case 'sum':
      return batch?.then(({ module }) => post({ type: 'summary', summary: summary(module, message.results) }));
  }
}

self.onmessage = ({ data }: MessageEvent<ToTrials>) => {
  carryOut(data)?.catch((error: unknown) => {
    post({ type: 'failed', message: messageOf(error), panicked: error instanceof WebAssembly.RuntimeError });
  });
};
