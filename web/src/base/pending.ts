/** Work under way whose end is already shown: until it is done, what comes in is older than what is shown. */
export class Pending {
  #count = 0;

  get any(): boolean {
    return this.#count > 0;
  }

  /** Calls `settled` once this work and all that began before it or meanwhile is done. */
  async add(work: Promise<void>, settled: () => void): Promise<void> {
    this.#count += 1;
    try {
      await work;
    } finally {
      this.#count -= 1;
      if (this.#count === 0) settled();
    }
  }
}
