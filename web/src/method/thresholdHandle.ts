/** The threshold as a handle on the scale of colours beside the large image. */

import { html } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import type { Plot } from '../inspector/imagePlot.ts';
import { THRESHOLD } from './knobs.ts';

/** Half of the thumb lies beyond either end of the scale. */
const THUMB_PX = 18;

export class ThresholdHandle {
  readonly element = html('input', 'threshold-handle');

  /** `move` is called while it is dragged, `set` when it is let go. */
  constructor(move: (threshold: number) => void, set: (threshold: number) => void) {
    const [min, max] = [String(THRESHOLD.lowest), String(THRESHOLD.highest)];
    Object.assign(this.element, { type: 'range', min, max, step: '0.01', hidden: true });
    this.element.setAttribute('aria-label', 'Threshold V_th');
    this.element.title = 'Drag the threshold between seen and free';
    this.element.addEventListener('input', () => move(Number(this.element.value)));
    this.element.addEventListener('change', () => set(Number(this.element.value)));
  }

  /** Puts it over the scale of the plot; with `busy`, it stays where it is held. */
  place(plot: Plot, threshold: number | undefined, busy: boolean): void {
    this.element.hidden = !plot.detailed || threshold === undefined;
    if (this.element.hidden || threshold === undefined) return;
    const { style } = this.element;
    const { lowest, highest } = THRESHOLD;
    style.left = `${plot.left + plot.width + 3}px`;
    style.top = `${plot.top + plot.height * (1 - highest) - THUMB_PX / 2}px`;
    style.height = `${plot.height * (highest - lowest) + THUMB_PX}px`;
    const held = document.activeElement === this.element && (busy || this.element.matches(':active'));
    if (!held) this.element.value = String(threshold);
    this.element.setAttribute('aria-valuetext', fixed(threshold, 2));
  }
}
