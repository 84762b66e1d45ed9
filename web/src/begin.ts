/** What the page begins with: a link, a scenario by name, where somebody left off, or the first scenario. */

import type { App } from './app.ts';
import { askedFor } from './core/address.ts';
import { kept } from './core/autosave.ts';
import { CATALOGUE } from './core/catalogue.ts';
import { type Experiment, FIRST_SETUP } from './core/experiment.ts';
import { carriesExperiment, experimentIn } from './core/link.ts';
import { byId } from './ui/dom.ts';
import type { Notice } from './ui/notice.ts';

export async function begin(app: App, notice: Notice): Promise<void> {
  const first = () => app.run(CATALOGUE[0]?.id ?? '', FIRST_SETUP);
  const link = location.hash;
  const options = new URLSearchParams(location.search);
  if (options.has('embed')) embed(options);
  let own: Experiment | undefined;
  try {
    own = await kept();
  } catch (error) {
    notice.show(`What this browser kept of the last visit cannot be read. ${said(error)}`);
  }
  try {
    const asked = askedFor(options);
    if (carriesExperiment(link)) {
      await app.runAfter(own, { experiment: await experimentIn(link) });
      if (own) notice.tell('This came with the link. Undo leads back to your own work.');
    } else if (asked) {
      const { scenario, preset = app.setup.preset, seed } = asked;
      await app.runAfter(own, { scenario, setup: { ...app.setup, preset }, seed });
    } else if (own) {
      await app.runAfter(undefined, { experiment: own });
      notice.tell('Here is where you left off.', 'Start afresh', () => app.attempt(first()));
    } else {
      await first();
    }
  } catch (error) {
    // What was asked for does not work: say why, and show what does.
    const why = said(error);
    await (own ? app.runAfter(undefined, { experiment: own }) : first());
    notice.show(why);
  }
}

/** In another page's frame: the view alone, with a way out of it. */
function embed(options: URLSearchParams): void {
  document.documentElement.toggleAttribute('data-embed', true);
  options.delete('embed');
  byId('open-page', HTMLAnchorElement).search = options.toString();
}

function said(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
