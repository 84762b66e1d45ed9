/** Files from an address, with those that they name. Loaded when somebody gives one. */

import { messageOf } from '../base/messageOf.ts';
import { MAX_FILE_BYTES } from '../experiment/experiment.ts';

/** As large as an archive that the page opens. */
const MOST_BYTES = 2 * MAX_FILE_BYTES;
/** A scenario, its recipe and the grid of that. */
const MOST_FILES = 3;

/**
 * The file at an address, and those that it names by relative paths: a scenario its terrain, a recipe its heights, a
 * world of Verti-Bench its image. `formats` are the endings of what the page opens. Throws what is wrong, with the address.
 */
export async function filesAt(address: string, formats: readonly string[], signal: AbortSignal): Promise<File[]> {
  const files: File[] = [];
  let next: URL | undefined = addressOf(address);
  while (next && files.length < MOST_FILES) {
    const name = nameOf(next);
    if (!formats.some((ending) => name.toLowerCase().endsWith(ending))) {
      throw new Error(`${next}: not a format that this page opens: expected a name that ends in ${formats.join(', ')}`);
    }
    const bytes = await bytesAt(next, signal);
    files.push(new File([bytes], name));
    next = namedBy(name, bytes, next);
  }
  return files;
}

/** GitHub's page of a file stands for the file. */
function addressOf(address: string): URL {
  const expected = () => new Error(`${address}: expected an address that begins with https://`);
  let url: URL;
  try {
    url = new URL(address);
  } catch {
    throw expected();
  }
  if (url.protocol !== 'https:' && url.origin !== location.origin) throw expected();
  const [owner, project, blob, ...path] = url.pathname.slice(1).split('/');
  if (url.hostname !== 'github.com' || blob !== 'blob') return url;
  return new URL(`https://raw.githubusercontent.com/${owner}/${project}/${path.join('/')}`);
}

function nameOf({ pathname }: URL): string {
  const name = pathname.split('/').pop() ?? '';
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

/** Where the file lies that belongs to another one. */
function namedBy(name: string, bytes: Uint8Array, at: URL): URL | undefined {
  const path = pathIn(name, bytes);
  if (path === undefined) return undefined;
  const named = URL.canParse(path, at) ? new URL(path, at) : undefined;
  if (named?.origin !== at.origin) throw new Error(`${at}: names ${path}: expected a path from there on the same host`);
  return named;
}

function pathIn(name: string, bytes: Uint8Array): string | undefined {
  const world = /^config(\d+)_.*\.yaml$/i.exec(name);
  if (world) return `../../Worlds/${world[1]}.bmp`;
  if (!/\.toml$/i.test(name)) return undefined;
  return /^\s*(?:terrain|file)\s*=\s*(["'])(.+?)\1/m.exec(new TextDecoder().decode(bytes))?.[2];
}

async function bytesAt(url: URL, signal: AbortSignal): Promise<Uint8Array<ArrayBuffer>> {
  const response = await answerOf(url, signal);
  if (response.status === 404 || response.status === 410) throw new Error(`${url}: not found (${response.status})`);
  if (!response.ok) throw new Error(`${url}: refused with ${`${response.status} ${response.statusText}`.trim()}`);
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let size = 0;
  const reader = response.body?.getReader();
  const read = () => reader?.read().catch((cause: unknown) => broken(url, signal, cause));
  for (let part = await read(); part?.value; part = await read()) {
    parts.push(part.value);
    size += part.value.length;
    if (size <= MOST_BYTES) continue;
    await reader?.cancel();
    throw new Error(`${url}: more than ${MOST_BYTES} bytes: expected no more. Save the file and open that`);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/** Neither cookies nor the page's own address go along. */
const ANONYMOUS = { credentials: 'omit', referrerPolicy: 'no-referrer' } as const;

async function answerOf(url: URL, signal: AbortSignal): Promise<Response> {
  try {
    return await fetch(url, { ...ANONYMOUS, signal });
  } catch (cause) {
    signal.throwIfAborted();
    // Browsers do not say whether nobody answered, or the answer is withheld.
    const answers = await fetch(url, { ...ANONYMOUS, signal, mode: 'no-cors' }).then(
      () => true,
      () => false,
    );
    signal.throwIfAborted();
    throw new Error(answers ? `${url}: ${WITHHELD}` : `${url}: cannot be reached`, { cause });
  }
}

// An answer that there is no such file may be withheld, too.
const WITHHELD = 'its server does not let other pages read it (CORS), or has no such file: save the file and open that';

function broken(url: URL, signal: AbortSignal, cause: unknown): never {
  signal.throwIfAborted();
  throw new Error(`${url}: broke off: ${messageOf(cause)}`, { cause });
}
