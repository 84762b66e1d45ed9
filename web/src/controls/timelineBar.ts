/** The run as a line to go along: dragging shows any tick again, and playing goes on from there. */

import { byId, setText, svg } from '../base/dom.ts';
import { clock } from '../base/format.ts';
import { Pending } from '../base/pending.ts';
import { type Frame, TIMELINE_START, type Timeline } from '../protocol/simulationProtocol.ts';

export class TimelineBar {
  readonly #slider = byId('scrub', HTMLInputElement);
  readonly #now = byId('scrub-now', HTMLElement);
  readonly #end = byId('scrub-end', HTMLElement);
  readonly #latest = byId('scrub-latest', HTMLButtonElement);
  readonly #marks = byId('scrub-marks', SVGSVGElement);
  #period_s = 0.1;
  #timeline: Timeline = TIMELINE_START;
  /** While a finger or the mouse holds the thumb, frames do not move it. */
  #held = false;
  /** That of the newest frame. */
  #tick = 0;
  /** While the run is on its way to where the thumb is, frames do not move it either. */
  readonly #seeking = new Pending();

  constructor(seek: (tick: number) => Promise<void>) {
    const go = (tick: number) => void this.#seeking.add(seek(tick), () => this.#follow());
    this.#slider.addEventListener('input', () => {
      this.#tell(this.#slider.valueAsNumber);
      go(this.#slider.valueAsNumber);
    });
    this.#slider.addEventListener('pointerdown', () => {
      this.#held = true;
    });
    for (const event of ['pointerup', 'pointercancel', 'change']) {
      this.#slider.addEventListener(event, () => {
        this.#held = false;
      });
    }
    this.#latest.addEventListener('click', () => {
      go(this.#timeline.end);
      this.#slider.focus();
    });
  }

  session(period_s: number): void {
    this.#period_s = period_s;
  }

  show({ tick, timeline }: Frame): void {
    if (this.#timeline.changes.join() !== timeline.changes.join() || this.#timeline.end !== timeline.end) {
      this.#mark(timeline);
    }
    this.#timeline = timeline;
    this.#slider.min = String(timeline.first);
    this.#slider.max = String(Math.max(timeline.end, timeline.first));
    this.#slider.disabled = timeline.end <= timeline.first;
    setText(this.#end, clock(timeline.end * this.#period_s));
    this.#latest.classList.toggle('is-away', tick >= timeline.end);
    this.#tick = tick;
    this.#follow();
  }

  #follow(): void {
    if (this.#held || this.#seeking.any) return;
    this.#slider.value = String(this.#tick);
    this.#tell(this.#tick);
  }

  #tell(tick: number): void {
    const { first, end } = this.#timeline;
    const now = clock(tick * this.#period_s);
    setText(this.#now, now);
    this.#slider.setAttribute('aria-valuetext', `${now} of ${clock(end * this.#period_s)}`);
    const share = end > first ? (tick - first) / (end - first) : 0;
    this.#slider.style.setProperty('--done', `${(100 * share).toFixed(2)}%`);
  }

  /** Small marks where the route was changed: what comes after them has another goal. */
  #mark({ first, end, changes }: Timeline): void {
    const place = (tick: number) => `${(100 * (tick - first)) / Math.max(end - first, 1)}%`;
    const line = (tick: number) => svg('line', { x1: place(tick), x2: place(tick), y1: 0, y2: '100%' });
    this.#marks.replaceChildren(...changes.map(line));
  }
}
