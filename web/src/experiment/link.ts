/**
 * Experiments as links: `#e=` and then the document, deflated, in the letters of base64url. A link is text from
 * anybody, so nothing of it is believed before it is checked, and no more than a bounded amount of it is unpacked.
 */

import { messageOf } from '../base/messageOf.ts';
import type { Experiment, Stroke } from './experiment.ts';
import { readExperiment } from './readExperiment.ts';

/** What chats and mails carry whole. */
export const MAX_LINK_CHARACTERS = 4000;
/** A longer link was not made here. */
const MAX_READ_CHARACTERS = 200_000;
const MAX_UNPACKED_BYTES = 4 << 20;
const KEY = '#e=';
/** Between the experiment and the moment of its run. */
const MOMENT = '&t=';

/** The experiment's link below `address`, whatever its length; with a time, its run opens there and stands. */
export async function linkTo(address: string, experiment: Experiment, time_s?: number): Promise<string> {
  const json = JSON.stringify({ ...experiment, strokes: experiment.strokes.map(pack) });
  const stream = new Blob([json]).stream().pipeThrough(new CompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const moment = time_s === undefined ? '' : `${MOMENT}${Number(time_s.toFixed(3))}`;
  return address.split('#')[0] + KEY + base64url(bytes) + moment;
}

/** Whether an address carries an experiment. */
export function carriesExperiment(hash: string): boolean {
  return hash.startsWith(KEY);
}

/** The experiment in an address's fragment, or an error that says what is wrong with the link. */
export async function experimentIn(hash: string): Promise<Experiment> {
  try {
    const [letters = ''] = hash.slice(KEY.length).split('&');
    return readExperiment(unpackAll(await unpacked(letters)));
  } catch (cause) {
    const why = messageOf(cause);
    throw new Error(`This link does not work, so nothing was changed. ${why}`, { cause });
  }
}

async function unpacked(letters: string): Promise<unknown> {
  if (letters.length > MAX_READ_CHARACTERS) {
    throw new Error(`It has ${letters.length} characters: expected at most ${MAX_READ_CHARACTERS}.`);
  }
  let bytes: Uint8Array<ArrayBuffer>;
  try {
    bytes = await inflated(fromBase64url(letters));
  } catch (cause) {
    throw new Error('It is damaged or was cut short: expected the whole link as it was copied.', { cause });
  }
  if (bytes.length > MAX_UNPACKED_BYTES) {
    throw new Error(`It unpacks to more than ${MAX_UNPACKED_BYTES >> 20} MB: expected an experiment.`);
  }
  try {
    return JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes));
  } catch (cause) {
    throw new Error('It holds no JSON: expected an experiment.', { cause });
  }
}

/** At most one part more than is allowed, however much there would be. */
async function inflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer>> {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let size = 0;
  while (size <= MAX_UNPACKED_BYTES) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    size += value.length;
  }
  // Lets go of the rest; a stream that has ended has none.
  await reader.cancel();
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/** Neighbouring touches lie close: their differences are short numbers that repeat. */
function pack(stroke: Stroke): Stroke {
  const { points_cm } = stroke;
  return { ...stroke, points_cm: points_cm.map((value, at) => value - (points_cm[at - 2] ?? 0)) };
}

/** Undoes `pack` where there is something that looks like strokes; what does not is left to the check. */
function unpackAll(value: unknown): unknown {
  const { strokes } = (value ?? {}) as { strokes?: unknown };
  if (!Array.isArray(strokes)) return value;
  const unpack = (one: unknown) => {
    const { points_cm } = (one ?? {}) as { points_cm?: unknown };
    if (!Array.isArray(points_cm)) return one;
    const sums: unknown[] = [];
    for (const [at, step] of points_cm.entries()) sums.push(at < 2 ? step : Number(sums[at - 2]) + Number(step));
    return { ...(one as Stroke), points_cm: sums };
  };
  return { ...(value as object), strokes: strokes.map(unpack) };
}

function fromBase64url(letters: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(letters.replaceAll('-', '+').replaceAll('_', '/')), (letter) => letter.charCodeAt(0));
}

function base64url(bytes: Uint8Array): string {
  let letters = '';
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return btoa(letters).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}
