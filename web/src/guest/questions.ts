/** Asks somebody's own planner through its port. It may answer anything, late or never. */

import { fail } from '../base/checks.ts';
import type { GuestModel, GuestQuestion } from '../wasm/mapless_wasm_baselines.js';

/** To load its code and to begin. */
const OPENING_MS = 15_000;
/** For one decision. A robot gives it 0.1 s; a busy computer is no fault of the planner. */
const DECISION_MS = 5_000;

export interface Answer {
  readonly linear_m_s: number;
  readonly angular_rad_s: number;
  readonly decision_ms: number;
}

export class Questions {
  readonly #port: MessagePort;

  constructor(port: MessagePort) {
    this.#port = port;
    port.start();
  }

  async begin(model: GuestModel): Promise<void> {
    await this.#ask({ model }, [], OPENING_MS, 'opening it');
  }

  async decide(question: GuestQuestion, points: Float32Array<ArrayBuffer>): Promise<Answer> {
    const asked = { question: { ...question, points } };
    const { linear_m_s, angular_rad_s, decision_ms } = await this.#ask(
      asked,
      [points.buffer],
      DECISION_MS,
      'a decision',
    );
    return {
      linear_m_s: finite(linear_m_s, 'linear_m_s'),
      angular_rad_s: finite(angular_rad_s, 'angular_rad_s'),
      decision_ms: typeof decision_ms === 'number' ? decision_ms : Number.NaN,
    };
  }

  #ask(message: object, transfer: Transferable[], limit_ms: number, what: string): Promise<Record<string, unknown>> {
    return new Promise((resolve, reject) => {
      const late = () => reject(new Error(`${what} took longer than ${limit_ms / 1000} s: it was stopped`));
      const limit = setTimeout(late, limit_ms);
      this.#port.onmessage = ({ data }) => {
        clearTimeout(limit);
        const answer = typeof data === 'object' && data !== null ? (data as Record<string, unknown>) : {};
        if (answer.fault === undefined) resolve(answer);
        else reject(new Error(String(answer.fault).slice(0, 500)));
      };
      this.#port.postMessage(message, transfer);
    });
  }
}

function finite(value: unknown, name: string): number {
  return typeof value === 'number' && Number.isFinite(value)
    ? value
    : fail(name, value, 'a finite number, as in { linear_m_s, angular_rad_s }');
}
