/** What made the present session: after a panic, the same commands make it again in a new worker. */

import type { Command } from './protocol.ts';

export class Journal {
  #commands: Command[] = [];

  /** Notes a command that was carried out. */
  note(command: Command): void {
    switch (command.type) {
      case 'load':
        this.#commands = [command];
        break;
      case 'goal':
      case 'start':
        // Only the last of them counts.
        this.#commands = [...this.#commands.filter(({ type }) => type !== command.type), command];
        break;
      case 'sculpt':
        this.#commands.push(command);
        break;
    }
  }

  /** The commands to repeat, from loading on; none before the first session. */
  get commands(): readonly Command[] {
    return this.#commands.length > 1 ? [...this.#commands, { type: 'restart' }] : this.#commands;
  }
}
