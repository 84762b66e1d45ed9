/** Faults that nobody expected, in words: nothing fails in silence. */

import { byId, setText } from '../base/dom.ts';
import { messageOf } from '../base/messageOf.ts';
import type { Graphics } from '../painter/painterClient.ts';

const ADVICE = 'If something no longer answers, reload the page.';

export function watchFaults(show: (message: string) => void): void {
  window.addEventListener('error', ({ message }) => show(`The page met an error: ${message}. ${ADVICE}`));
  window.addEventListener('unhandledrejection', ({ reason }) => {
    show(`The page met an error: ${messageOf(reason)}. ${ADVICE}`);
  });
}

/** How long a view that was taken away may need to come back. */
const RESTORE_TIMEOUT_MS = 12_000;

/** A first picture that takes no longer than this needs no words. */
const UNNOTICED_MS = 1000;

/** Says what becomes of the view: the graphics driver may take it away, and three.js brings it back with the context. */
export function watchGraphics(show: (message: string) => void, hide: () => void): Graphics {
  let waiting: ReturnType<typeof setTimeout> | undefined;
  const drawing = byId('drawing', HTMLElement);
  const slow = setTimeout(() => setText(drawing, 'Drawing the view…'), UNNOTICED_MS);
  const drawn = () => {
    clearTimeout(slow);
    setText(drawing, '');
  };
  return {
    drawn,
    unavailable() {
      drawn();
      byId('no-view', HTMLElement).hidden = false;
    },
    broken(message) {
      drawn();
      show(`The 3D view stopped on an error: ${message}. Everything else works; reload the page to get it back.`);
    },
    refused(why) {
      show(
        `The graphics driver refused to draw a part of the 3D view, which is missing: ${why}. Everything else works.`,
      );
    },
    lost() {
      show('The graphics driver took the 3D view away. It comes back by itself; the simulation goes on.');
      waiting = setTimeout(() => {
        show(
          'The 3D view has not come back: the graphics driver is busy or gone. Everything else goes on; reloading the page may bring it back.',
        );
      }, RESTORE_TIMEOUT_MS);
    },
    restored() {
      clearTimeout(waiting);
      hide();
    },
  };
}
