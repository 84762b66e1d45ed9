/** Shows what the page begins with. */

import type { App } from './app.ts';
import { CATALOGUE } from './core/catalogue.ts';
import { FIRST_SETUP } from './core/experiment.ts';
import type { Beginning } from './core/protocol.ts';
import { byId } from './ui/dom.ts';
import type { Notice } from './ui/notice.ts';

/** `begun` is what the core loads; `plainly` has it load what it would without an address. */
export async function begin(
  app: App,
  notice: Notice,
  begun: Promise<Beginning>,
  plainly: () => Promise<Beginning>,
): Promise<void> {
  const options = new URLSearchParams(location.search);
  if (options.has('embed')) embed(options);
  try {
    welcome(app, notice, await app.begin(begun));
  } catch (error) {
    // What was asked for does not work: say why, and show what does. That may be the very work of the last visit.
    await app.begin(plainly()).catch(() => first(app));
    notice.show(error instanceof Error ? error.message : String(error));
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

/** In another page's frame: the view alone, with a way out of it. */
function embed(options: URLSearchParams): void {
  document.documentElement.toggleAttribute('data-embed', true);
  options.delete('embed');
  byId('open-page', HTMLAnchorElement).search = options.toString();
}
