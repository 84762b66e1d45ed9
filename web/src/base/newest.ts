/** Work of which only the newest matters: while one is under way, the latest of those that come waits, and the others are dropped. */
export class Newest {
  #busy = false;
  #next: (() => Promise<void>) | undefined;

  /** Whether work is under way: what it gives may be older than what somebody holds. */
  get busy(): boolean {
    return this.#busy;
  }

  do(work: () => Promise<void>): void {
    this.#next = work;
    if (!this.#busy) void this.#run();
  }

  async #run(): Promise<void> {
    this.#busy = true;
    try {
      while (this.#next) {
        const work = this.#next;
        this.#next = undefined;
        await work();
      }
    } finally {
      this.#busy = false;
    }
  }
}
