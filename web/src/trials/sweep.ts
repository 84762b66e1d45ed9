/** One parameter over several values, each with the same seeds: one batch after the other, in the background. */

import { withOverride } from '../experiment/overrides.ts';
import { Batch, workersFor } from './batch.ts';
import type { Drawn, Swept } from './batchFiles.ts';
import type { Course, Summary, TrialResult } from './trialsProtocol.ts';

/** What is driven. */
export interface Sweep extends Drawn, Swept {
  readonly course: Course;
}

export interface SweptTrial {
  readonly value: number;
  readonly result: TrialResult;
}

export interface SweepEvents {
  trial(trial: SweptTrial): void;
  /** What all trials so far with one value show together. */
  summary(value: number, summary: Summary): void;
  failed(message: string): void;
  end(): void;
}

export class SweepRun {
  readonly #sweep: Sweep;
  readonly #events: SweepEvents;
  readonly #processors: number;
  #batch: Batch | undefined;
  #at = -1;

  constructor(sweep: Sweep, processors: number, events: SweepEvents) {
    [this.#sweep, this.#processors, this.#events] = [sweep, processors, events];
    this.#next();
  }

  /** Nothing is heard of it any more. */
  stop(): void {
    this.#batch?.stop();
    this.#batch = undefined;
  }

  #next(): void {
    this.#at += 1;
    const { course, planner, path, values, seeds } = this.#sweep;
    const value = values[this.#at];
    if (value === undefined) {
      this.#events.end();
      return;
    }
    const given = { course: { ...course, overrides: overridesWith(course, path, value) }, planner, seeds };
    const failures = new Set<string>();
    this.#batch = new Batch(given, workersFor(seeds.length, this.#processors), (message) => {
      if (message.type === 'trial') this.#events.trial({ value, result: message.result });
      else if (message.type === 'summary') this.#events.summary(value, message.summary);
      else if (message.type === 'end') this.#next();
      else {
        // A value that is refused is refused with every seed.
        const why = message.message.replace(/^Seed \d+: /, '');
        const words = why.startsWith(path) ? why : `${path} = ${value}: ${why}`;
        if (!failures.has(why)) this.#events.failed(words);
        failures.add(why);
      }
    });
  }
}

export function overridesWith({ overrides }: Pick<Course, 'overrides'>, path: string, value: number) {
  const end = path.lastIndexOf('.');
  return withOverride(overrides, path.slice(0, end), path.slice(end + 1), value);
}

/** Numbers that somebody wrote with commas or spaces between, each once; throws where one is none. */
export function valuesIn(text: string, whole: boolean, most: number): readonly number[] {
  const words = text.split(/[\s,;]+/).filter((word) => word !== '');
  const values = [...new Set(words.map(Number))];
  const expected = `expected ${whole ? 'whole numbers' : 'numbers'} with commas between, such as 1, 2, 3`;
  const bad = values.findIndex((value) => !(whole ? Number.isInteger(value) : Number.isFinite(value)));
  if (bad >= 0) throw new Error(`Values: “${words[bad]}”: ${expected}`);
  if (values.length === 0) throw new Error(`Values: ${expected}`);
  if (values.length > most) throw new Error(`Values: ${values.length}: expected at most ${most}`);
  return values;
}
