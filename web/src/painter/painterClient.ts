/** The page's end of the worker that draws the 3D view. */

import type { Theme } from '../colours/theme.ts';
import type { FromPainter, ToPainter } from './painterProtocol.ts';

/** What becomes of the view by itself. */
export interface Graphics {
  /** There is no view, as the browser offers no WebGL 2. */
  unavailable(): void;
  /** The first picture is there. */
  drawn(): void;
  /** There is no view any more, as drawing it met an error. */
  broken(message: string): void;
  /** The graphics driver refused to draw something, which is missing in the view. */
  refused(why: string): void;
  /** The graphics driver took the view away. */
  lost(): void;
  restored(): void;
}

export class PainterClient {
  readonly #worker: Worker;
  readonly #resting = new Map<number, () => void>();
  readonly #graphics: Graphics;
  #available = true;
  #nextId = 0;
  /** Hears of each picture while somebody films, and of there being no more; the picture is its to close. */
  #film: ((picture: ImageBitmap | undefined) => void) | undefined;

  /** Draws on `canvas` from now on. Throws where the browser cannot hand it over. */
  constructor(canvas: HTMLCanvasElement, theme: Theme, graphics: Graphics) {
    this.#graphics = graphics;
    const offscreen = canvas.transferControlToOffscreen();
    this.#worker = new Worker(new URL('./painterWorker.ts', import.meta.url), {
      type: 'module',
      name: 'mapless painter',
    });
    this.#worker.onmessage = ({ data }: MessageEvent<FromPainter>) => this.#receive(data);
    this.#worker.onerror = (event) => {
      event.preventDefault();
      this.#giveUp();
      this.#graphics.broken(event.message || 'its script could not be loaded');
    };
    this.send({ type: 'begin', canvas: offscreen, theme, devicePixelRatio: window.devicePixelRatio }, [offscreen]);
  }

  send(message: ToPainter, transfer: Transferable[] = []): void {
    this.#worker.postMessage(message, transfer);
  }

  /** Resolves once everything sent before is drawn and nothing changes by itself any more. */
  rest(): Promise<void> {
    if (!this.#available) return Promise.resolve();
    const id = this.#nextId++;
    return new Promise((resolve) => {
      this.#resting.set(id, resolve);
      this.send({ type: 'rest', id });
    });
  }

  /** Gives each picture to `film` from now on, the first of them in full resolution if it is to be `fine`, or to nobody. */
  film(film: ((picture: ImageBitmap | undefined) => void) | undefined, fine: boolean): void {
    if (film && !this.#available) throw new Error('there is no 3D view');
    this.#film = film;
    this.send({ type: 'film', wanted: film !== undefined, fine });
  }

  #receive(message: FromPainter): void {
    switch (message.type) {
      case 'unavailable':
        this.#giveUp();
        this.#graphics.unavailable();
        break;
      case 'drawn':
        this.#graphics.drawn();
        break;
      case 'refused':
        this.#graphics.refused(message.why);
        break;
      case 'lost':
        this.#graphics.lost();
        break;
      case 'restored':
        this.#graphics.restored();
        break;
      case 'picture':
        if (this.#film) this.#film(message.picture);
        else message.picture.close();
        break;
      case 'rested':
        this.#resting.get(message.id)?.();
        this.#resting.delete(message.id);
        break;
    }
  }

  /** There is no view; nobody waits for it any more. */
  #giveUp(): void {
    this.#available = false;
    this.#worker.terminate();
    for (const rested of this.#resting.values()) rested();
    this.#resting.clear();
    this.#film?.(undefined);
  }
}
