import assert from 'node:assert/strict';
import { test } from 'node:test';
import { crc32, inflateSync } from 'node:zlib';
import { crc32 as ours } from '../src/files/checksum.ts';
import { heightsAscii, heightsPng } from '../src/files/heights.ts';
import { unzip } from '../src/files/unzip.ts';
import { zip } from '../src/files/zip.ts';
import { HeightField } from '../src/ground/heightField.ts';

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

const FILES = [
  { name: 'scenario.toml', bytes: new TextEncoder().encode('seed = 1\n') },
  { name: 'terrain.asc', bytes: new Uint8Array(3000).fill(49) },
];

async function archived(): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await zip(FILES).arrayBuffer());
}

function opened(bytes: Uint8Array<ArrayBuffer>) {
  return unzip({ name: 'a.zip', bytes }).map((file) => ({ ...file, bytes: Uint8Array.from(file.bytes) }));
}

test('an archive is read back, with a comment after it and within a larger buffer, too', async () => {
  const bytes = await archived();
  assert.deepEqual(opened(bytes), FILES);
  const commented = new Uint8Array(bytes.length + 5);
  commented.set(bytes);
  commented[bytes.length - 2] = 5;
  assert.deepEqual(opened(commented), FILES);
  const larger = new Uint8Array(bytes.length + 20);
  larger.set(bytes, 10);
  assert.deepEqual(opened(larger.subarray(10, bytes.length + 10)), FILES);
});

test('an archive that is cut short or lies is refused, whatever byte is wrong', async () => {
  const bytes = await archived();
  for (let length = 0; length < bytes.length; length += 1) {
    assert.throws(() => opened(bytes.slice(0, length)), /^Error: a.zip: not a ZIP file that this page reads: /);
  }
  for (let at = 0; at < bytes.length; at += 1) {
    for (const flip of [0x01, 0x80, 0xff]) {
      const damaged = bytes.slice();
      damaged[at] = (damaged[at] ?? 0) ^ flip;
      try {
        // Names and dates may be others; what is in the files is not.
        assert.deepEqual(
          opened(damaged).map((file) => file.bytes),
          FILES.map((file) => file.bytes),
        );
      } catch (error) {
        assert.match(String(error), /^Error: a.zip: not a ZIP file that this page reads: |^AssertionError.*at most/);
      }
    }
  }
});

test('what an archive claims is bounded by what it holds', async () => {
  const bytes = await archived();
  const end = bytes.length - 22;
  const view = new DataView(bytes.buffer);
  const entry = view.getUint32(end + 16, true);
  const lie = (at: number, ...values: number[]) => {
    const copy = bytes.slice();
    copy.set(values, at);
    return () => opened(copy);
  };
  assert.throws(lie(end + 10, 255, 255), /65535 files: expected at most 100/);
  assert.throws(lie(end + 10, 3), /entry 3 of its directory is not there/);
  assert.throws(lie(end + 16, 255, 255, 255, 255), /entry 1 of its directory is not there/);
  assert.throws(lie(entry + 10, 8), /scenario.toml is packed or encrypted/);
  assert.throws(lie(entry + 20, 255, 255, 255, 255, 255, 255, 255, 255), /scenario.toml has 4294967295 bytes/);
  assert.throws(lie(entry + 42, 255, 255, 255, 255), /scenario.toml is cut off or not where its directory says/);
  assert.throws(lie(entry + 16, 0), /scenario.toml does not have its checksum/);
});
