/** The worker: owns the wasm core and the loop. The page only ever sees the protocol. */

import { messageOf } from '../base/messageOf.ts';
import { loadCore } from '../bindings/simulationModule.ts';
import type {
  Command,
  Computing,
  FromSimulation,
  GroundPatch,
  Source,
  ToSimulation,
} from '../protocol/simulationProtocol.ts';
import { beginningAt } from './beginning.ts';
import { Frames } from './frames.ts';
import { filesOf, openingFrom, preview } from './opening.ts';
import { Session } from './session.ts';

/** How long the loop may simulate before it listens again, in milliseconds. */
const SLICE_MS = 12;

/** Begun at once: it compiles while the page builds its view. Who needs it hears if that fails. */
const loading = loadCore();
loading.catch(() => undefined);
let session: Session | undefined;
let playing = false;
let hidden = false;
let speed = 1;
/** When the next tick is due, on the clock of `performance.now()`. */
let due_ms = 0;
let scheduled = false;
/** Whether a request drives to a moment: the loop, which may be due, leaves the run to it. */
let drivesToMoment = false;
/** Whether something has changed since the decision that is shown. */
let rethink = false;
const frames = new Frames(post);
/** The newest wish to go elsewhere in time: older ones are given up. */
let newestSeek: number | undefined;
/** Requests are carried out one after the other: loading waits for files. */
let queue: Promise<void> = Promise.resolve();

const wake = new MessageChannel();
wake.port1.onmessage = loop;

