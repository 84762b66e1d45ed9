import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync, gzipSync } from 'node:zlib';
import { expect, test } from '@playwright/test';

/** Bytes of the built files whose names pass, compressed as a static host sends them. */
function sent(passes: (name: string) => boolean): { gzip: number; brotli: number } {
  const sizes = { gzip: 0, brotli: 0 };
  for (const entry of readdirSync('dist', { recursive: true, withFileTypes: true })) {
    if (!entry.isFile() || !passes(entry.name)) continue;
    const content = readFileSync(join(entry.parentPath, entry.name));
    sizes.gzip += gzipSync(content, { level: 9 }).length;
    sizes.brotli += brotliCompressSync(content).length;
  }
  return sizes;
}

test('the page keeps to its budget: 370 kB of wasm (470 kB as gzip) to begin with, 400 kB of all else', () => {
  const core = sent((name) => /^mapless_wasm_bg.*\.wasm$/.test(name));
  // Loaded by those alone who open a file of heights.
  const heights = sent((name) => /^mapless_wasm_heights_bg.*\.wasm$/.test(name));
  // Or a world of Verti-Bench, whose description needs a reader of YAML.
  const vertiBench = sent((name) => /^mapless_wasm_verti_bench_bg.*\.wasm$/.test(name));
  // And by those alone who open a table in Parquet, a robot's recording, or such a world, an address or a saved run.
  const isParquet = (name: string) => /^parquet-.*\.js$/.test(name);
  const parquet = sent(isParquet);
  const isRecording = (name: string) =>
    /^(recorded|recordedDrive|recordedFrame|drivePanel|supervisorPanel|topicsForm|recordingWorker|mapless_wasm_replay)-.*\.(js|css)$/.test(
      name,
    );
  const recording = sent(isRecording);
  const isElsewhere = (name: string) =>
    /^(addressFiles|savedRun|vertiBenchSheet|vertiBenchModule|mapless_wasm_verti_bench)-.*\.js$/.test(name);
  const elsewhere = sent(isElsewhere);
  const isOnDemand = (name: string) => [isParquet, isRecording, isElsewhere].some((is) => is(name));
  const rest = sent((name) => !name.endsWith('.wasm') && !isOnDemand(name));
  test.info().annotations.push({
    type: 'bytes',
    description: JSON.stringify({ core, heights, vertiBench, parquet, recording, elsewhere, rest }),
  });
  for (const onDemand of [parquet, recording, elsewhere]) {
    expect(onDemand.gzip).toBeGreaterThan(0);
    expect(onDemand.gzip, JSON.stringify(onDemand)).toBeLessThan(20_000);
  }
  expect(core.brotli).toBeGreaterThan(0);
  // Hosts that know brotli send the first, all send the second.
  expect(core.brotli, JSON.stringify(core)).toBeLessThan(370_000);
  expect(core.gzip, JSON.stringify(core)).toBeLessThan(470_000);
  expect(heights.brotli, JSON.stringify(heights)).toBeLessThan(160_000);
  expect(vertiBench.brotli, JSON.stringify(vertiBench)).toBeLessThan(230_000);
  expect(rest.gzip, JSON.stringify(rest)).toBeLessThan(400_000);
});
