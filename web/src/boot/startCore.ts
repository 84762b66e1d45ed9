/** Begun before the rest of the page is there: the core, and what it loads. */

import type { Address, Beginning, Command } from '../protocol/simulationProtocol.ts';
import { SimulationClient } from '../simulation/simulationClient.ts';

/** Has the core load what an address asks for, or else where somebody left off, or the first scenario. */
function begin({ hash, search }: Address): Command {
  return { type: 'begin', address: { hash, search } };
}

export const core = new SimulationClient(begin(location));

/** Has the core begin anew without an address. */
export function beginPlainly(): Promise<Beginning> {
  return core.request(begin({ hash: '', search: '' }));
}

export const begun = core.first as Promise<Beginning>;
// The page hears of a failure once it is there.
begun.catch(() => undefined);
