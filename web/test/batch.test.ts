import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Batch, type FromBatch, type Guest, workersFor } from '../src/trials/batch.ts';
import type { startJob } from '../src/trials/trialsClient.ts';
import type { FromTrials, Summary, ToTrials, TrialResult } from '../src/trials/trialsProtocol.ts';

/** A worker that answers when the test says so. */
class Worker {
  readonly heard: ToTrials[] = [];
  stopped = false;
  answer: (message: FromTrials) => void = () => undefined;

  /** The seeds that it was given so far. */
  get seeds(): number[] {
    return this.heard.flatMap((message) => (message.type === 'drive' ? [message.seed] : []));
  }

  /** Drives its seed to the end, and sums up. */
  finish(): void {
    this.answer({ type: 'trial', result: { seed: this.seeds.at(-1) } as TrialResult });
    this.sum();
  }

  sum(): void {
    const asked = this.heard.findLast((message) => message.type === 'sum');
    this.answer({ type: 'summary', summary: { trials: asked?.results.length } as Summary });
  }
}

function batchOf(seeds: readonly number[], count: number, guest?: Guest) {
  const workers: Worker[] = [];
  const told: FromBatch[] = [];
  const rows: number[] = [];
  const start: typeof startJob = (_job, answer) => {
    const worker = new Worker();
    worker.answer = (message) => !worker.stopped && answer(message);
    workers.push(worker);
    return {
      // As across a real border, what is sent later changes nothing that was sent; a port goes over.
      send: (message) => {
        const transfer = message.type === 'drive' && message.port ? [message.port] : [];
        worker.heard.push(structuredClone(message, { transfer }));
      },
      stop() {
        worker.stopped = true;
      },
    };
  };
  const hear = (message: FromBatch) => {
    told.push(message);
    if (message.type === 'trial') rows.splice(message.place, 0, message.result.seed);
  };
  const batch = new Batch({ course: {} as never, planner: 'default', guest, seeds }, count, hear, start);
  const summed = () => told.flatMap((message) => (message.type === 'summary' ? [message.summary.trials] : []));
  return { batch, workers: workers as [Worker, Worker], told, rows, summed };
}

test('one processor stays with the page, and there are no more workers than seeds', () => {
  assert.deepEqual(
    [workersFor(10, 1), workersFor(10, 2), workersFor(10, 4), workersFor(2, 8), workersFor(10, 64)],
    [1, 1, 3, 2, 4],
  );
});

test('who is done gets the next seed; rows and sums are in the order of the seeds', () => {
  const { workers, told, rows, summed } = batchOf([7, 8, 9, 0], 2);
  const [a, b] = workers;
  b.finish();
  b.finish();
  assert.deepEqual([a.seeds, b.seeds], [[7], [8, 9, 0]]);
  a.finish();
  assert.deepEqual(rows, [7, 8, 9]);
  assert.equal(told.at(-1)?.type, 'summary');
  b.finish();
  assert.deepEqual(rows, [7, 8, 9, 0]);
  const asked = b.heard.findLast((message) => message.type === 'sum');
  assert.deepEqual(
    asked?.results.map(({ seed }) => seed),
    [7, 8, 9, 0],
  );
  assert.deepEqual(summed(), [1, 2, 3, 4]);
  assert.equal(told.at(-1)?.type, 'end');
  assert.ok(a.stopped && b.stopped);
});

test('a sum that comes late does not replace one of more trials', () => {
  const { workers, told, summed } = batchOf([1, 2], 2);
  const [a, b] = workers;
  a.answer({ type: 'trial', result: { seed: 1 } as TrialResult });
  b.finish();
  a.sum();
  assert.deepEqual(summed(), [2]);
  assert.equal(told.at(-1)?.type, 'end');
});

test('a panic is told with its seed, and another worker drives on', () => {
  const { workers, told, rows } = batchOf([1, 2, 3], 1);
  const [a] = workers;
  a.answer({ type: 'failed', message: 'unreachable', panicked: true });
  assert.deepEqual(told, [{ type: 'failed', message: 'Seed 1: unreachable' }]);
  assert.ok(a.stopped);
  const [, b] = workers;
  b.finish();
  b.finish();
  assert.deepEqual(rows, [2, 3]);
  assert.equal(told.at(-1)?.type, 'end');
});

test('a worker that cannot begin is not tried again; the others drive what is left', () => {
  const { workers, told, rows } = batchOf([1, 2, 3], 2);
  const [a, b] = workers;
  a.answer({ type: 'failed', message: 'not there', panicked: false });
  b.finish();
  b.finish();
  assert.equal(workers.length, 2);
  assert.deepEqual(rows, [2, 3]);
  assert.equal(told.at(-1)?.type, 'end');
});

test('cancelling ends every worker, and nothing is heard any more', () => {
  const { batch, workers, told } = batchOf([1, 2, 3], 2);
  batch.stop();
  assert.ok(workers.every(({ stopped }) => stopped));
  workers[0].finish();
  assert.deepEqual(told, []);
});

test('a planner of one’s own begins anew with each seed; one that breaks off is told, and the rest is driven', () => {
  let [begun, ended] = [0, 0];
  const begin = () => {
    begun += 1;
    const end = () => {
      ended += 1;
    };
    return { port: new MessageChannel().port1, end };
  };
  const { workers, told, rows } = batchOf([1, 2, 3], 1, { name: 'planner.js', begin });
  const [a] = workers;
  assert.ok(a.heard.every((message) => message.type !== 'drive' || message.port));
  a.finish();
  a.answer({ type: 'refused', planner: 'own', message: 'at 0.1 s: no' });
  assert.deepEqual(told.at(-1), { type: 'failed', message: 'Seed 2: planner.js at 0.1 s: no' });
  assert.deepEqual([begun, ended], [3, 2]);
  a.finish();
  assert.deepEqual(rows, [1, 3]);
  assert.equal(told.at(-1)?.type, 'end');
  assert.deepEqual([begun, ended, a.stopped], [3, 3, true]);
});
