/** Begun before the rest of the page is there: the core, and what it loads. */

import { CoreClient } from './core/client.ts';
import type { Address, Beginning } from './core/protocol.ts';

export const core = new CoreClient();

/** Has the core load what an address asks for, or else where somebody left off, or the first scenario. */
export function beginAt({ hash, search }: Address): Promise<Beginning> {
  return core.request({ type: 'begin', address: { hash, search } });
}

export const begun = beginAt(location);
// The page hears of a failure once it is there.
begun.catch(() => undefined);
