/** Shows what the page begins with. */

import type { App } from '../app/app.ts';
import { byId } from '../base/dom.ts';
import { messageOf } from '../base/messageOf.ts';
import { CATALOGUE } from '../experiment/catalogue.ts';
import { type Experiment, FIRST_SETUP } from '../experiment/experiment.ts';
import { linkTo } from '../experiment/link.ts';
import type { Notice } from '../notices/notice.ts';
import type { Beginning } from '../protocol/simulationProtocol.ts';
import { leaveWheel } from '../view/frameWheel.ts';

/** `begun` is what the core loads; `beginAt` has it load what it would at a shorter address. Returns what it began with, if anything of it worked. */
export async function begin(
  app: App,
  notice: Notice,
  begun: Promise<Beginning>,
  beginAt: (search: string) => Promise<Beginning>,
): Promise<Beginning | undefined> {
  // In another page's frame: the view alone, with a way out of it.
  if (new URLSearchParams(location.search).has('embed')) {
    document.documentElement.toggleAttribute('data-embed', true);
    leaveWheel();
  }
  try {
    const beginning = await app.begin(begun);
    welcome(app, notice, beginning);
    return beginning;
  } catch (error) {
    // What was asked for does not work: say why, and show what does. That may be the very work of the last visit.
    const less = location.hash ? [location.search, ''] : [''];
    const instead = await less
      .reduce<Promise<Beginning>>(
        (before, search) => before.catch(() => app.begin(beginAt(search))),
        Promise.reject(error),
      )
      .catch(() => first(app));
    notice.show(messageOf(error));
    return instead ?? undefined;
  }
}

function first(app: App): Promise<void> {
  return app.runScenario(CATALOGUE[0]?.id ?? '', FIRST_SETUP);
}

function welcome(app: App, notice: Notice, { from, own, unread }: Beginning): void {
  if (unread) notice.show(`What this browser kept of the last visit cannot be read. ${unread}`);
  else if (from === 'link' && own) notice.tell('This came with the link. Undo leads back to your own work.');
  else if (from === 'last visit') {
    notice.tell('Here is where you left off.', 'Start afresh', () => app.attempt(first(app)));
  }
}

/** The way out of another page's frame leads to what is shown there, however it came. */
export async function leadOut(experiment: Experiment): Promise<void> {
  if (!document.documentElement.hasAttribute('data-embed')) return;
  byId('open-page', HTMLAnchorElement).href = await linkTo(location.href.split('?')[0] ?? '', experiment);
}
