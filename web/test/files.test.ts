import assert from 'node:assert/strict';
import { test } from 'node:test';
import { crc32, inflateRawSync, inflateSync } from 'node:zlib';
import { zipSync } from 'fflate';
import { unzip, zip } from '../src/files/archive.ts';
import { heightsAscii, heightsPng } from '../src/files/heights.ts';
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
    const size = archive.readUInt32LE(at + 20);
    assert.equal(archive.subarray(at + 46, at + 46 + name.length).toString(), name);
    const local = archive.readUInt32LE(at + 42);
    assert.equal(archive.readUInt32LE(local), 0x04034b50);
    const begin = local + 30 + name.length;
    assert.deepEqual(new Uint8Array(inflateRawSync(archive.subarray(begin, begin + size))), bytes);
    at += 46 + name.length;
  }
});

test('the same files give the same archive on any day', async () => {
  const now = Date.now;
  const first = await archived();
  Date.now = () => now() + 400 * 86_400_000;
  try {
    assert.deepEqual(await archived(), first);
  } finally {
    Date.now = now;
  }
});

const FILES = [
  { name: 'scenario.toml', bytes: new TextEncoder().encode('seed = 1\n') },
  { name: 'terrain.asc', bytes: new Uint8Array(3000).fill(49) },
];
const MOST_BYTES = 4000;

/** Packed, as the page writes them. */
async function archived(): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await zip(FILES).arrayBuffer());
}

const EMPTY = new Uint8Array();

/** Stored as they are, with a folder, as other programs write them. */
function stored(): Uint8Array<ArrayBuffer> {
  return zipSync({ mine: Object.fromEntries(FILES.map(({ name, bytes }) => [name, bytes])) }, { level: 0 });
}

function opened(bytes: Uint8Array<ArrayBuffer>) {
  return unzip({ name: 'a.zip', bytes }, MOST_BYTES).map((file) => ({ ...file, bytes: Uint8Array.from(file.bytes) }));
}

test('an archive is read back, with a comment after it and within a larger buffer, too', async () => {
  for (const bytes of [await archived(), stored()]) {
    assert.deepEqual(opened(bytes), FILES);
    const commented = new Uint8Array(bytes.length + 5);
    commented.set(bytes);
    commented[bytes.length - 2] = 5;
    assert.deepEqual(opened(commented), FILES);
    const larger = new Uint8Array(bytes.length + 20);
    larger.set(bytes, 10);
    assert.deepEqual(opened(larger.subarray(10, bytes.length + 10)), FILES);
  }
});

test('an archive that is cut short or lies is refused, whatever byte is wrong', async () => {
  for (const bytes of [await archived(), stored()]) {
    for (let length = 0; length < bytes.length; length += 1) {
      assert.throws(() => opened(bytes.slice(0, length)), /^Error: a.zip: not a ZIP file that this page reads: /);
    }
    for (let at = 0; at < bytes.length; at += 1) {
      for (const flip of [0x01, 0x80, 0xff]) {
        const damaged = bytes.slice();
        damaged[at] = (damaged[at] ?? 0) ^ flip;
        let files: ReturnType<typeof opened>;
        try {
          files = opened(damaged);
        } catch (error) {
          assert.match(String(error), /^Error: a.zip: not a ZIP file that this page reads: /);
          continue;
        }
        // Names and dates may be others, and a folder an empty file; what is in the files is not.
        const right = [...FILES.map((file) => file.bytes), EMPTY];
        for (const file of files) assert.ok(right.some((bytes) => Buffer.compare(bytes, file.bytes) === 0));
      }
    }
  }
});

test('what an archive claims is bounded, and each refusal says why', () => {
  const bytes = stored();
  const end = bytes.length - 22;
  const view = new DataView(bytes.buffer);
  const entry = view.getUint32(end + 16, true);
  const folder = 46 + 'mine/'.length;
  const lie = (at: number, ...values: number[]) => {
    const copy = bytes.slice();
    copy.set(values, at);
    return () => opened(copy);
  };
  const first = entry + (view.getUint16(entry + 28, true) === 5 ? folder : 0);
  const most = [255, 255, 255, 255];
  const many = zipSync(Object.fromEntries(Array.from({ length: 101 }, (_, index) => [`${index}.toml`, EMPTY])));
  assert.throws(() => opened(many), /^Error: a.zip: not a ZIP file that this page reads: it has more than 100 files/);
  assert.throws(lie(end + 8, 255, 127), /: entry 4 of its directory is not there/);
  assert.throws(lie(end + 16, ...most), /: its directory is missing or cut off/);
  assert.throws(lie(first + 10, 99), /: unknown compression type 99/);
  assert.throws(lie(first + 20, ...most), /: its files have 4294967295 bytes or more: expected at most 4000/);
  assert.throws(lie(first + 24, ...most), /: its files have 4294967295 bytes or more: expected at most 4000/);
  assert.throws(lie(first + 42, ...most), /: mine\/scenario.toml is damaged or encrypted/);
  assert.throws(lie(first + 16, 0), /: mine\/scenario.toml is damaged or encrypted/);
});
