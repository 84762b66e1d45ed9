/** Reads ZIP archives of stored files, such as the page writes. They come from anybody: nothing in them is believed before it is checked. */

import type { NamedFile } from '../protocol/simulationProtocol.ts';
import { crc32 } from './checksum.ts';

/** More files than this make no experiment. */
const MOST_FILES = 100;
/** The record at the end, and the longest comment after it. */
const END_BYTES = 22;
const MOST_COMMENT_BYTES = 0xffff;
const ENTRY_BYTES = 46;
const LOCAL_BYTES = 30;
const ENCRYPTED = 1;

/** The files of an archive, by their names without folders; what else is in it stays out. */
export function unzip({ name, bytes }: NamedFile): NamedFile[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const fault = (what: string) => new Error(`${name}: not a ZIP file that this page reads: ${what}`);
  const end = endOf(view);
  if (end === undefined) throw fault('it has no directory at its end');
  const count = view.getUint16(end + 10, true);
  if (count > MOST_FILES) throw fault(`${count} files: expected at most ${MOST_FILES}`);
  const files: NamedFile[] = [];
  let at = view.getUint32(end + 16, true);
  let stored = 0;
  for (let index = 0; index < count; index += 1) {
    if (at + ENTRY_BYTES > end || view.getUint32(at, true) !== 0x02014b50) {
      throw fault(`entry ${index + 1} of its directory is not there`);
    }
    const [flags, method] = [view.getUint16(at + 8, true), view.getUint16(at + 10, true)];
    const [checksum, packed, size] = [16, 20, 24].map((offset) => view.getUint32(at + offset, true)) as Three;
    const [label, extra, comment] = [28, 30, 32].map((offset) => view.getUint16(at + offset, true)) as Three;
    const path = new TextDecoder().decode(bytes.subarray(at + ENTRY_BYTES, at + ENTRY_BYTES + label));
    const local = view.getUint32(at + 42, true);
    at += ENTRY_BYTES + label + extra + comment;
    if (path.endsWith('/')) continue;
    if (flags & ENCRYPTED || method !== 0) throw fault(`${path} is packed or encrypted: expected it stored as it is`);
    // What is stored takes up its size: entries that share their bytes would make much work of a small file.
    stored += size;
    if (packed !== size || stored > bytes.length)
      throw fault(`${path} has ${size} bytes: expected no more than there are`);
    const content = bytes.subarray(...contentOf(view, local, size));
    if (content.length !== size) throw fault(`${path} is cut off or not where its directory says`);
    if (crc32(content) !== checksum) throw fault(`${path} does not have its checksum`);
    files.push({ name: path.split('/').pop() ?? path, bytes: content });
  }
  return files;
}

type Three = [number, number, number];

/** Where the record at the end begins: right before a comment that is as long as it says. */
function endOf(view: DataView): number | undefined {
  const last = view.byteLength - END_BYTES;
  for (let at = last; at >= 0 && at >= last - MOST_COMMENT_BYTES; at -= 1) {
    if (view.getUint32(at, true) === 0x06054b50 && view.getUint16(at + 20, true) === last - at) return at;
  }
  return undefined;
}

/** Begin and end of a file whose local record is at `local`; nothing where none is. */
function contentOf(view: DataView, local: number, size: number): [begin: number, end: number] {
  if (local + LOCAL_BYTES > view.byteLength || view.getUint32(local, true) !== 0x04034b50) return [0, 0];
  const begin = local + LOCAL_BYTES + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
  return [begin, begin + size];
}
