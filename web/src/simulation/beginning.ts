/** What the page begins with: a link, a scenario by name, where somebody left off, or the first scenario. */

import { messageOf } from '../base/messageOf.ts';
import { askedFor } from '../experiment/address.ts';
import { kept, type Work } from '../experiment/autosave.ts';
import { CATALOGUE } from '../experiment/catalogue.ts';
import { FIRST_SETUP } from '../experiment/experiment.ts';
import { carriesExperiment, experimentIn } from '../experiment/link.ts';
import type { Address, Beginning, Source } from '../protocol/simulationProtocol.ts';

/** What the page's address asks for, or else what this browser kept; throws where the address makes no sense. */
export async function beginningAt({ hash, search, work }: Address): Promise<Beginning & { readonly source: Source }> {
  let own: Work | undefined;
  let unread: string | undefined;
  try {
    own = await kept(work);
  } catch (error) {
    unread = messageOf(error);
  }
  if (carriesExperiment(hash)) {
    return { from: 'link', source: { experiment: await experimentIn(hash) }, own, unread };
  }
  const asked = askedFor(new URLSearchParams(search));
  if (asked) {
    const { scenario, preset = FIRST_SETUP.preset, learning = FIRST_SETUP.learning, seed, reality } = asked;
    const overrides = reality === undefined ? FIRST_SETUP.overrides : { reality: { preset: reality } };
    return { from: 'address', source: { scenario, setup: { preset, learning, overrides }, seed }, own, unread };
  }
  if (own) return { from: 'last visit', source: { experiment: own.experiment }, own, unread };
  const first = { scenario: CATALOGUE[0]?.id ?? '', setup: FIRST_SETUP, seed: undefined };
  return { from: 'catalogue', source: first, own, unread };
}
