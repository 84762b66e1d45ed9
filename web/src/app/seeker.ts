/** Takes the run to other times. Of many wishes in a row the last is carried out. */

export class Seeker {
  readonly #seek: (tick: number) => Promise<void>;
  #waiting: number | undefined;
  #busy = false;

  constructor(seek: (tick: number) => Promise<void>) {
    this.#seek = seek;
  }

  /** The tick that is still to be gone to, if there is one. */
  get waiting(): number | undefined {
    return this.#waiting;
  }

  async to(tick: number): Promise<void> {
    this.#waiting = tick;
    if (this.#busy) return;
    this.#busy = true;
    try {
      while (this.#waiting !== undefined) {
        const now = this.#waiting;
        this.#waiting = undefined;
        await this.#seek(now);
      }
    } finally {
      this.#busy = false;
    }
  }
}
