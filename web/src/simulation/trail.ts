/** Where the robot stood after each tick, from the first tick that can be gone back to. */

const FIRST_TICKS = 1024;

export class Trail {
  #xyz = new Float32Array(3 * FIRST_TICKS);
  #first = 0;
  #length = 0;

  /** Begins anew at `tick`. */
  begin(tick: number, x: number, y: number, z: number): void {
    this.#first = tick;
    this.#length = 0;
    this.put(tick, x, y, z);
  }

  /** The place of a tick that is known already, or of the one after all that are. */
  put(tick: number, x: number, y: number, z: number): void {
    const index = tick - this.#first;
    if (index < 0 || index > this.#length) throw new Error(`Tick ${tick} does not follow ${this.#length - 1}.`);
    if (3 * index >= this.#xyz.length) {
      const larger = new Float32Array(2 * this.#xyz.length);
      larger.set(this.#xyz);
      this.#xyz = larger;
    }
    this.#xyz.set([x, y, z], 3 * index);
    this.#length = Math.max(this.#length, index + 1);
  }

  /** Forgets what comes after `tick`. */
  cut(tick: number): void {
    this.#length = Math.min(this.#length, tick - this.#first + 1);
  }

  /** x, y, z from one tick to another, both included. */
  part(from: number, to: number): Float32Array<ArrayBuffer> {
    const begin = Math.max(from - this.#first, 0);
    const end = Math.min(to - this.#first + 1, this.#length);
    return this.#xyz.slice(3 * begin, 3 * Math.max(begin, end));
  }

  /** x, y, z of `tick` and all after it. */
  after(tick: number): Float32Array<ArrayBuffer> {
    return this.part(tick, this.#first + this.#length - 1);
  }
}
