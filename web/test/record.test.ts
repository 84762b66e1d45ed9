import assert from 'node:assert/strict';
import { test } from 'node:test';
import { MAX_ROWS, ROW, RunRecord } from '../src/run/record.ts';

function rows(from: number, to: number, x = 0): Float64Array {
  const values = new Float64Array((to - from) * ROW.length);
  for (let tick = from; tick < to; tick += 1) {
    values.set([tick, 0.1 * tick, x], (tick - from) * ROW.length);
  }
  return values;
}

test('a record keeps every tick while it grows', () => {
  const record = new RunRecord();
  for (let tick = 0; tick < 5000; tick += 7) record.add(rows(tick, tick + 7, tick));
  assert.equal(record.length, 5005);
  assert.equal(record.get(4000, 'tick'), 4000);
  assert.equal(record.get(4000, 'x'), 4000 - (4000 % 7));
  assert.equal(record.cut, false);
});

test('a copy stays as it was while the record goes on', () => {
  const record = new RunRecord();
  record.add(rows(0, 100));
  const copy = record.copy();
  record.end(50);
  record.add(rows(50, 120, 9));
  assert.equal(copy.length, 100);
  assert.equal(copy.get(60, 'x'), 0);
  copy.add(rows(100, 2000));
  assert.equal(copy.length, 2000);
});

test('what is run again leaves the rest as it was, until the run goes another way', () => {
  const record = new RunRecord();
  record.add(rows(0, 100));
  record.add(rows(40, 42, 9));
  assert.equal(record.length, 100);
  assert.deepEqual(
    [39, 40, 41, 42].map((row) => record.get(row, 'x')),
    [0, 9, 9, 0],
  );
  record.end(42);
  assert.equal(record.length, 42);
  record.add(rows(42, 50, 7));
  assert.deepEqual([record.length, record.get(49, 'x')], [50, 7]);
  record.end(0);
  assert.equal(record.length, 0);
});

test('a gap is refused', () => {
  const record = new RunRecord();
  record.add(rows(0, 10));
  assert.throws(() => record.add(rows(11, 12)), /Tick 11 does not follow/);
});

test('an endless run keeps its last three quarters of an hour at least', () => {
  const record = new RunRecord();
  for (let tick = 0; tick < 2 * MAX_ROWS; tick += 500) record.add(rows(tick, tick + 500));
  assert.equal(record.cut, true);
  assert.ok(record.length > 0.7 * MAX_ROWS && record.length <= MAX_ROWS);
  assert.equal(record.get(record.length - 1, 'tick'), 2 * MAX_ROWS - 1);
  assert.equal(record.get(0, 'tick'), 2 * MAX_ROWS - record.length);
});

test('a time finds the nearest tick', () => {
  const record = new RunRecord();
  assert.equal(record.at(1), -1);
  record.add(rows(0, 50));
  assert.deepEqual(
    [-1, 0.04, 0.06, 2.31, 99].map((time_s) => record.at(time_s)),
    [0, 0, 1, 23, 49],
  );
});

test('half a row is refused', () => {
  assert.throws(() => new RunRecord().add(new Float64Array(3)), /3 values/);
});

test('the metrics of a tick are those of its row', () => {
  const record = new RunRecord();
  record.add(rows(0, 30));
  const row = rows(30, 31);
  row[ROW.indexOf('distance_m')] = 7;
  record.add(row);
  assert.equal(record.metricsAt(30)?.distance_m, 7);
  assert.equal(record.metricsAt(29)?.distance_m, 0);
  assert.equal(record.metricsAt(31), undefined);
  assert.equal(new RunRecord().metricsAt(0), undefined);
});
