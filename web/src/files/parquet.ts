/** Tables in Parquet, as text like those in CSV. Loaded when such a file is opened. */

import { parquetReadObjects } from 'hyparquet';
import { messageOf } from '../base/messageOf.ts';
import type { Row } from './csv.ts';

/** The rows; what is absent is empty. Throws what is wrong with the file. */
export async function parquetRows(bytes: Uint8Array<ArrayBuffer>): Promise<Row[]> {
  const rows = await objectsIn(bytes);
  return rows.map((row) => Object.fromEntries(Object.entries(row).map(([name, value]) => [name, String(value ?? '')])));
}

async function objectsIn({ buffer, byteOffset, byteLength }: Uint8Array<ArrayBuffer>) {
  try {
    return await parquetReadObjects({ file: buffer.slice(byteOffset, byteOffset + byteLength) });
  } catch (cause) {
    throw new Error(`damaged (${messageOf(cause)}): expected Parquet with the trials of a campaign`, { cause });
  }
}
