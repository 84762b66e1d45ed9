/** The worker: owns the wasm core and the loop. The page only ever sees the protocol. */

import { experimentFrom, filesOf, preview } from './opening.ts';
import type { Command, Frame, FromWorker, GroundPatch, ToWorker } from './protocol.ts';
import { TICK_RATE_HZ } from './protocol.ts';
import { Session } from './session.ts';
import { type CoreModule, loadCore, panicMessage } from './wasm.ts';

/** Frames that the page may have at once, the one it shows among them; while it is slower, frames are skipped. */
const FRAMES_IN_FLIGHT = 3;
/** How long the loop may simulate before it listens again, in milliseconds. */
const SLICE_MS = 12;
/** No frame is posted sooner after the one before than this: each needs the whole variance surface, which ticks do not. */
const FRAME_INTERVAL_MS = 50;

let core: CoreModule | undefined;
let session: Session | undefined;
let playing = false;
let hidden = false;
let speed = 1;
/** When the next tick is due, on the clock of `performance.now()`. */
let due_ms = 0;
let scheduled = false;
let inFlight = 0;
let lastFrame_ms = 0;
let unsent = false;
let path: number[] = [];
/** Requests are carried out one after the other: loading waits for files. */
let queue: Promise<void> = Promise.resolve();

const wake = new MessageChannel();
wake.port1.onmessage = loop;

function post(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

/** Reports an error: of a request, which changes nothing else, or of the loop, which then stands still. */
function fail(error: unknown, id?: number): void {
  if (id === undefined) playing = false;
  const panicked = error instanceof WebAssembly.RuntimeError;
  const plain = error instanceof Error ? error.message : String(error);
  post({ type: 'failed', id, message: (panicked ? panicMessage() : undefined) ?? plain, panicked });
}

function running(): Session | undefined {
  return playing && !hidden && session?.outcome === 'running' ? session : undefined;
}

function schedule(): void {
  if (scheduled || !running()) return;
  scheduled = true;
  const wait_ms = due_ms - performance.now();
  if (wait_ms > 1) setTimeout(loop, wait_ms);
  else wake.port2.postMessage(0);
}

function loop(): void {
  scheduled = false;
  try {
    const began_ms = performance.now();
    // After a pause or a slow spell, go on from now rather than catching up.
    due_ms = Math.max(due_ms, began_ms - 250);
    while (running() && due_ms <= performance.now() && performance.now() - began_ms < SLICE_MS) {
      advance();
      due_ms = Number.isFinite(speed) ? due_ms + 1000 / (TICK_RATE_HZ * speed) : performance.now();
    }
    showIfDue();
    schedule();
  } catch (error) {
    fail(error);
  }
}

function advance(): void {
  if (!session) return;
  session.tick();
  const { x, y, z } = session.status();
  path.push(x, y, z);
  unsent = true;
}

/** Posts the newest state unless the page is still busy with earlier ones. */
function showIfDue(): void {
  const now_ms = performance.now();
  const last = session?.outcome !== 'running';
  if (!unsent || inFlight >= FRAMES_IN_FLIGHT) return;
  if (!last && now_ms - lastFrame_ms < FRAME_INTERVAL_MS) return;
  lastFrame_ms = now_ms;
  show();
}

function show(): void {
  if (!session) return;
  const frame: Frame = session.frame(new Float32Array(path));
  path = [];
  unsent = false;
  inFlight += 1;
  const { points, variance, profile, kinds } = frame.buffers;
  post({ type: 'frame', frame }, [points.buffer, variance.buffer, profile.buffer, kinds.buffer, frame.path.buffer]);
}

function openFromStart(): void {
  if (!session) return;
  path = [];
  const { x, y, z } = session.status();
  path.push(x, y, z);
  due_ms = performance.now();
  show();
}

function showPatch(patch: GroundPatch): void {
  post({ type: 'ground', patch }, [patch.heights_m.buffer]);
  unsent = true;
  showIfDue();
}

/** Returns what the request is answered with. */
async function carryOut(command: Command): Promise<unknown> {
  if (command.type === 'load') {
    core ??= await loadCore();
    const experiment = await experimentFrom(core, command.source);
    const opened = await Session.open(core, experiment);
    session?.free();
    session = opened;
    const ground = session.ground();
    post({ type: 'session', info: session.info, ground, experiment }, [ground.heights_m.buffer]);
    openFromStart();
    return;
  }
  if (command.type === 'preview') {
    core ??= await loadCore();
    return preview(core, command.terrain);
  }
  if (command.type === 'export') {
    core ??= await loadCore();
    return filesOf(core, command.experiment);
  }
  if (command.type === 'hidden') {
    hidden = command.hidden;
    due_ms = performance.now();
    return;
  }
  if (!session) throw new Error('No scenario is loaded yet.');
  switch (command.type) {
    case 'play':
      playing = command.playing;
      due_ms = performance.now();
      break;
    case 'speed':
      speed = command.speed;
      due_ms = performance.now();
      break;
    case 'step':
      playing = false;
      advance();
      show();
      break;
    case 'restart':
      session.restart();
      post({ type: 'session', info: session.info, ground: undefined, experiment: undefined });
      openFromStart();
      break;
    case 'goal':
      session.setGoal(command.goal);
      post({ type: 'session', info: session.info, ground: undefined, experiment: undefined });
      show();
      break;
    case 'start':
      session.setStart(command.start);
      session.restart();
      post({ type: 'session', info: session.info, ground: undefined, experiment: undefined });
      openFromStart();
      break;
    case 'sculpt': {
      const patch = session.sculpt(command.stroke);
      if (patch) showPatch(patch);
      break;
    }
    case 'replace':
      session.replaceGround(command.patch);
      showPatch(command.patch);
      break;
  }
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.type === 'recycle') {
    // Frames from before a panic come back to the worker that took over.
    inFlight = Math.max(0, inFlight - 1);
    session?.recycle(data.buffers);
    try {
      showIfDue();
    } catch (error) {
      fail(error);
    }
    return;
  }
  const { id, command } = data;
  queue = queue.then(async () => {
    try {
      const value = await carryOut(command);
      post({ type: 'done', id, value });
    } catch (error) {
      fail(error, id);
    }
    schedule();
  });
};
