/** The machine's own Firefox, driven by WebDriver BiDi, which it speaks by itself: Playwright drives its own build alone. */

import { type ChildProcess, spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { expect } from '@playwright/test';
import WebSocket from 'ws';

/** `FIREFOX`, or Debian's; nothing where there is none. */
export const FIREFOX = [process.env.FIREFOX, '/usr/bin/firefox-esr', '/usr/bin/firefox'].find(
  (path) => path !== undefined && existsSync(path),
);

interface Answer {
  readonly id?: number;
  readonly result?: unknown;
  readonly error?: string;
  readonly message?: string;
  /** Of an event. */
  readonly method?: string;
  readonly params?: { readonly type: string; readonly level: string; readonly text: string };
}

export class Firefox {
  /** What scripts threw and nobody caught. */
  readonly faults: string[] = [];
  readonly #process: ChildProcess;
  readonly #profile: string;
  readonly #socket: WebSocket;
  #context = '';
  #nextId = 0;

  private constructor(process: ChildProcess, profile: string, socket: WebSocket) {
    this.#process = process;
    this.#profile = profile;
    this.#socket = socket;
    socket.on('message', (data) => {
      const { method, params }: Answer = JSON.parse(String(data));
      const thrown = method === 'log.entryAdded' && params?.type === 'javascript' && params.level === 'error';
      if (thrown) this.faults.push(params.text);
    });
  }

  /** Opens an address in a new profile and waits until it has loaded. */
  static async open(path: string, address: string): Promise<Firefox> {
    const profile = mkdtempSync(join(tmpdir(), 'firefox-'));
    mkdirSync(join(profile, 'downloads'));
    const settings = {
      'browser.download.folderList': 2,
      'browser.download.dir': join(profile, 'downloads'),
      'browser.download.always_ask_before_handling_new_types': false,
    };
    const lines = Object.entries(settings).map(
      (pair) => `user_pref(${pair.map((one) => JSON.stringify(one)).join()});`,
    );
    writeFileSync(join(profile, 'user.js'), lines.join('\n'));
    const args = ['--headless', '--no-remote', '--profile', profile, '--remote-debugging-port=0', 'about:blank'];
    const process = spawn(path, args, { stdio: ['ignore', 'ignore', 'pipe'] });
    const socket = new WebSocket(`${await listening(process)}/session`);
    await new Promise((resolve, reject) => socket.once('open', resolve).once('error', reject));
    const firefox = new Firefox(process, profile, socket);
    await firefox.#ask('session.new', { capabilities: {} });
    await firefox.#ask('session.subscribe', { events: ['log.entryAdded'] });
    const { contexts } = (await firefox.#ask('browsingContext.getTree', {})) as { contexts: { context: string }[] };
    firefox.#context = contexts[0]?.context ?? '';
    await firefox.goto(address);
    return firefox;
  }

  /** Goes to an address and waits until it has loaded. */
  async goto(url: string): Promise<void> {
    await this.#ask('browsingContext.navigate', { context: this.#context, url, wait: 'complete' });
  }

  /** What a function gives in the page, or the promise that it gives: plain data alone, as what it is called with. */
  async evaluate<Result, Argument = undefined>(
    work: (argument: Argument) => Result | Promise<Result>,
    argument?: Argument,
  ): Promise<Result> {
    const call = `(${work})(${JSON.stringify(argument)})`;
    const answer = (await this.#ask('script.evaluate', {
      expression: `Promise.resolve(${call}).then((value) => JSON.stringify({ value }))`,
      target: { context: this.#context },
      awaitPromise: true,
    })) as { result?: { value: string }; exceptionDetails?: { text: string } };
    if (!answer.result) throw new Error(`${call}: ${answer.exceptionDetails?.text}`);
    return JSON.parse(answer.result.value).value;
  }

  /** Clicks an element as soon as there is one. */
  async click(selector: string): Promise<void> {
    const clicked = (asked: string) => {
      const found = document.querySelector<HTMLElement>(asked);
      found?.click();
      return found !== null;
    };
    await expect.poll(() => this.evaluate(clicked, selector)).toBe(true);
  }

  /** The text of a file that is being saved, once it is there. */
  async saved(name: string): Promise<string> {
    const file = join(this.#profile, 'downloads', name);
    // It is there from the beginning, but empty.
    await expect.poll(() => existsSync(file) && statSync(file).size > 0 && !existsSync(`${file}.part`)).toBe(true);
    return readFileSync(file, 'utf8');
  }

  async close(): Promise<void> {
    const gone = new Promise((resolve) => this.#process.once('exit', resolve));
    this.#socket.close();
    this.#process.kill();
    await gone;
    rmSync(this.#profile, { recursive: true, force: true });
  }

  #ask(method: string, params: object): Promise<unknown> {
    const id = this.#nextId++;
    return new Promise((resolve, reject) => {
      const hear = (data: WebSocket.RawData) => {
        const answer: Answer = JSON.parse(String(data));
        if (answer.id !== id) return;
        this.#socket.off('message', hear);
        if (answer.error) reject(new Error(`${method}: ${answer.error}, ${answer.message}`));
        else resolve(answer.result);
      };
      this.#socket.on('message', hear);
      this.#socket.send(JSON.stringify({ id, method, params }));
    });
  }
}

/** The address at which a Firefox that has just begun listens. */
function listening(process: ChildProcess): Promise<string> {
  return new Promise((resolve, reject) => {
    let said = '';
    process.once('error', reject);
    process.once('exit', () => reject(new Error(`Firefox ended: ${said}`)));
    process.stderr?.on('data', (part) => {
      said += part;
      const address = /WebDriver BiDi listening on (ws:\S+)/.exec(said)?.[1];
      if (address) resolve(address);
    });
  });
}
