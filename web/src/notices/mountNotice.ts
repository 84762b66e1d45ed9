/** Says once for each run that the ground in the first scan does not fit the mount of the sensor. */

import type { Frame } from '../protocol/simulationProtocol.ts';
import type { Notice } from './notice.ts';

export class MountNotice {
  readonly #notice: Pick<Notice, 'tell' | 'withdraw'>;
  #told: string | undefined;

  constructor(notice: Pick<Notice, 'tell' | 'withdraw'>) {
    this.#notice = notice;
  }

  show({ mount_misfit }: Pick<Frame, 'mount_misfit'>): void {
    const message = mount_misfit && `Mount of the sensor: ${mount_misfit}.`;
    if (message === this.#told) return;
    if (this.#told) this.#notice.withdraw(this.#told);
    if (message) this.#notice.tell(message);
    this.#told = message;
  }
}
