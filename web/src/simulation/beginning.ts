/** What the page begins with: a link, a scenario by name, where somebody left off, or the first scenario. */

import { messageOf } from '../base/messageOf.ts';
import { askedFor, momentIn } from '../experiment/address.ts';
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
    const experiment = await experimentIn(hash);
    return { from: 'link', source: { experiment }, own, unread, moment_s: momentIn(hash) };
  }
  const asked = askedFor(new URLSearchParams(search));
  if (asked) {
    const { scenario, preset = FIRST_SETUP.preset, learning = FIRST_SETUP.learning, seed, reality, moment_s } = asked;
    const overrides = reality === undefined ? FIRST_SETUP.overrides : { reality: { preset: reality } };
    return {
      from: 'address',
      source: { scenario, setup: { preset, learning, overrides }, seed },
      own,
      unread,
      moment_s,
    };
  }
  const moment_s = undefined;
  if (own) return { from: 'last visit', source: { experiment: own.experiment }, own, unread, moment_s };
  const first = { scenario: CATALOGUE[0]?.id ?? '', setup: FIRST_SETUP, seed: undefined };
  return { from: 'catalogue', source: first, own, unread, moment_s };
}
