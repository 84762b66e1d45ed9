import assert from 'node:assert/strict';
import { test } from 'node:test';
import { crc32, inflateSync } from 'node:zlib';
import { crc32 as ours } from '../src/files/checksum.ts';
import { heightsAscii, heightsPng } from '../src/files/heights.ts';
import { zip } from '../src/files/zip.ts';
import { HeightField } from '../src/scene/heightfield.ts';

const FIELD = new HeightField({
  columns: 3,
  rows: 2,
  cell_m: 0.2,
  heights_m: Float32Array.of(-1.5, -1.25, -1, 0, 0.1, 0.2345),
});

async function bytesOf(blob: Blob): Promise<Buffer> {
  return Buffer.from(await blob.arrayBuffer());
}

test('the checksum is that of zlib', () => {
  for (const text of ['', 'a', 'mapless', 'x'.repeat(1000)]) {
    const bytes = new TextEncoder().encode(text);
    assert.equal(ours(bytes), crc32(bytes));
  }
});

test('a PNG holds millimetres above the lowest point, the north first, and the spacing', async () => {
  const png = await bytesOf(await heightsPng(FIELD));
  assert.equal(png.subarray(0, 8).toString('hex'), '89504e470d0a1a0a');
  const chunks = new Map<string, Buffer>();
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    const length = png.readUInt32BE(at);
    const body = png.subarray(at + 4, at + 8 + length);
    assert.equal(png.readUInt32BE(at + 8 + length), crc32(body));
    chunks.set(body.subarray(0, 4).toString(), body.subarray(4));
  }
  assert.equal(chunks.get('IHDR')?.toString('hex'), '00000003000000021000000000');
  assert.equal(chunks.get('pHYs')?.toString('hex'), '000000050000000501');
  const lines = inflateSync(chunks.get('IDAT') ?? Buffer.alloc(0));
  const levels = [1, 3, 5, 8, 10, 12].map((at) => lines.readUInt16BE(at));
  assert.deepEqual(levels, [1500, 1600, 1735, 0, 250, 500]);
});

test('ground that a PNG cannot hold is refused', async () => {
  const of = (cell_m: number, ...heights_m: number[]) =>
    new HeightField({ columns: 2, rows: 2, cell_m, heights_m: Float32Array.from(heights_m) });
  await assert.rejects(heightsPng(of(0.2, 0, 0, 0, 70)), /rises by 70.0 m: a PNG holds at most 65.535 m/);
  await assert.rejects(heightsPng(of(0.3, 0, 0, 0, 1)), /0.3 m apart: a PNG holds whole pixels per metre/);
});

test('an ASCII grid holds every digit', async () => {
  const text = (await bytesOf(heightsAscii(FIELD))).toString();
  const lines = text.trimEnd().split('\n');
  assert.deepEqual(lines.slice(0, 2), ['ncols 3', 'nrows 2']);
  const values = [...(lines[6] ?? '').split(' '), ...(lines[5] ?? '').split(' ')].map(Number);
  assert.deepEqual(Float32Array.from(values), FIELD.heights_m);
});

test('an archive lists its files with their sizes, places and checksums', async () => {
  const encode = (text: string) => new TextEncoder().encode(text);
  const files = [
    { name: 'scenario.toml', bytes: encode('seed = 1\n') },
    { name: 'terrain.toml', bytes: encode('name = "x"\n') },
  ];
  const archive = await bytesOf(zip(files));
  const end = archive.length - 22;
  assert.equal(archive.readUInt32LE(end), 0x06054b50);
  assert.equal(archive.readUInt16LE(end + 10), 2);
  assert.equal(archive.readUInt32LE(end + 12) + archive.readUInt32LE(end + 16), end);
  let at = archive.readUInt32LE(end + 16);
  for (const { name, bytes } of files) {
    assert.equal(archive.readUInt32LE(at), 0x02014b50);
    assert.equal(archive.readUInt32LE(at + 16), crc32(bytes));
    assert.equal(archive.subarray(at + 46, at + 46 + name.length).toString(), name);
    const local = archive.readUInt32LE(at + 42);
    assert.equal(archive.readUInt32LE(local), 0x04034b50);
    const begin = local + 30 + name.length;
    assert.deepEqual(new Uint8Array(archive.subarray(begin, begin + bytes.length)), bytes);
    at += 46 + name.length;
  }
});
