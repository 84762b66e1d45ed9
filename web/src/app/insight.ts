/** What can be asked of the decision that is shown; the run goes on as if nobody had asked. */

import type { Place } from '../experiment/place.ts';
import type { ClimbStep, Inside, InsideQuestion, PlaceReport } from '../protocol/simulationProtocol.ts';
import type { SimulationClient } from '../simulation/simulationClient.ts';

export class Insight {
  readonly #core: SimulationClient;
  #truthShown = false;

  constructor(core: SimulationClient) {
    this.#core = core;
  }

  /** The process over the scan, with inducing inputs of one's own choice. */
  lookInside(question: InsideQuestion): Promise<Inside> {
    return this.#core.request({ type: 'inside', question });
  }

  /** What is true of a place, and what the scan in view saw of it. */
  reportOn(place: Place): Promise<PlaceReport> {
    return this.#core.request({ type: 'place', place });
  }

  /** The climb of the bound on the scan that is shown, with nothing to hold the values. */
  climb(): Promise<readonly ClimbStep[]> {
    return this.#core.request({ type: 'climb' });
  }

  /** The covariance of every direction of the image with this one, as a share of the signal variance. */
  kernelFrom(column: number, row: number): Promise<Float32Array> {
    return this.#core.request({ type: 'kernel', column, row });
  }

  /** Has frames bring the true skyline while nothing drives. */
  showTruth(shown: boolean): Promise<void> {
    this.#truthShown = shown;
    return this.#core.request({ type: 'truth', shown });
  }

  /** Tells a new worker what the one before knew. */
  async resume(): Promise<void> {
    if (this.#truthShown) await this.showTruth(true);
  }
}
