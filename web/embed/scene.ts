/**
 * A running scene in somebody's page: `<mapless-scene scenario="gsb" seed="7"></mapless-scene>`. It is the page of mapless
 * in a frame, the view alone, and is used through `scene.api` with the methods of `window.mapless`.
 */

import { type Call, GREETING, type Reply } from '../src/app/framed.ts';
import type { MaplessApi, MaplessState } from '../src/app/windowApi.ts';

export type { MaplessApi, MaplessState };

/** The methods of `window.mapless` (docs/API.md), each of which gives a promise here. */
export type SceneApi = {
  readonly [Method in keyof MaplessApi]: (
    ...given: Parameters<MaplessApi[Method]>
  ) => Promise<Awaited<ReturnType<MaplessApi[Method]>>>;
};

/** What the address of the scene says. */
const ASKED = ['scenario', 'seed', 'preset', 'learning', 'reality', 't'] as const;

export class MaplessScene extends HTMLElement {
  /** Another place where the page is served, set before the scene is in the document; the package has it beside this file. */
  static page = new URL(/* @vite-ignore */ './page/index.html', import.meta.url).href;

  readonly #frame = document.createElement('iframe');
  readonly #waiting = new Map<number, { resolve(result: unknown): void; reject(error: Error): void }>();
  #calls = 0;
  #began: (api: SceneApi) => void = () => {};
  #api = new Promise<SceneApi>((resolve) => {
    this.#began = resolve;
  });

  /** Resolves once the scene can be used. */
  get api(): Promise<SceneApi> {
    return this.#api;
  }

  connectedCallback(): void {
    const asked = ASKED.flatMap((name) => {
      const value = this.getAttribute(name);
      return value === null ? [] : [`${name}=${encodeURIComponent(value)}`];
    });
    this.#frame.src = `${MaplessScene.page}?${['embed', ...asked].join('&')}`;
    this.#frame.title = this.getAttribute('title') ?? 'A robot drives over uneven ground';
    Object.assign(this.#frame.style, { border: '0', width: '100%', height: '100%', display: 'block' });
    if (!this.style.display) Object.assign(this.style, { display: 'block', aspectRatio: '16 / 10', maxHeight: '80vh' });
    window.addEventListener('message', this.#hear);
    this.replaceChildren(this.#frame);
  }

  disconnectedCallback(): void {
    window.removeEventListener('message', this.#hear);
    for (const { reject } of this.#waiting.values()) reject(new Error('The scene was taken out of the page.'));
    this.#waiting.clear();
  }

  readonly #hear = ({ data, source }: MessageEvent): void => {
    if (data !== GREETING || source !== this.#frame.contentWindow) return;
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = ({ data: reply }: MessageEvent<Reply>) => {
      const call = this.#waiting.get(reply.id);
      this.#waiting.delete(reply.id);
      if ('fault' in reply) call?.reject(new Error(reply.fault));
      else call?.resolve(reply.result);
    };
    this.#frame.contentWindow?.postMessage(GREETING, '*', [port2]);
    const ask = (method: string, given: readonly unknown[]) =>
      new Promise((resolve, reject) => {
        const call: Call = { id: this.#calls, method, given };
        this.#calls += 1;
        this.#waiting.set(call.id, { resolve, reject });
        port1.postMessage(call);
      });
    // A promise asks what it is given whether it is one itself.
    const get = (_: object, method: string) =>
      method === 'then' ? undefined : (...given: readonly unknown[]) => ask(method, given);
    this.#began(new Proxy({}, { get }) as SceneApi);
  };
}

declare global {
  interface HTMLElementTagNameMap {
    'mapless-scene': MaplessScene;
  }
}

customElements.define('mapless-scene', MaplessScene);
