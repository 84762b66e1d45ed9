/**
 * In a frame of another page, with `?embed`: that page may use `window.mapless` by messages. The frame says `mapless`; the
 * page around it answers with a port, which takes calls and gives results.
 */

import { messageOf } from '../base/messageOf.ts';
import type { MaplessApi } from './windowApi.ts';

/** Said by the frame once it can be used, and by the page around it with a port. */
export const GREETING = 'mapless';

export interface Call {
  readonly id: number;
  readonly method: string;
  readonly given: readonly unknown[];
}

export type Reply = { readonly id: number; readonly result: unknown } | { readonly id: number; readonly fault: string };

export function answerFrame(api: MaplessApi): void {
  if (window.parent === window) return;
  window.addEventListener('message', ({ data, source, ports: [port] }) => {
    if (source !== window.parent || data !== GREETING || !port) return;
    port.onmessage = ({ data: call }: MessageEvent<Call>) => {
      answer(api, call).then((reply) => port.postMessage(reply));
    };
  });
  window.parent.postMessage(GREETING, '*');
}

async function answer(api: MaplessApi, { id, method, given }: Call): Promise<Reply> {
  try {
    if (!Object.hasOwn(api, method)) throw new Error(`no method ${method}: expected ${Object.keys(api).join(', ')}`);
    const act = api[method as keyof MaplessApi] as (...given: readonly unknown[]) => unknown;
    return { id, result: await act(...given) };
  } catch (error) {
    return { id, fault: messageOf(error) };
  }
}
