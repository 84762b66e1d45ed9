/** Heights as files that other programs read: 16-bit PNG and ESRI ASCII grid. */

import { crc32 } from '@foxglove/crc';
import type { HeightField } from '../ground/heightField.ts';

/** Of the ground above its lowest point, at a millimetre a level. */
const MOST_RELIEF_M = 65.535;

/** By hand, since browsers write 8 bits alone: 16-bit greyscale, the first row north, a level for each millimetre above the lowest point; pHYs holds the spacing. */
export async function heightsPng(field: HeightField): Promise<Blob> {
  const { columns, rows, cell_m, min_m, max_m } = field;
  if (max_m - min_m > MOST_RELIEF_M) {
    const relief = (max_m - min_m).toFixed(1);
    throw new Error(
      `The ground rises by ${relief} m: a PNG holds at most ${MOST_RELIEF_M} m. The ASCII grid holds it.`,
    );
  }
  const perMetre = Math.round(1 / cell_m);
  if (Math.abs(perMetre * cell_m - 1) > 1e-9) {
    throw new Error(`Samples are ${cell_m} m apart: a PNG holds whole pixels per metre. The ASCII grid holds it.`);
  }
  const lines = new DataView(new ArrayBuffer(rows * (1 + 2 * columns)));
  for (let row = 0; row < rows; row += 1) {
    // Each line begins with the number of its filter: none.
    const begin = (rows - 1 - row) * (1 + 2 * columns) + 1;
    for (let column = 0; column < columns; column += 1) {
      const height_m = field.heights_m[row * columns + column] ?? 0;
      lines.setUint16(begin + 2 * column, Math.round(1000 * (height_m - min_m)));
    }
  }
  const deflated = new Blob([lines.buffer]).stream().pipeThrough(new CompressionStream('deflate'));
  const [sixteenBits, grey, noInterlace, metres] = [16, 0, 0, 1];
  const header = numbers([columns, rows], [sixteenBits, grey, 0, 0, noInterlace]);
  const spacing = numbers([perMetre, perMetre], [metres]);
  const signature = Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a);
  const data = new Uint8Array(await new Response(deflated).arrayBuffer());
  const chunks = [chunk('IHDR', header), chunk('pHYs', spacing), chunk('IDAT', data), chunk('IEND', new Uint8Array())];
  return new Blob([signature, ...chunks], { type: 'image/png' });
}

/** Whole numbers of four bytes, then of one. */
function numbers(long: readonly number[], short: readonly number[]): Uint8Array<ArrayBuffer> {
  const view = new DataView(new ArrayBuffer(4 * long.length + short.length));
  for (const [at, value] of long.entries()) view.setUint32(4 * at, value);
  for (const [at, value] of short.entries()) view.setUint8(4 * long.length + at, value);
  return new Uint8Array(view.buffer);
}

function chunk(type: string, data: Uint8Array<ArrayBuffer>): Uint8Array<ArrayBuffer> {
  const result = new Uint8Array(12 + data.length);
  const view = new DataView(result.buffer);
  view.setUint32(0, data.length);
  result.set(new TextEncoder().encode(type), 4);
  result.set(data, 8);
  view.setUint32(8 + data.length, crc32(result.subarray(4, 8 + data.length)));
  return result;
}

/** Every digit that a height has, so that reading it gives the same bits. */
export function heightsAscii({ columns, rows, cell_m, heights_m }: HeightField): Blob {
  const head = [`ncols ${columns}`, `nrows ${rows}`, 'xllcorner 0', 'yllcorner 0', `cellsize ${cell_m}`];
  const lines = Array.from({ length: rows }, (_, line) => {
    const row = rows - 1 - line;
    return heights_m.subarray(row * columns, (row + 1) * columns).join(' ');
  });
  return new Blob([[...head, ...lines, ''].join('\n')], { type: 'text/plain' });
}
