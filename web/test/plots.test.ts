import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SERIES, sample } from '../src/plots/series.ts';
import { levels, pan, ticks, zoom } from '../src/plots/span.ts';
import { ROW, RunRecord } from '../src/run/record.ts';

/** A record whose rows have these values; time runs by tenths of a second. */
function record(count: number, values: (tick: number) => Partial<Record<(typeof ROW)[number], number>>): RunRecord {
  const made = new RunRecord();
  for (let tick = 0; tick < count; tick += 1) {
    const row: Record<string, number> = { tick, time_s: tick / 10, ...values(tick) };
    made.add(Float64Array.from(ROW, (name) => row[name] ?? 0));
  }
  return made;
}

function series(key: string) {
  const found = SERIES.find((one) => one.key === key);
  assert.ok(found);
  return found;
}

test('a value of one tick is taken out of the mean since the start', () => {
  // Ten ticks at 2 cm/s, then ten at 6.
  const rates = (tick: number) => (tick <= 10 ? 2 : (10 * 2 + (tick - 10) * 6) / tick);
  const run = record(21, (tick) => ({ mean_elevation_rate_cm_s: tick === 0 ? 0 : rates(tick) }));
  const rate = series('elevation_rate');
  assert.ok(Number.isNaN(rate.value(run, 0)));
  assert.ok(Math.abs(rate.value(run, 5) - 2) < 1e-9);
  assert.ok(Math.abs(rate.value(run, 20) - 6) < 1e-9);
});

test('curvature has no value at a standstill', () => {
  const run = record(2, (tick) => ({ omega_rad_s: -0.5, v_m_s: tick === 0 ? 0.01 : 0.25 }));
  assert.ok(Number.isNaN(series('curvature').value(run, 0)));
  assert.equal(series('curvature').value(run, 1), 2);
});

test('thinning keeps every peak', () => {
  const run = record(10_000, (tick) => ({ roll: tick === 7_777 ? 0.5 : tick === 123 ? -0.4 : 0.1 }));
  const { points, lowest, highest } = sample(run, series('roll'), 0, run.length, 300);
  assert.ok(points.length <= 4 * 301);
  assert.ok(Math.abs(highest - (0.5 * 180) / Math.PI) < 1e-9 && Math.abs(lowest + (0.4 * 180) / Math.PI) < 1e-9);
  assert.ok(points.includes(777.7) && points.includes(12.3));
  const times = points.filter((_, index) => index % 2 === 0);
  assert.deepEqual(
    times,
    [...times].sort((a, b) => a - b),
  );
});

test('a stretch without values breaks the line', () => {
  const run = record(30, (tick) => ({ omega_rad_s: 1, v_m_s: tick >= 10 && tick < 20 ? 0 : 1 }));
  const { points } = sample(run, series('curvature'), 0, 30, 30);
  const missing = points.filter((value, index) => index % 2 === 1 && Number.isNaN(value));
  assert.equal(missing.length, 10);
});

test('zoom keeps the time under the pointer, and stays within the run', () => {
  const whole = { from_s: 0, to_s: 100 };
  const near = zoom(whole, 30, 0.5, whole);
  assert.deepEqual(near, { from_s: 15, to_s: 65 });
  assert.deepEqual(zoom(near, 30, 100, whole), whole);
  assert.deepEqual(zoom(whole, 100, 0.25, whole), { from_s: 75, to_s: 100 });
  const closest = zoom(near, 30, 1e-9, whole);
  assert.ok(Math.abs(closest.to_s - closest.from_s - 2) < 1e-9);
  assert.deepEqual(pan(near, 80, whole), { from_s: 50, to_s: 100 });
  assert.deepEqual(pan(near, -80, whole), { from_s: 0, to_s: 50 });
});

test('time ticks are round', () => {
  assert.deepEqual(ticks({ from_s: 0, to_s: 100 }, 5), [0, 20, 40, 60, 80, 100]);
  assert.deepEqual(ticks({ from_s: 61, to_s: 64 }, 3), [61, 62, 63, 64]);
});

test('the numbers of an axis are round, few, and at least one beside zero', () => {
  assert.deepEqual(levels(-5.6, 5.6, 1.7), [-5, 0, 5]);
  assert.deepEqual(levels(-33, 33, 6), [-20, 0, 20]);
  assert.deepEqual(levels(0, 0.07, 1.7), [0, 0.05]);
  assert.deepEqual(levels(0, 5.8, 6), [0, 1, 2, 3, 4, 5]);
  for (const most of [0.0112, 0.5, 1.1, 1.9, 3, 7, 42, 99, 1000]) {
    for (const least of [0, -most]) {
      for (const count of [1.2, 1.7, 5]) {
        const values = levels(least, most, count);
        assert.ok(values.length >= 2 && values.length <= 2 * count + 3, `${least} to ${most}: ${values}`);
        assert.ok(values.includes(0) && values.every((value) => value >= least && value <= most), `${values}`);
      }
    }
  }
});
