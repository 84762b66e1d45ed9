/** Many seeds of one planner, dealt over several workers: who has driven one gets the next. */

import type { Confined } from '../guest/confinement.ts';
import { type RunningJob, startJob } from './trialsClient.ts';
import type { Course, FromTrials, Summary, TrialResult } from './trialsProtocol.ts';

/** Each worker has the planners and the ground in memory of its own. */
const MOST_WORKERS = 4;

/** Somebody's own planner, which begins anew with each seed. */
export interface Guest {
  readonly name: string;
  begin(): Confined;
}

/** What there is to drive: each seed once. */
export interface Seeds {
  readonly course: Course;
  readonly planner: string;
  /** In place of the planner. */
  readonly guest?: Guest | undefined;
  readonly seeds: readonly number[];
}

export type FromBatch =
  /** `place` is that among the trials so far, in the order of the seeds. */
  | { type: 'trial'; result: TrialResult; place: number }
  | { type: 'summary'; summary: Summary }
  /** A seed that was not driven to its end. After a panic another worker drives on with the seeds that are left. */
  | { type: 'failed'; message: string }
  | { type: 'end' };

interface Member {
  readonly job: RunningJob;
  /** The seed that it drives; nothing once there are no more. */
  seed: number | undefined;
  /** Somebody's own planner while it drives that seed. */
  guest: Confined | undefined;
}

/** How many workers so many seeds are dealt over: one processor stays with the page. */
export function workersFor(seeds: number, processors: number): number {
  return Math.min(seeds, Math.max(1, processors - 1), MOST_WORKERS);
}

export class Batch {
  readonly #given: Seeds;
  readonly #tell: (message: FromBatch) => void;
  readonly #start: typeof startJob;
  readonly #members = new Set<Member>();
  readonly #results: TrialResult[] = [];
  #dealt = 0;
  /** Trials in the newest summary: workers may answer out of order. */
  #summed = 0;

  constructor(given: Seeds, workers: number, tell: (message: FromBatch) => void, start = startJob) {
    this.#given = given;
    this.#tell = tell;
    this.#start = start;
    for (let count = 0; count < workers; count += 1) this.#employ();
  }

  /** Ends all workers; nothing is heard of them any more. */
  stop(): void {
    for (const { job, guest } of this.#members) {
      job.stop();
      guest?.end();
    }
    this.#members.clear();
  }

  #employ(): void {
    const { course, planner } = this.#given;
    const job = this.#start({ type: 'seeds', course, planner }, (message) => this.#hear(member, message));
    const member: Member = { job, seed: undefined, guest: undefined };
    this.#members.add(member);
    this.#deal(member);
  }

  #deal(member: Member): void {
    member.guest?.end();
    member.guest = undefined;
    member.seed = this.#given.seeds[this.#dealt];
    if (member.seed === undefined) return;
    this.#dealt += 1;
    member.guest = this.#given.guest?.begin();
    member.job.send({ type: 'drive', seed: member.seed, port: member.guest?.port });
  }

  #hear(member: Member, message: FromTrials): void {
    if (message.type === 'trial') {
      this.#enter(message.result);
      // Who is free for a moment sums up.
      member.job.send({ type: 'sum', results: this.#results });
      this.#deal(member);
    } else if (message.type === 'summary') {
      if (message.summary.trials > this.#summed) {
        this.#summed = message.summary.trials;
        this.#tell({ type: 'summary', summary: message.summary });
      }
      if (member.seed === undefined) this.#leave(member);
    } else if (message.type === 'refused') {
      // Somebody's own planner may break off with one seed and not with another.
      this.#tell({ type: 'failed', message: `Seed ${member.seed}: ${this.#given.guest?.name} ${message.message}` });
      this.#deal(member);
      if (member.seed === undefined) this.#leave(member);
    } else if (message.type === 'failed') {
      this.#tell({ type: 'failed', message: `Seed ${member.seed}: ${message.message}` });
      // What else went wrong would go wrong again.
      if (message.panicked && this.#dealt < this.#given.seeds.length) this.#employ();
      this.#leave(member);
    }
  }

  /** Enters a result in the order of the seeds, so that sums do not depend on who was first. */
  #enter(result: TrialResult): void {
    const { seeds } = this.#given;
    const index = seeds.indexOf(result.seed);
    const after = this.#results.findIndex(({ seed }) => seeds.indexOf(seed) > index);
    const place = after < 0 ? this.#results.length : after;
    this.#results.splice(place, 0, result);
    this.#tell({ type: 'trial', result, place });
  }

  #leave(member: Member): void {
    member.job.stop();
    member.guest?.end();
    this.#members.delete(member);
    if (this.#members.size === 0) this.#tell({ type: 'end' });
  }
}
