/** A trial that somebody's own planner drives: it is asked on each scan. Runs in the worker. */

import { messageOf } from '../base/messageOf.ts';
import { Questions } from '../guest/questions.ts';
import type { GuestRunner } from '../wasm/mapless_wasm_baselines.js';
import { OWN_PLANNER, rowOf, type TrialResult } from './trialsProtocol.ts';

export class GuestRun {
  readonly #core: GuestRunner;
  readonly #seed: number;
  readonly #questions: Questions;
  #took_ms = 0;
  #decisions = 0;
  running = true;
  ticks = 0;

  constructor(core: GuestRunner, seed: number, port: MessagePort) {
    [this.#core, this.#seed, this.#questions] = [core, seed, new Questions(port)];
  }

  /** Tells the planner what it drives. */
  begin(): Promise<void> {
    return this.#questions.begin(this.#core.model());
  }

  /** One planning period. Throws what is wrong with the planner, with the time at which it was. */
  async tick(): Promise<void> {
    if (this.#core.look()) {
      const question = this.#core.question();
      try {
        const points = this.#core.points() as Float32Array<ArrayBuffer>;
        const { linear_m_s, angular_rad_s, decision_ms } = await this.#questions.decide(question, points);
        this.#core.answer(linear_m_s, angular_rad_s);
        this.#took_ms += decision_ms;
        this.#decisions += 1;
      } catch (cause) {
        throw new Error(`at ${question.time_s.toFixed(1)} s: ${messageOf(cause)}`, { cause });
      }
    }
    this.running = this.#core.act();
    this.ticks += 1;
  }

  free(): void {
    this.#core.free();
  }

  /** For one decision, in the mean. */
  get decision_ms(): number {
    return this.#took_ms / this.#decisions;
  }

  /** The values of `ROW`, now. */
  get row(): number[] {
    return rowOf(this.#core.status());
  }

  get result(): TrialResult {
    const { tick, time_s, metrics, outcome } = this.#core.status();
    const digest = this.#core.digest();
    return { planner: OWN_PLANNER, seed: this.#seed, outcome, tick, time_s, metrics, digest };
  }
}
