/** The plots over time: zoomed by wheel, pinch, buttons and keys, with a cursor that is a time of the run. */

import { button, html } from '../base/dom.ts';
import { clock } from '../base/format.ts';
import { Pending } from '../base/pending.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Published } from '../run/published.ts';
import type { RunRecord } from '../run/record.ts';
import { PlotFigure, plotKey, type References, reading } from './figure.ts';
import { SERIES } from './series.ts';
import { pan, type Span, zoom } from './span.ts';
import { toSvgFile } from './svgFile.ts';

const DEGREES = 180 / Math.PI;
/** The eye follows no faster, and the page has more to do. */
const REDRAW_MS = 200;
const ZOOM_STEP = 0.6;

export class TimePlots {
  readonly element: HTMLElement;
  readonly #record: RunRecord;
  readonly #go: (time_s: number) => Promise<void>;
  readonly #figure = new PlotFigure();
  readonly #surface: HTMLElement;
  readonly #pointers = new Map<number, number>();
  #references: References = {};
  /** The span zoomed to; without it, the whole run so far. */
  #zoomed: Span | undefined;
  #period_s = 0.1;
  /** The time that the run was taken back to; without it, the newest. */
  #pinned_s: number | undefined;
  /** That of the newest frame. While the run is on its way to a chosen time, the cursor is there already. */
  #shown_s: number | undefined;
  readonly #going = new Pending();
  #hovered_s: number | undefined;
  #drawn_ms = 0;
  #scheduled = false;
  #visible = false;

