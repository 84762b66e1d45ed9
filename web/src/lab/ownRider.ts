/** Somebody's own planner that drives as a ghost, confined, asked from a worker of its own. */

import { fixed } from '../base/format.ts';
import { type Confined, confine, type OwnPlanner } from '../guest/confinement.ts';
import { GhostRun } from '../trials/ghostRun.ts';
import { type RunningJob, startJob } from '../trials/trialsClient.ts';
import type { Course, FromTrials } from '../trials/trialsProtocol.ts';
import type { RidersHeard } from './riders.ts';

export interface OwnRiderHeard extends RidersHeard {
  /** How it gets on. */
  said(words: string): void;
  /** It does not drive on, and why. */
  broke(words: string): void;
}

export class OwnRider {
  readonly #heard: OwnRiderHeard;
  #job: RunningJob | undefined;
  #confined: Confined | undefined;
  #run: GhostRun | undefined;
  #broken = false;
  /** What it began on. */
  #key = '';
  #until = 0;

  constructor(heard: OwnRiderHeard) {
    this.#heard = heard;
  }

  /** What it has driven, once it has. */
  get run(): GhostRun | undefined {
    return this.#run;
  }

  /** Whether it broke off: what it has driven stays in sight. */
  get broken(): boolean {
    return this.#broken;
  }

  /** The next that is set begins anew, though the course be the same. */
  replaced(): void {
    this.#key = '';
  }

  /** Has this one drive a course, which is another one where `courseKey` is; nobody where it is nothing. */
  set(course: Course, seed: number, courseKey: string, own: OwnPlanner | undefined): void {
    const key = own ? courseKey + JSON.stringify(course.overrides) : '';
    if (key !== '' && key === this.#key) return;
    this.#job?.stop();
    this.#confined?.end();
    [this.#job, this.#confined, this.#run, this.#broken, this.#key] = [undefined, undefined, undefined, false, key];
    if (!own) return;
    const confined = confine(own);
    const { port } = confined;
    this.#confined = confined;
    this.#heard.said(`${own.name} is opened.`);
    this.#job = startJob({ type: 'own', course, seed, port }, (message) => this.#hear(own.name, message));
    this.until(this.#until);
  }

  /** As far as it may drive. */
  until(tick: number): void {
    this.#until = tick;
    this.#job?.send({ type: 'until', tick });
  }

  #hear(name: string, message: FromTrials): void {
    if (message.type === 'ghost') {
      const { rows, result } = message;
      const entered = !this.#run;
      if (this.#run) this.#run.extend(rows, result);
      else this.#run = new GhostRun(rows, result);
      this.#heard.driven(entered);
    } else if (message.type === 'took') {
      this.#heard.said(`${name} takes ${fixed(message.decision_ms, 1)} ms for a decision.`);
    } else if (message.type === 'refused') {
      this.#confined?.end();
      this.#broken = true;
      this.#heard.broke(`${name} ${message.message}`);
    } else if (message.type === 'failed') this.#heard.fault(undefined, message.message);
  }
}
