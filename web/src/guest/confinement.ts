/**
 * Keeps somebody's own planner where it can do no harm: in a worker of a frame without origin, which has no storage of the
 * page, under a policy that allows no request at all (`web/public/planner.html`). It answers through one port.
 */

import script from './guestWorker.js?raw';

/** A module in JavaScript as text, or in WebAssembly as bytes. */
export interface OwnPlanner {
  readonly name: string;
  readonly code: string | Uint8Array<ArrayBuffer>;
}

export interface Confined {
  readonly port: MessagePort;
  /** Ends it, whatever it is doing. */
  end(): void;
}

export function confine({ code }: OwnPlanner): Confined {
  const { port1, port2 } = new MessageChannel();
  const frame = document.createElement('iframe');
  frame.hidden = true;
  frame.title = 'Your own planner';
  frame.src = './planner.html';
  frame.addEventListener('load', () => {
    const inner = frame.contentWindow?.frames[0];
    if (inner) inner.postMessage({ script, code, port: port2 }, '*', [port2]);
    else port2.postMessage({ fault: 'planner.html could not be loaded' });
  });
  document.body.append(frame);
  return { port: port1, end: () => frame.remove() };
}
