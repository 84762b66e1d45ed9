/** Begun before the rest of the page is there: the core, and what it loads. */

import { workOfTab } from '../experiment/autosave.ts';
import type { Address, Beginning, Command } from '../protocol/simulationProtocol.ts';
import { SimulationClient } from '../simulation/simulationClient.ts';

/** Has the core load what an address asks for, or else where this tab or somebody left off, or the first scenario. */
function begin({ hash, search }: Pick<Address, 'hash' | 'search'>): Command {
  return { type: 'begin', address: { hash, search, work: workOfTab() } };
}

export const core = new SimulationClient(begin(location));

/** Has the core begin anew with less of an address. */
export function beginAt(search: string): Promise<Beginning> {
  return core.request(begin({ hash: '', search }));
}

export const begun = core.first as Promise<Beginning>;
// The page hears of a failure once it is there.
begun.catch(() => undefined);
