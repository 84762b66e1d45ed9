/** Frames for the page: what it has of the run, what it lacks, and how soon it may have the next. */

import { type Frame, type FromSimulation, transferables } from '../protocol/simulationProtocol.ts';
import { rowOf } from '../run/record.ts';
import type { Standing, Tick } from '../wasm/mapless_wasm.js';
import type { Session } from './session.ts';
import { Trail } from './trail.ts';

/** Frames that the page may have at once, the one it shows among them; while it is slower, frames are skipped. */
const IN_FLIGHT = 3;
/** No frame is posted sooner after the one before than this. */
const INTERVAL_MS = 50;
/** No surfaces are predicted sooner after those before than this, which lets every tick have its own at normal speed. */
const SURFACE_INTERVAL_MS = 80;
/** Part of the time that predicting surfaces may take while the robot drives. */
const SURFACE_DUTY = 0.25;

export class Frames {
  /** Whether the page shows the surfaces, and the true skyline. */
  watched = false;
  truthShown = false;
  readonly #post: (message: FromSimulation, transfer: Transferable[]) => void;
  readonly #trail = new Trail();
  #inFlight = 0;
  #last_ms = 0;
  #unsent = false;
  /** When the next surfaces may be predicted, and whether those that the page has are older than its frame. */
  #surfacesDue_ms = 0;
  #surfacesOld = false;
  /** Whether the newest frame lacks the true skyline though it is shown. */
  #truthLacks = false;
  /** The newest tick that the page has seen; nothing after a jump. */
  #seen: number | undefined;
  #rewound = false;
  /** Rows of the record since the newest frame. */
  #rows: number[] = [];

  constructor(post: (message: FromSimulation, transfer: Transferable[]) => void) {
    this.#post = post;
  }

  /** A run begins. */
  begin({ tick, x, y, z }: Standing): void {
    this.#trail.begin(tick, x, y, z);
    this.#seen = undefined;
    this.#rows = [];
  }

  /** The run has gone on by a tick. */
  drove(tick: Tick): void {
    this.#rows.push(...rowOf(tick));
    this.#put(tick.after);
    this.#unsent = true;
  }

  /** What came after this tick is no longer to come. */
  cut(standing: Standing): void {
    this.#trail.cut(standing.tick);
    this.#put(standing);
  }

  /** The run stands at another tick than the one after what was shown. */
  jumped(): void {
    [this.#seen, this.#rewound] = [undefined, true];
  }

  /** What the page has is no longer so. */
  outdate(): void {
    this.#unsent = true;
  }

  /** The page is done with a frame; those from before a panic come back to the worker that took over. */
  returned(): void {
    this.#inFlight = Math.max(0, this.#inFlight - 1);
  }

  /** Whether there is something new, and the page is not busy with earlier frames. */
  get due(): boolean {
    return this.#unsent && this.#inFlight < IN_FLIGHT;
  }

  /** Until the next may be posted while the robot drives. */
  get wait_ms(): number {
    return this.#last_ms + INTERVAL_MS - performance.now();
  }

  get surfacesLack(): boolean {
    return this.watched && this.#surfacesOld;
  }

  /** Whether the page lacks anything of what it shows of a run that stands still. */
  get lacking(): boolean {
    return this.#unsent || this.surfacesLack || this.#truthLacks;
  }

  /** Posts what is now; of what stands still, everything. */
  show(session: Session, standsStill: boolean): void {
    const began_ms = performance.now();
    this.#last_ms = began_ms;
    const surfaces = this.watched && (standsStill || began_ms >= this.#surfacesDue_ms);
    const { tick } = session.standing;
    const anew = this.#seen === undefined;
    const trail = this.#trail.part(this.#seen === undefined ? 0 : this.#seen + 1, tick);
    const ahead = this.#rewound ? this.#trail.after(tick) : undefined;
    const truth = this.truthShown && standsStill;
    const rows = new Float64Array(this.#rows);
    const frame: Frame = session.frame({ trail, anew, ahead, rows }, surfaces, truth);
    this.#surfacesOld = !surfaces;
    this.#truthLacks = this.truthShown && !truth;
    if (surfaces) {
      const took_ms = performance.now() - began_ms;
      this.#surfacesDue_ms = began_ms + Math.max(SURFACE_INTERVAL_MS, took_ms / SURFACE_DUTY);
    }
    [this.#seen, this.#rewound] = [tick, false];
    this.#rows = [];
    this.#unsent = false;
    this.#inFlight += 1;
    this.#post({ type: 'frame', frame }, [...transferables(frame.buffers), frame.trail.buffer, frame.rows.buffer]);
  }

  #put({ tick, x, y, z }: Standing): void {
    this.#trail.put(tick, x, y, z);
  }
}
