/** The command line, which drives the same way as the page. */

import { spawnSync } from 'node:child_process';

/** What `mapless run` prints of a trial. */
export interface Driven {
  readonly outcome: string;
  readonly metrics: Readonly<Record<string, number>>;
  readonly ticks: number;
  readonly digest: string;
}

/** Drives a trial with `mapless run`; `args` are its file and options. */
export function driven(...args: string[]): Driven {
  return JSON.parse(said('run', ...args, '--json'));
}

/** What the command line says. */
export function said(...args: string[]): string {
  const run = spawnSync('target/debug/mapless', args, { encoding: 'utf8' });
  if (run.error)
    throw new Error('Build the command line first: cargo build --package mapless-cli', { cause: run.error });
  if (!run.stdout) throw new Error(run.stderr);
  return run.stdout;
}
