/** How finely and how often to draw, so that a slow machine keeps its time for the simulation. */

/** Slower than this, on average, and the resolution goes down. */
const SLOW_DRAW_MS = 40;
const LEAST_PIXEL_RATIO = 0.6;
const MOST_PIXEL_RATIO = 2;
/** Part of the time that drawing may take once it is slow. */
const DUTY = 0.4;
/** A gap longer than this is a pause, not a slow drawing. */
const PAUSE_MS = 1500;

export class Pacer {
  /** Whether a processor draws in place of a graphics card. */
  readonly software: boolean;
  /** Of pictures while something moves. */
  pixelRatio: number;
  /** Of a picture that stays. */
  readonly finest: number;
  #cost_ms = 16;
  #drawn_ms: number | undefined;
  #last_ms = 0;

  constructor(software: boolean, devicePixelRatio: number) {
    this.software = software;
    this.finest = Math.min(devicePixelRatio, MOST_PIXEL_RATIO);
    this.pixelRatio = software ? Math.min(LEAST_PIXEL_RATIO, this.finest) : this.finest;
  }

  /** Whether it is time to draw; `now_ms` is that of the animation frame. */
  due(now_ms: number): boolean {
    if (this.#drawn_ms !== undefined) {
      // The browser calls again once it has room for another picture: that is when the last one was done.
      const took_ms = now_ms - this.#drawn_ms;
      this.#drawn_ms = undefined;
      if (took_ms < PAUSE_MS) this.#cost_ms += 0.15 * (took_ms - this.#cost_ms);
    }
    return this.#cost_ms < SLOW_DRAW_MS || now_ms - this.#last_ms > this.#cost_ms / DUTY;
  }

  /** Notes that a picture was drawn; returns whether the resolution went down. */
  drew(now_ms: number): boolean {
    this.#drawn_ms = now_ms;
    this.#last_ms = now_ms;
    if (this.#cost_ms < SLOW_DRAW_MS || this.pixelRatio <= LEAST_PIXEL_RATIO) return false;
    this.pixelRatio = Math.max(LEAST_PIXEL_RATIO, 0.8 * this.pixelRatio);
    this.#cost_ms = 16;
    return true;
  }
}

/** Whether a processor draws in place of a graphics card. */
export function drawsInSoftware(): boolean {
  // Chromium mostly gives no such context then. A lean one is sooner there: each step waits for the graphics process.
  const lean = { failIfMajorPerformanceCaveat: true, antialias: false, depth: false };
  const probe = new OffscreenCanvas(1, 1).getContext('webgl2', lean);
  if (!probe) return true;
  const info = probe.getExtension('WEBGL_debug_renderer_info');
  const name = info ? String(probe.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  return /swiftshader|llvmpipe|software/i.test(name);
}
