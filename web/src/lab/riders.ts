/** Those that drive as ghosts, in one worker. One begins anew only when something of its own has changed, or the course. */

import { GhostRun } from '../trials/ghostRun.ts';
import { type RunningJob, startJob } from '../trials/trialsClient.ts';
import type { Course, FromTrials, Rider } from '../trials/trialsProtocol.ts';

export interface RidersHeard {
  /** One has driven on; `entered` where it is the first that is heard of it. */
  driven(entered: boolean): void;
  /** What is wrong with one of them, or with all. */
  fault(rider: string | undefined, message: string): void;
}

/** One that drives, by a name that none before had: what is still heard of those is not its own. */
interface Driving {
  readonly name: string;
  readonly rider: Rider;
}

export class Riders {
  /** What each has driven, by its rider's name. */
  readonly runs = new Map<string, GhostRun>();
  readonly #heard: RidersHeard;
  #driving = new Map<string, Driving>();
  #job: RunningJob | undefined;
  #key = '';
  #count = 0;
  #until = 0;

  constructor(heard: RidersHeard) {
    this.#heard = heard;
  }

  /** Has these drive a course, which is another one where `key` is. */
  set(course: Course, seed: number, key: string, riders: readonly Rider[]): void {
    if (key !== this.#key || riders.length === 0) this.stop();
    if (riders.length === 0) return;
    this.#key = key;
    const driving = new Map(riders.map((rider) => [rider.name, this.#drivingAs(rider)]));
    for (const name of this.runs.keys()) {
      if (driving.get(name) !== this.#driving.get(name)) this.runs.delete(name);
    }
    this.#driving = driving;
    const named = [...driving.values()].map(({ name, rider }) => ({ ...rider, name }));
    if (this.#job) {
      this.#job.send({ type: 'riders', riders: named });
      return;
    }
    this.#job = startJob({ type: 'ghosts', course, riders: named, seed }, (message) => this.#hear(message));
    this.until(this.#until);
  }

  /** As far as they may drive. */
  until(tick: number): void {
    this.#until = tick;
    this.#job?.send({ type: 'until', tick });
  }

  stop(): void {
    this.#job?.stop();
    this.#job = undefined;
    this.#driving.clear();
    this.runs.clear();
  }

  #drivingAs(rider: Rider): Driving {
    const before = this.#driving.get(rider.name);
    if (before && JSON.stringify(before.rider) === JSON.stringify(rider)) return before;
    this.#count += 1;
    return { name: `${rider.name} ${this.#count}`, rider };
  }

  #hear(message: FromTrials): void {
    if (message.type === 'ghost') {
      const rider = this.#riderNamed(message.result.planner);
      if (rider === undefined) return;
      const run = this.runs.get(rider);
      if (run) run.extend(message.rows, message.result);
      else this.runs.set(rider, new GhostRun(message.rows, message.result));
      this.#heard.driven(!run);
    } else if (message.type === 'refused') {
      const rider = this.#riderNamed(message.planner);
      if (rider === undefined) return;
      // Asked for again, it is tried again.
      this.#driving.delete(rider);
      this.#heard.fault(rider, message.message);
    } else if (message.type === 'failed') {
      // What they have driven stays in sight.
      this.#job?.stop();
      [this.#job, this.#key] = [undefined, ''];
      this.#heard.fault(undefined, message.message);
    }
  }

  #riderNamed(name: string): string | undefined {
    return [...this.#driving].find(([, driving]) => driving.name === name)?.[0];
  }
}