  /** `go` takes the run to a time that somebody chooses. */
  constructor(record: RunRecord, go: (time_s: number) => Promise<void>) {
    this.#record = record;
    this.#go = go;
    this.#surface = html('div', 'plots-surface', [this.#figure.svg]);
    const zoomButton = (label: string, text: string, act: () => void) => {
      const made = button('plain plots-zoom', text, act);
      made.title = label;
      made.setAttribute('aria-label', label);
      return made;
    };
    const tools = html('div', 'plots-tools', [
      zoomButton('Zoom in on the plots', '+', () => this.#zoom(ZOOM_STEP)),
      zoomButton('Zoom out of the plots', '\u2212', () => this.#zoom(1 / ZOOM_STEP)),
      zoomButton('Show all of the run', 'all', () => this.#whole()),
    ]);
    this.element = html('div', 'plots', [html('div', 'plots-head', [plotKey(), tools]), this.#surface]);
    this.#listen();
  }

  session(info: SessionInfo): void {
    this.#references = {
      ...this.#references,
      roll: { limit: DEGREES * info.limits.roll_rad },
      pitch: { limit: DEGREES * info.limits.pitch_rad },
    };
    this.#period_s = info.period_s;
    this.#zoomed = undefined;
    this.#schedule();
  }

  paper(published: Published | undefined): void {
    this.#references = {
      ...this.#references,
      elevation_rate: published ? { paper: published.mean.mean_elevation_rate_cm_s } : {},
      vibration: published ? { paper: published.mean.mean_vibration_rad_s } : {},
    };
    this.#schedule();
  }

  /** The record has grown, or the run was taken back to another time. */
  update({ tick, time_s, timeline }: Frame): void {
    this.#shown_s = tick < timeline.end ? time_s : undefined;
    this.#follow();
  }

  /** Puts the cursor where the run is, unless it is on its way to where the cursor is. */
  #follow(): void {
    if (!this.#going.any) this.#pinned_s = this.#shown_s;
    this.#schedule();
  }

  /** The plots as they stand, as an SVG file. */
  file(words: readonly string[]): string {
    this.#draw();
    return toSvgFile(this.#figure.svg, words);
  }

  get #whole_s(): Span {
    const last = this.#record.length - 1;
    const from_s = last < 0 ? 0 : this.#record.get(0, 'time_s');
    return { from_s, to_s: Math.max(last < 0 ? 0 : this.#record.get(last, 'time_s'), from_s + 5) };
  }

  get #span(): Span {
    return this.#zoomed ?? this.#whole_s;
  }

  get #time_s(): number {
    return this.#hovered_s ?? this.#pinned_s ?? Number.POSITIVE_INFINITY;
  }

  #schedule(): void {
    if (this.#scheduled || !this.#visible) return;
    this.#scheduled = true;
    setTimeout(
      () => {
        this.#scheduled = false;
        if (this.#visible) this.#draw();
      },
      Math.max(this.#drawn_ms + REDRAW_MS - performance.now(), 0),
    );
  }

  #draw(): void {
    this.#drawn_ms = performance.now();
    const marked = this.#hovered_s !== undefined || this.#pinned_s !== undefined;
    this.#figure.show(this.#record, this.#span, this.#references);
    this.#point(marked);
  }

  #point(marked = true): void {
    const row = this.#record.at(this.#time_s);
    this.#figure.point(this.#record, row, marked);
    const time_s = row < 0 ? 0 : this.#record.get(row, 'time_s');
    const { from_s, to_s } = this.#whole_s;
    const values = SERIES.map((series) => `${series.name} ${reading(series, series.value(this.#record, row))}`);
    this.#surface.setAttribute('aria-valuemin', from_s.toFixed(1));
    this.#surface.setAttribute('aria-valuemax', to_s.toFixed(1));
    this.#surface.setAttribute('aria-valuenow', time_s.toFixed(1));
    this.#surface.setAttribute('aria-valuetext', `${clock(time_s)}: ${values.join(', ')}`);
  }

  #zoom(factor: number, at_s?: number): void {
    const whole = this.#whole_s;
    const span = this.#span;
    const centre_s = at_s ?? Math.min(this.#time_s, (span.from_s + span.to_s) / 2);
    const zoomed = zoom(span, centre_s, factor, whole);
    this.#zoomed = zoomed.to_s - zoomed.from_s < whole.to_s - whole.from_s ? zoomed : undefined;
    this.#draw();
  }

  #whole(): void {
    this.#zoomed = undefined;
    this.#draw();
  }

  /** Points a time out, and brings it into sight. */
  #choose(time_s: number): void {
    const row = this.#record.at(time_s);
    if (row < 0) return;
    this.#pinned_s = this.#record.get(row, 'time_s');
    this.#hovered_s = undefined;
    if (this.#zoomed) {
      const beyond_s =
        Math.min(this.#pinned_s - this.#zoomed.from_s, 0) + Math.max(this.#pinned_s - this.#zoomed.to_s, 0);
      this.#zoomed = pan(this.#zoomed, beyond_s, this.#whole_s);
    }
    this.#draw();
    void this.#going.add(this.#go(this.#pinned_s), () => this.#follow());
  }

  #listen(): void {
    const surface = this.#surface;
    surface.tabIndex = 0;
    surface.setAttribute('role', 'slider');
    surface.setAttribute(
      'aria-label',
      'Time in the plots. Arrow keys move it, plus and minus zoom, 0 shows the whole run.',
    );
    surface.addEventListener('keydown', (event) => this.#key(event));
    surface.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
    surface.addEventListener('pointerdown', (event) => this.#down(event));
    surface.addEventListener('pointermove', (event) => this.#move(event));
    for (const type of ['pointerup', 'pointercancel', 'pointerleave'] as const) {
      surface.addEventListener(type, (event) => this.#up(event));
    }
    surface.addEventListener('dblclick', () => this.#whole());
    new ResizeObserver(() => {
      this.#figure.resize(surface.clientWidth, surface.clientHeight);
      if (surface.clientWidth > 0) this.#draw();
    }).observe(surface);
    new IntersectionObserver(([entry]) => {
      this.#visible = entry?.isIntersecting ?? false;
      this.#schedule();
    }).observe(surface);
  }

  #key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const now_s = Math.min(this.#time_s, this.#whole_s.to_s);
    const step_s = (event.shiftKey ? 10 : 1) * this.#period_s;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => this.#choose(now_s - step_s),
      ArrowDown: () => this.#choose(now_s - step_s),
      ArrowRight: () => this.#choose(now_s + step_s),
      ArrowUp: () => this.#choose(now_s + step_s),
      PageUp: () => this.#choose(now_s + 10),
      PageDown: () => this.#choose(now_s - 10),
      Home: () => this.#choose(this.#whole_s.from_s),
      End: () => this.#choose(this.#whole_s.to_s),
      '+': () => this.#zoom(ZOOM_STEP),
      '=': () => this.#zoom(ZOOM_STEP),
      '-': () => this.#zoom(1 / ZOOM_STEP),
      '0': () => this.#whole(),
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  /** A plain wheel scrolls the page, unless the plots have the focus or fill a sheet. */
  #wheel(event: WheelEvent): void {
    const meant = event.ctrlKey || document.activeElement === this.#surface || this.#surface.closest('dialog');
    if (!meant) return;
    event.preventDefault();
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY);
    if (sideways && this.#zoomed) {
      const { from_s, to_s } = this.#zoomed;
      this.#zoomed = pan(this.#zoomed, (event.deltaX / this.#surface.clientWidth) * (to_s - from_s), this.#whole_s);
      this.#draw();
    } else if (!sideways) {
      this.#zoom(1.0015 ** event.deltaY, this.#figure.timeAt(this.#xOf(event)));
    }
  }

  #xOf(event: MouseEvent): number {
    return event.clientX - this.#surface.getBoundingClientRect().left;
  }

  #down(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.#surface.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, this.#xOf(event));
    if (this.#pointers.size === 1) this.#choose(this.#figure.timeAt(this.#xOf(event)));
  }

  #move(event: PointerEvent): void {
    const before = this.#pointers.get(event.pointerId);
    if (before === undefined) {
      if (event.pointerType !== 'mouse') return;
      this.#hovered_s = this.#figure.timeAt(this.#xOf(event));
      this.#point();
      return;
    }
    if (this.#pointers.size === 1) {
      this.#choose(this.#figure.timeAt(this.#xOf(event)));
    } else if (this.#pointers.size === 2) {
      this.#pinch(event.pointerId, before, this.#xOf(event));
    }
    this.#pointers.set(event.pointerId, this.#xOf(event));
  }

  /** Two fingers: their distance zooms, their middle stays under them. */
  #pinch(moved: number, before: number, now: number): void {
    const other = [...this.#pointers].find(([id]) => id !== moved)?.[1] ?? now;
    const [wide, narrow] = [Math.max(Math.abs(now - other), 8), Math.max(Math.abs(before - other), 8)];
    this.#zoom(narrow / wide, this.#figure.timeAt((now + other) / 2));
  }

  #up(event: PointerEvent): void {
    this.#pointers.delete(event.pointerId);
    if (event.type === 'pointerleave') {
      this.#hovered_s = undefined;
      this.#draw();
    }
  }
}
