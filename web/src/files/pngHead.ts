/** What a PNG says of itself before its pixels. */

export interface PngHead {
  readonly columns: number;
  readonly rows: number;
  /** Bits of each number. */
  readonly bits: number;
  /** Spacing of the pixels, where the file has a plausible one. */
  readonly cell_m: number | undefined;
}

const SIGNATURE = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
const METRES = 1;
/** A printer has more dots in a metre. */
const MOST_PER_METRE = 100;

/** Nothing where it is none; whether its pixels can be read, the reader of heights says. */
export function pngHead(bytes: Uint8Array): PngHead | undefined {
  if (bytes.length < 33 || SIGNATURE.some((byte, at) => bytes[at] !== byte)) return undefined;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const [columns, rows] = [view.getUint32(16), view.getUint32(20)];
  return { columns, rows, bits: view.getUint8(24), cell_m: spacing(view) };
}

function spacing(view: DataView): number | undefined {
  for (let at = 8; at + 21 <= view.byteLength; at += 12 + view.getUint32(at)) {
    const type = String.fromCharCode(...[4, 5, 6, 7].map((offset) => view.getUint8(at + offset)));
    if (type === 'IDAT') return undefined;
    if (type !== 'pHYs') continue;
    const [east, north, unit] = [view.getUint32(at + 8), view.getUint32(at + 12), view.getUint8(at + 16)];
    const plausible = unit === METRES && east === north && east >= 1 && east <= MOST_PER_METRE;
    return plausible ? 1 / east : undefined;
  }
  return undefined;
}