function post(message: FromSimulation, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

/** Reports an error: of a request, which changes nothing else, or of the loop, which then stands still. */
function fail(error: unknown, id?: number): void {
  if (id === undefined) playing = false;
  const panicked = error instanceof WebAssembly.RuntimeError;
  const message = messageOf(error);
  post({ type: 'failed', id, message, panicked });
}

function running(): Session | undefined {
  return playing && !hidden && session?.running ? session : undefined;
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
  if (drivesToMoment) return;
  try {
    const began_ms = performance.now();
    // After a pause or a slow spell, go on from now rather than catching up.
    due_ms = Math.max(due_ms, began_ms - 250);
    while (running() && due_ms <= performance.now() && performance.now() - began_ms < SLICE_MS) {
      advance();
      const tick_ms = 1000 * (session?.info.period_s ?? 0);
      due_ms = Number.isFinite(speed) ? due_ms + tick_ms / speed : performance.now();
    }
    showIfDue();
    schedule();
  } catch (error) {
    fail(error);
  }
}

function advance(): void {
  if (!session) return;
  announce(session.computing());
  frames.drove(session.tick());
}

/** While a decision is made, nothing else is heard of the worker. */
function announce(computing: Computing | undefined): void {
  if (computing) post({ type: 'computing', ...computing });
}

/** Posts the newest state unless the page is still busy with earlier ones. */
function showIfDue(): void {
  if (!frames.due) return;
  const wait_ms = frames.wait_ms;
  if (!session?.running || wait_ms <= 0) show();
  // What stands still has no tick after which to look again.
  else if (!running()) setTimeout(loop, wait_ms);
}

/** What stands still is shown whole: its last tick, and the surfaces where they are looked at. */
function showAtRest(): void {
  if (!running() && frames.lacking) show();
}

function show(): void {
  if (!session) return;
  if (rethink && !running() && session.running) {
    announce(session.computing());
    session.thinkAgain();
  }
  rethink = false;
  if (session.followRoute()) tellSession();
  frames.show(session, !running());
}

function openFromStart(): void {
  if (!session) return;
  frames.begin(session.standing);
  due_ms = performance.now();
  show();
}

/** Says what is loaded now, on the ground that the page has. */
function tellSession(): void {
  if (session) post({ type: 'session', info: session.info, loaded: undefined });
}

/** Goes to a tick: from the nearest copy before it, the ticks in between are run again. */
async function seek(tick: number, id: number): Promise<void> {
  if (!session) return;
  playing = false;
  const target = session.goBack(Math.round(tick));
  let rested_ms = performance.now();
  while (session.standing.tick < target && session.running && id === newestSeek) {
    announce(session.computing());
    // The record has these ticks already.
    session.tick();
    if (performance.now() - rested_ms < SLICE_MS) continue;
    await new Promise((resolve) => setTimeout(resolve));
    rested_ms = performance.now();
  }
  frames.jumped();
  rethink = session.tries;
  show();
}

/** Drives on to a time of the run as fast as it goes, and stands there. */
async function driveTo(time_s: number): Promise<void> {
  if (!session) return;
  const tick = Math.round(time_s / session.info.period_s);
  playing = drivesToMoment = true;
  try {
    let rested_ms = performance.now();
    while (drivesToMoment && session.running && session.standing.tick < tick) {
      advance();
      if (performance.now() - rested_ms < SLICE_MS) continue;
      showIfDue();
      await new Promise((resolve) => setTimeout(resolve));
      rested_ms = performance.now();
    }
  } finally {
    playing = drivesToMoment = false;
  }
  show();
}

function showPatch(patch: GroundPatch): void {
  post({ type: 'ground', patch, solids: session?.solids() ?? [] }, [patch.heights_m.buffer]);
  beginOtherFuture();
}

/** A run that has ended badly stands, though a change of the ground under it lets it go on. */
function standIfEnded(): void {
  const outcome = session?.standing.outcome;
  if (!playing || outcome === 'running' || outcome === 'reached') return;
  playing = false;
  post({ type: 'stands' });
}

/** What is only tried at this pose holds for the run from here on. */
function adoptTried(): void {
  if (!session?.tries) return;
  session.goOn();
  frames.cut(session.standing);
  tellSession();
}

/** The ground or what stands on it has changed: what came after the present tick happened on another one. */
function beginOtherFuture(): void {
  if (session) frames.cut(session.standing);
  frames.outdate();
  rethink = true;
  // The stroke goes on first: a scan of the new ground takes longer than a touch. What drives is shown by the loop.
  if (!running()) setTimeout(loop);
}

async function load(source: Source, play: boolean, id: number): Promise<void> {
  const core = await loading;
  post({ type: 'opening', id });
  const opening = await openingFrom(core, source);
  const opened = await Session.open(core, opening.experiment);
  session?.free();
  session = opened;
  playing ||= play;
  const ground = session.ground();
  const loaded = { ground, ...opening };
  post({ type: 'session', info: session.info, loaded }, [ground.heights_m.buffer]);
  openFromStart();
}

/** Returns what the request is answered with. */
async function carryOut(command: Command, id: number): Promise<unknown> {
  if (command.type === 'begin') {
    const { source, ...beginning } = await beginningAt(command.address);
    await load(source, beginning.moment_s === undefined, id);
    if (beginning.moment_s !== undefined) await driveTo(beginning.moment_s);
    return beginning;
  }
  if (command.type === 'load') {
    await load(command.source, command.play, id);
    return;
  }
  if (command.type === 'watch') {
    frames.watched = command.surfaces;
    if (frames.surfacesLack) show();
    return;
  }
  if (command.type === 'preview') {
    return preview(await loading, command.terrain);
  }
  if (command.type === 'export') {
    return filesOf(await loading, command.experiment);
  }
  if (command.type === 'hidden') {
    hidden = command.hidden;
    due_ms = performance.now();
    showAtRest();
    return;
  }
  if (!session) throw new Error('No scenario is loaded yet.');
  switch (command.type) {
    case 'play':
      if (command.playing) adoptTried();
      playing = command.playing;
      due_ms = performance.now();
      showAtRest();
      break;
    case 'speed':
      speed = command.speed;
      due_ms = performance.now();
      break;
    case 'step':
      playing = false;
      adoptTried();
      advance();
      show();
      break;
    case 'restart':
      session.restart();
      tellSession();
      openFromStart();
      break;
    case 'drive':
      await driveTo(command.time_s);
      break;
    case 'seek':
      await seek(command.tick, id);
      break;
    case 'parameters':
      session.setOverrides(command.overrides, command.seed);
      tellSession();
      openFromStart();
      break;
    case 'think':
      announce(session.computing(command.setup));
      session.think(command.setup);
      tellSession();
      show();
      break;
    case 'inside':
      return session.lookInside(command.question);
    case 'place':
      return session.reportOn(command.place);
    case 'climb':
      return session.climb();
    case 'kernel':
      return session.kernelFrom(command.column, command.row);
    case 'truth':
      frames.truthShown = command.shown;
      if (!running()) show();
      break;
    case 'goal':
      session.setRoute(command.waypoints, command.goal);
      frames.cut(session.standing);
      rethink = true;
      tellSession();
      show();
      break;
    case 'start':
      session.setStart(command.start);
      session.restart();
      tellSession();
      openFromStart();
      break;
    case 'objects':
      standIfEnded();
      session.setObjects(command.objects);
      tellSession();
      beginOtherFuture();
      break;
    case 'sculpt': {
      standIfEnded();
      const patch = session.sculpt(command.stroke);
      if (patch) showPatch(patch);
      break;
    }
    case 'replace':
      standIfEnded();
      session.replaceGround(command.patch);
      showPatch(command.patch);
      break;
  }
}

function hear(message: ToSimulation): void {
  if (message.type === 'recycle') {
    frames.returned();
    session?.recycle(message.buffers);
    try {
      showIfDue();
    } catch (error) {
      fail(error);
    }
    return;
  }
  const { id, command } = message;
  if (command.type === 'seek') newestSeek = id;
  if (command.type === 'play' || command.type === 'load') drivesToMoment = false;
  queue = queue.then(async () => {
    try {
      const value = await carryOut(command, id);
      post({ type: 'done', id, value });
    } catch (error) {
      fail(error, id);
    }
    schedule();
  });
}

post({ type: 'started' });
self.onmessage = ({ data }: MessageEvent<ToSimulation>) => hear(data);
// The first request comes as the worker's name.
if (self.name) hear(JSON.parse(self.name));
