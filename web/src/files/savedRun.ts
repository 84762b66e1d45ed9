/** The files that the page saves of a run, read again: what was run, and until when. Loaded when somebody opens one. */

import { messageOf } from '../base/messageOf.ts';
import type { Experiment } from '../experiment/experiment.ts';
import { readExperiment } from '../experiment/readExperiment.ts';

export interface SavedRun {
  readonly experiment: Experiment;
  /** Where it stood when it was saved. */
  readonly moment_s: number;
  /** Of all decisions until then. */
  readonly digest: string;
  /** The ticks at which something changed under way, which the experiment does not say; empty for none. */
  readonly changedAt: string;
}

/** As the page writes it into an MCAP file and beside a table. */
interface Said {
  readonly experiment: unknown;
  readonly sim_time_s: number;
  readonly digest: string;
  readonly changed_at_ticks: string;
}

/** Nothing where the file is something else; throws what is wrong with it, with its name. */
export async function savedRun(file: File): Promise<SavedRun | undefined> {
  try {
    const said = /\.mcap$/i.test(file.name) ? await saidByMcap(file) : saidByJson(await file.text());
    if (!said) return undefined;
    const { experiment, sim_time_s: moment_s, digest, changed_at_ticks: changedAt } = said;
    return { experiment: readExperiment(experiment), moment_s, digest, changedAt };
  } catch (cause) {
    throw new Error(`${file.name}: ${messageOf(cause)}`, { cause });
  }
}

/** What is to be said once it was driven again up to its moment, with this digest. */
export function wordsOf(name: string, { digest, changedAt }: SavedRun, now: string): string {
  const begin = `${name}: the page drove this run again, up to where it was saved`;
  if (now === digest) return `${begin}. Every decision is the same, to the bit. The slider goes to any moment of it.`;
  const why = changedAt
    ? `It was changed under way (tick ${changedAt}), which the file does not hold: it goes otherwise from there on`
    : 'Its decisions are not those that were saved, which came from another version of this page';
  return `${begin}. ${why}.`;
}

/** Of a result, or what is saved beside a table; other JSON is left to who reads experiments. */
function saidByJson(text: string): Said | undefined {
  let read: Record<string, unknown> & { run?: Record<string, unknown> };
  try {
    read = JSON.parse(text);
  } catch {
    return undefined;
  }
  const { sim_time_s, digest } = read ?? {};
  if (typeof sim_time_s !== 'number' || typeof digest !== 'string') return undefined;
  const { experiment, changed_at_ticks } = read.run ?? read;
  if (experiment === undefined) return undefined;
  return { experiment, sim_time_s, digest, changed_at_ticks: [changed_at_ticks ?? []].flat().join(', ') };
}

const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
const OPCODE = { header: 0x01, statistics: 0x0b, metadata: 0x0c, metadataIndex: 0x0d } as const;
/** The record that ends a file, and the magic behind it. */
const FOOTER_BYTES = 9 + 20 + MAGIC.length;
/** A summary of the page's files is far smaller. */
const MOST_BYTES = 64 << 20;

/** By hand, since the library's reader would be as large as all else that the page loads on demand for this. */
async function saidByMcap(file: File): Promise<Said | undefined> {
  const head = await viewOf(file, 0, 256);
  if (!isMagic(head, 0) || head.getUint8(MAGIC.length) !== OPCODE.header) return undefined;
  const [profile, library] = texts(head, MAGIC.length + 9, 2);
  // Recordings of a robot have the profile ros2.
  if (profile !== '' || !library?.startsWith('mapless')) return undefined;
  const cut = new Error('the file is cut off: what was run stands at its end. Expected the whole file');
  const footer = await viewOf(file, file.size - FOOTER_BYTES, FOOTER_BYTES);
  if (footer.byteLength < FOOTER_BYTES || !isMagic(footer, FOOTER_BYTES - MAGIC.length)) throw cut;
  const begin = Number(footer.getBigUint64(9, true));
  const summary = await viewOf(file, begin, file.size - FOOTER_BYTES - begin);
  let [end_s, at, length] = [Number.NaN, 0, 0];
  for (let place = 0; place + 9 <= summary.byteLength; place += 9 + Number(summary.getBigUint64(place + 1, true))) {
    const opcode = summary.getUint8(place);
    // Behind the numbers of messages, schemas, channels, attachments, metadata and chunks, and the first time.
    if (opcode === OPCODE.statistics) end_s = Number(summary.getBigUint64(place + 9 + 34, true)) / 1e9;
    if (opcode !== OPCODE.metadataIndex) continue;
    [at, length] = [9, 17].map((offset) => Number(summary.getBigUint64(place + offset, true))) as [number, number];
  }
  const metadata = await viewOf(file, at, length);
  if (length < 9 || metadata.getUint8(0) !== OPCODE.metadata) throw cut;
  const [name = ''] = texts(metadata, 9, 1);
  const map = 9 + 4 + new TextEncoder().encode(name).length;
  const words = texts(metadata, map + 4, Number.POSITIVE_INFINITY, map + 4 + metadata.getUint32(map, true));
  const said = Object.fromEntries(words.flatMap((key, index) => (index % 2 ? [] : [[key, words[index + 1] ?? '']])));
  const { experiment = 'null', digest = '', changed_at_ticks = '' } = said;
  return { experiment: JSON.parse(experiment), sim_time_s: end_s, digest, changed_at_ticks };
}

async function viewOf(file: File, at: number, bytes: number): Promise<DataView> {
  if (!(at >= 0 && bytes >= 0 && bytes <= MOST_BYTES)) return new DataView(new ArrayBuffer(0));
  return new DataView(await file.slice(at, at + bytes).arrayBuffer());
}

function isMagic(view: DataView, at: number): boolean {
  return MAGIC.every((byte, index) => at + index < view.byteLength && view.getUint8(at + index) === byte);
}

/** So many texts, each behind its length, up to a place. */
function texts(view: DataView, from: number, most: number, end = view.byteLength): string[] {
  const found: string[] = [];
  let at = from;
  while (found.length < most && at + 4 <= end) {
    const length = view.getUint32(at, true);
    if (at + 4 + length > view.byteLength) throw new Error('a text that goes beyond its record: expected it within');
    found.push(new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + at + 4, length)));
    at += 4 + length;
  }
  return found;
}
