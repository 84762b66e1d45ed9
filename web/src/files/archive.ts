/** ZIP archives of a few files, written and read. They come from anybody: what is read is checked before it is believed. */

import { crc32 } from '@foxglove/crc';
import { type UnzipFileInfo, unzipSync, zipSync } from 'fflate';
import { messageOf } from '../base/messageOf.ts';
import type { NamedFile } from '../protocol/simulationProtocol.ts';

/** The first day that the format knows: the same files give the same archive. */
const DATE = new Date(1980, 0, 1);
/** More files than this make no experiment. */
const MOST_FILES = 100;

export function zip(files: readonly NamedFile[]): Blob {
  const archive = zipSync(Object.fromEntries(files.map(({ name, bytes }) => [name, bytes])), { mtime: DATE });
  return new Blob([archive], { type: 'application/zip' });
}

/** The files of an archive, by their names without folders, that take no more than so many bytes in all. */
export function unzip({ name, bytes }: NamedFile, most_bytes: number): NamedFile[] {
  const fault = (what: string) => new Error(`${name}: not a ZIP file that this page reads: ${what}`);
  const paths: string[] = [];
  let size = 0;
  let contents: Record<string, Uint8Array<ArrayBuffer>>;
  let checksums: number[];
  try {
    // The filter is asked before a file is unpacked.
    const filter = ({ name: path, size: packed, originalSize }: UnzipFileInfo) => {
      paths.push(path);
      size += Math.max(packed, originalSize);
      if (paths.length > MOST_FILES) throw new Error(`it has more than ${MOST_FILES} files`);
      if (size > most_bytes) throw new Error(`its files have ${size} bytes or more: expected at most ${most_bytes}`);
      return true;
    };
    checksums = checksumsOf(bytes);
    contents = unzipSync(bytes, { filter }) as typeof contents;
  } catch (cause) {
    if (cause instanceof RangeError) throw fault('its directory is missing or cut off');
    throw fault(messageOf(cause));
  }
  return paths.flatMap((path, index) => {
    const content = contents[path];
    if (!content || crc32(content) !== checksums[index]) throw fault(`${path} is damaged or encrypted`);
    return path.endsWith('/') ? [] : [{ name: path.split('/').pop() ?? path, bytes: content }];
  });
}

type Three = [number, number, number];

/** By hand, since fflate compares no checksums: those of the archive's directory, in its order. */
function checksumsOf(bytes: Uint8Array): number[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let end = bytes.length - 22;
  while (view.getUint32(end, true) !== 0x06054b50) end -= 1;
  let at = view.getUint32(end + 16, true);
  return Array.from({ length: view.getUint16(end + 8, true) }, (_, index) => {
    if (view.getUint32(at, true) !== 0x02014b50) throw new Error(`entry ${index + 1} of its directory is not there`);
    const checksum = view.getUint32(at + 16, true);
    const [label, extra, comment] = [28, 30, 32].map((offset) => view.getUint16(at + offset, true)) as Three;
    at += 46 + label + extra + comment;
    return checksum;
  });
}
