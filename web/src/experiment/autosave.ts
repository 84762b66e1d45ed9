/** Keeps the last experiment in the browser's own database, for the next visit. */

import type { Experiment } from './experiment.ts';
import { readExperiment } from './readExperiment.ts';

const STORE = 'experiments';
const KEY = 'last';
/** Several changes in a row are kept at once. */
const DELAY_MS = 400;

export class Autosave {
  readonly #failed: (why: string) => void;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #told = false;

  /** `failed` is called once, where the browser keeps nothing. */
  constructor(failed: (why: string) => void) {
    this.#failed = failed;
  }

  save(experiment: Experiment): void {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      keep(experiment).catch((error: unknown) => {
        if (this.#told) return;
        this.#told = true;
        const why = error instanceof Error ? error.message : String(error);
        this.#failed(`This browser does not keep your work for the next visit; save it as a file. (${why})`);
      });
    }, DELAY_MS);
  }
}

async function keep(experiment: Experiment): Promise<void> {
  await settled((await store('readwrite')).put(experiment, KEY));
}

/** What was kept, nothing when there is nothing; an error where it cannot be read. */
export async function kept(): Promise<Experiment | undefined> {
  const found: unknown = await settled((await store('readonly')).get(KEY));
  return found === undefined ? undefined : readExperiment(found);
}

async function store(mode: IDBTransactionMode): Promise<IDBObjectStore> {
  const request = indexedDB.open('mapless', 1);
  request.onupgradeneeded = () => request.result.createObjectStore(STORE);
  return (await settled(request)).transaction(STORE, mode).objectStore(STORE);
}

function settled<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error('The browser keeps nothing.'));
  });
}
