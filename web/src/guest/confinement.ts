/**
 * Keeps somebody's own planner where it can do no harm: in a worker of a frame without origin, whose policy allows no
 * request at all. Whatever it answers comes through one port.
 */

import box from './box.js?raw';
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

const POLICY = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:";

export function confine({ code }: OwnPlanner): Confined {
  const { port1, port2 } = new MessageChannel();
  const frame = document.createElement('iframe');
  frame.sandbox.add('allow-scripts');
  frame.hidden = true;
  frame.title = 'Your own planner';
  frame.srcdoc = `<meta http-equiv="Content-Security-Policy" content="${POLICY}"><script>${box}</script>`;
  frame.addEventListener('load', () => frame.contentWindow?.postMessage({ script, code, port: port2 }, '*', [port2]), {
    once: true,
  });
  document.body.append(frame);
  return { port: port1, end: () => frame.remove() };
}
