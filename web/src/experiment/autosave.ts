/** Keeps work in the browser's own database, for the next visit: each piece of work by itself, so that no tab overwrites another's. */

import { messageOf } from '../base/messageOf.ts';
import type { Experiment } from './experiment.ts';
import { readExperiment } from './readExperiment.ts';

const STORE = 'experiments';
/** Several changes in a row are kept at once. */
const DELAY_MS = 400;
/** Pieces of work that are kept; the oldest goes first. */
const MOST = 20;
/** Where a tab notes which piece of work is its own: another tab has another note. */
const NOTE = 'mapless-work';

/** When it was saved, which piece of work it is, and its name. They sort by time. */
type Key = [saved_ms: number, id: string, name: string];

/** A piece of work as it was kept. */
export interface Work {
  readonly id: string;
  readonly experiment: Experiment;
}

export class Autosave {
  readonly #failed: (why: string) => void;
  #id = newId();
  /** The piece of work that other tabs know to be taken. */
  #taken: string | undefined;
  #last: Experiment | undefined;
  #edited = false;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #told = false;

  /** `failed` is called once, where the browser keeps nothing. */
  constructor(failed: (why: string) => void) {
    this.#failed = failed;
  }

  /** Goes on with a piece of work that was kept, unless another tab is at it. */
  async goOnWith({ id, experiment }: Work): Promise<void> {
    if (!(await ownedBy(id)) || this.#last) return;
    [this.#id, this.#taken, this.#last, this.#edited] = [id, id, experiment, true];
  }

  /** `edited`: whether anything of it was made here; what was only opened gives way to what is opened next. */
  save(experiment: Experiment, edited: boolean): void {
    const another = this.#last !== undefined && !sameWork(this.#last, experiment);
    if (another && this.#edited) {
      this.#flush();
      this.#id = newId();
    }
    this.#edited = edited || (this.#edited && !another);
    this.#last = experiment;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#flush(), DELAY_MS);
  }

  #flush(): void {
    clearTimeout(this.#timer);
    if (!this.#timer || !this.#last) return;
    this.#timer = undefined;
    if (this.#taken !== this.#id) void ownedBy(this.#id);
    this.#taken = this.#id;
    keep(this.#id, this.#last).catch((error: unknown) => {
      if (this.#told) return;
      this.#told = true;
      const why = messageOf(error);
      this.#failed(`This browser does not keep your work for the next visit; save it as a file. (${why})`);
    });
  }
}

/** Whether one is the other with changes, as far as can be told. */
export function sameWork(one: Experiment, other: Experiment): boolean {
  if (one.name !== other.name) return false;
  return one.terrain === other.terrain || JSON.stringify(one.terrain) === JSON.stringify(other.terrain);
}

function newId(): string {
  return `${Date.now().toString(36)}-${Math.random().toString(36).slice(2, 10)}`;
}

/** Whether this tab alone is at this piece of work, from now on. Where a browser cannot tell, it is not. */
async function ownedBy(id: string): Promise<boolean> {
  if (!navigator.locks) return false;
  return new Promise((resolve) => {
    // Held for as long as the page is open.
    navigator.locks.request(`mapless ${id}`, { ifAvailable: true }, (lock) => {
      resolve(lock !== null);
      return lock ? new Promise(() => undefined) : undefined;
    });
  });
}

async function keep(id: string, experiment: Experiment): Promise<void> {
  sessionNote(id);
  const kept = await store('readwrite');
  const keys = await allKeys(kept);
  const key: Key = [Date.now(), id, experiment.name];
  await settled(kept.put(experiment, key));
  const before = keys.filter((one) => idOf(one) === id);
  const others = keys.filter((one) => idOf(one) !== id);
  for (const old of [...before, ...others.slice(0, Math.max(others.length + 1 - MOST, 0))]) {
    if (indexedDB.cmp(old, key) !== 0) kept.delete(old);
  }
}

/** This tab's own piece of work, or else the newest of any; nothing when there is none, an error where it cannot be read. */
export async function kept(tab: string | undefined): Promise<Work | undefined> {
  const all = await store('readonly');
  const keys = await allKeys(all);
  const key = keys.find((one) => idOf(one) === tab) ?? keys.at(-1);
  if (key === undefined) return undefined;
  return { id: idOf(key), experiment: readExperiment(await settled(all.get(key))) };
}

/** What is known of all that was kept, the newest first. */
export async function works(): Promise<{ id: string; name: string; saved: Date }[]> {
  const keys = (await allKeys(await store('readonly'))) as Key[];
  return keys
    .flatMap((key) => (Array.isArray(key) ? [{ id: key[1], name: key[2], saved: new Date(key[0]) }] : []))
    .reverse();
}

/** Which piece of work this tab was at. */
export function workOfTab(): string | undefined {
  try {
    return sessionStorage.getItem(NOTE) ?? undefined;
  } catch {
    return undefined;
  }
}

function sessionNote(id: string): void {
  try {
    sessionStorage.setItem(NOTE, id);
  } catch {
    // Where a browser keeps no notes, the newest work of all is the next visit's.
  }
}

/** The oldest first. */
function allKeys(all: IDBObjectStore): Promise<IDBValidKey[]> {
  return settled(all.getAllKeys());
}

function idOf(key: IDBValidKey): string {
  return Array.isArray(key) ? String(key[1]) : String(key);
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
