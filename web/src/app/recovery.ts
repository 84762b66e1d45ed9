/** Brings the simulation back in a new worker: after a panic in the core, or when somebody stops an opening that takes long. */

export interface Recovered {
  /** What the simulation goes back to; nothing until something is there. */
  title(): string | undefined;
  /** Opens the experiment again, at its start. */
  reopen(): Promise<void>;
  notice(message: string): void;
}

export class Recovery {
  readonly #recovered: Recovered;
  #underWay = false;

  constructor(recovered: Recovered) {
    this.#recovered = recovered;
  }

  /** A panic on the way back is reported by the way back. */
  afterPanic(message: string): void {
    const title = this.#recovered.title();
    if (this.#underWay) return;
    if (title === undefined) {
      this.#recovered.notice(`The simulation could not be loaded; reload the page to try again. (${message})`);
      return;
    }
    this.#recovered.notice(
      `The simulation stopped on an internal error. “${title}” goes back to its start, with your ground, start and goal. (${message})`,
    );
    this.#goBack(`The simulation stopped on an internal error and could not be started again. (${message})`);
  }

  /** Who waits for the opening is told by its refusal. */
  afterStop(): void {
    if (this.#recovered.title() !== undefined) this.#goBack('The simulation could not be started again.');
  }

  async #goBack(failed: string): Promise<void> {
    this.#underWay = true;
    try {
      await this.#recovered.reopen();
    } catch {
      this.#recovered.notice(`${failed} Reload the page to try again.`);
    } finally {
      this.#underWay = false;
    }
  }
}
