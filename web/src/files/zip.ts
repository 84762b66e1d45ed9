/** A ZIP archive of a few files, stored as they are. */

import type { NamedFile } from '../protocol/simulationProtocol.ts';
import { crc32 } from './checksum.ts';

/** 1 January 1980, the first day that the format knows: the same files give the same archive. */
const DATE = 0x0021;
const UTF8_NAMES = 0x0800;

export function zip(files: readonly NamedFile[]): Blob {
  const parts: Uint8Array<ArrayBuffer>[] = [];
  const directory: Uint8Array<ArrayBuffer>[] = [];
  let offset = 0;
  for (const { name, bytes } of files) {
    const label = new TextEncoder().encode(name);
    // Version 2.0, flags, stored, time, date, checksum, sizes, length of the name, no extra field.
    const common = [
      [2, 20],
      [2, UTF8_NAMES],
      [2, 0],
      [2, 0],
      [2, DATE],
      [4, crc32(bytes)],
      [4, bytes.length],
      [4, bytes.length],
      [2, label.length],
      [2, 0],
    ] as const;
    const local = record([[4, 0x04034b50], ...common]);
    parts.push(local, label, bytes);
    // The directory adds who made it, the comment, the disk, attributes and where the file stands.
    directory.push(record([[4, 0x02014b50], [2, 20], ...common, [2, 0], [2, 0], [2, 0], [4, 0], [4, offset]]), label);
    offset += local.length + label.length + bytes.length;
  }
  const size = directory.reduce((sum, part) => sum + part.length, 0);
  const [count, none] = [[2, files.length] as const, [2, 0] as const];
  const end = record([[4, 0x06054b50], none, none, count, count, [4, size], [4, offset], none]);
  return new Blob([...parts, ...directory, end], { type: 'application/zip' });
}

/** Little-endian numbers of 2 or 4 bytes. */
function record(fields: readonly (readonly [bytes: 2 | 4, value: number])[]): Uint8Array<ArrayBuffer> {
  const result = new Uint8Array(fields.reduce((sum, [bytes]) => sum + bytes, 0));
  const view = new DataView(result.buffer);
  let at = 0;
  for (const [bytes, value] of fields) {
    if (bytes === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += bytes;
  }
  return result;
}
