/** The worker that reads a recording: decides all of it again, a piece at a time, and shows the moments that the page asks for. */

import { messageOf } from '../base/messageOf.ts';
import { loadReplay } from '../bindings/replayModule.ts';
import { type FrameBuffers, transferables } from '../protocol/simulationProtocol.ts';
import { newFrameBuffers } from '../simulation/frameBuffers.ts';
import type { Recording } from '../wasm/mapless_wasm_replay.js';
import type { Decided, FromRecording, Topics, ToRecording } from './recordedProtocol.ts';

/** How long it decides before it listens again. */
const SLICE_MS = 25;
/** Entries decided between two looks at the clock. */
const ENTRIES = 20;
/** No news is posted sooner after the one before than this. */
const NEWS_MS = 200;

let recording: Recording | undefined;
let decided: Decided | undefined;
let wanted: Extract<ToRecording, { type: 'show' }> | undefined;
let pool: FrameBuffers[] = [];
let told = nothingTold();
/** Opens the recording with faults put in. */
let openWith: ((faults: readonly string[]) => Recording) | undefined;

const wake = new MessageChannel();
wake.port1.onmessage = guarded(work);

function nothingTold() {
  return { scans: 0, differences: 0, changes: 0, trail: 0, at_ms: 0 };
}

function post(message: FromRecording, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

/** After an error the module is not to be used any more. */
function guarded<Given extends unknown[]>(act: (...given: Given) => void | Promise<void>): (...given: Given) => void {
  return async (...given) => {
    try {
      await act(...given);
    } catch (error) {
      recording = undefined;
      post({ type: 'failed', message: messageOf(error) });
    }
  };
}

self.onmessage = guarded(async ({ data }: MessageEvent<ToRecording>) => {
  if (data.type === 'open') await open(data.file, data.topics);
  else {
    if (data.type === 'recycle') pool.push(data.buffers);
    else if (data.type === 'faults') restart(data.faults);
    else wanted = data;
    wake.port2.postMessage(undefined);
  }
});

async function open(file: File, topics?: Topics): Promise<void> {
  const { Recording, topic_choices, supervisor_transitions, fault_kinds } = await loadReplay();
  const reader = new FileReaderSync();
  const read = (at: number, bytes: number) => new Uint8Array(reader.readAsArrayBuffer(file.slice(at, at + bytes)));
  const source = { name: file.name, size: file.size, read };
  const choices = topics ? [] : topic_choices(source);
  if (choices.length > 0) {
    post({ type: 'asks', choices });
    return;
  }
  openWith = (faults) => new Recording(source, topics ?? {}, [...faults]);
  recording = openWith([]);
  const scene = recording.scene();
  pool = [newFrameBuffers(scene.image), newFrameBuffers(scene.image)];
  const supervisor = { transitions: supervisor_transitions(), faultKinds: fault_kinds() };
  post({ type: 'opened', scene, supervisor });
  wake.port2.postMessage(undefined);
}

function restart(faults: readonly string[]): void {
  if (!recording || !openWith) return;
  recording.free();
  recording = openWith(faults);
  [decided, told] = [undefined, nothingTold()];
  post({ type: 'restarted' });
}

/** One slice: on with the drive, and what is asked for as soon as it goes so far. */
function work(): void {
  if (!recording) return;
  const until_ms = performance.now() + SLICE_MS;
  if (!decided?.has_ended && !reached()) {
    do decided = recording.decide_on(ENTRIES);
    while (!decided.has_ended && !reached() && performance.now() < until_ms);
  }
  tell();
  if (reached()) show();
  if (!decided?.has_ended) wake.port2.postMessage(undefined);
}

/** Whether what the page wants to see was decided. */
function reached(): boolean {
  return wanted !== undefined && decided !== undefined && (decided.has_ended || decided.until_s >= wanted.time_s);
}

function show(): void {
  const buffers = pool.pop();
  if (!recording || !wanted || !buffers) return;
  const { time_s, since_s } = wanted;
  wanted = undefined;
  const frame = recording.show(time_s, since_s, buffers, true);
  post({ type: 'shown', frame, buffers }, transferables(buffers));
}

function tell(): void {
  const now_ms = performance.now();
  if (!recording || !decided || (now_ms - told.at_ms < NEWS_MS && !decided.has_ended)) return;
  told.at_ms = now_ms;
  const [scans_s, differences_s] = [recording.scans_s(told.scans), recording.differences_s(told.differences)];
  const [trail_s, trail_m] = [recording.trail_s(told.trail), recording.trail_m(told.trail)];
  const changes = recording.changes(told.changes);
  told.scans += scans_s.length;
  told.differences += differences_s.length;
  told.trail += trail_s.length;
  told.changes += changes.length;
  post({ type: 'news', news: { decided, scans_s, differences_s, changes, trail_s, trail_m } });
}
