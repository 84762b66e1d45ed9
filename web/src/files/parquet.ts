/** Tables in Parquet, as text like those in CSV. Loaded when such a file is opened. */

import { parquetReadObjects } from 'hyparquet';
import type { Row } from './csv.ts';

/** The rows; what is absent is empty. Throws what is wrong with the file. */
export async function parquetRows({ buffer, byteOffset, byteLength }: Uint8Array<ArrayBuffer>): Promise<Row[]> {
  const rows = await parquetReadObjects({ file: buffer.slice(byteOffset, byteOffset + byteLength) });
  return rows.map((row) => Object.fromEntries(Object.entries(row).map(([name, value]) => [name, String(value ?? '')])));
}
