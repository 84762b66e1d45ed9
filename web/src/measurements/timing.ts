/** How long the machine takes for a tick, and for each part of it. */

import { byId, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import type { RunRecord } from '../run/record.ts';

/** Single ticks jump too quickly to read: two seconds of simulated time. */
const AVERAGED_TICKS = 20;
const PARTS = ['scan', 'planner', 'motion'] as const;

export class TimingPanel {
  readonly #tick = byId('tick-ms', HTMLElement);
  readonly #parts = PARTS.map((part) => ({ name: `${part}_ms` as const, shown: byId(`${part}-ms`, HTMLElement) }));

  show(record: RunRecord): void {
    const begin = Math.max(record.length - AVERAGED_TICKS, 0);
    let tick_ms = 0;
    for (const { name, shown } of this.#parts) {
      let sum_ms = 0;
      for (let row = begin; row < record.length; row += 1) sum_ms += record.get(row, name);
      const mean_ms = sum_ms / (record.length - begin);
      tick_ms += mean_ms;
      setText(shown, `${fixed(mean_ms, 1)} ms`);
    }
    setText(this.#tick, `${fixed(tick_ms, 1)} ms`);
  }
}
