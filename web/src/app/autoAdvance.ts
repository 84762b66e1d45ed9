/** Leaves time to look at a result before the page goes on by itself. */

/** How long the result of a trial stands. */
const LINGER_S = 8;

export class AutoAdvance {
  readonly #tell: (seconds: number | undefined) => void;
  #timer: ReturnType<typeof setInterval> | undefined;

  /** `tell` hears how many seconds are left, and nothing once it is over. */
  constructor(tell: (seconds: number | undefined) => void) {
    this.#tell = tell;
  }

  begin(goOn: () => void): void {
    this.stop();
    let seconds = LINGER_S;
    this.#tell(seconds);
    this.#timer = setInterval(() => {
      seconds -= 1;
      this.#tell(Math.max(seconds, 0));
      if (seconds <= 0) goOn();
    }, 1000);
  }

  stop(): void {
    clearInterval(this.#timer);
    this.#timer = undefined;
    this.#tell(undefined);
  }
}
