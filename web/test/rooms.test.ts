/** The rooms of `web/src`: folders import each other in one direction only, and each file has a name of its own. */

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { basename, dirname, join, relative, sep } from 'node:path';
import { test } from 'node:test';
import { parseSync } from 'vite';

const ROOT = 'web/src';
/** wasm-bindgen writes this folder. */
const GENERATED = 'wasm';

/** For each room, the rooms that it imports, each with an import to show. */
type Imports = Map<string, Map<string, string>>;

interface SourceFile {
  /** Relative to `web/src`. */
  readonly path: string;
  readonly text: string;
}

function sources(): SourceFile[] {
  const paths = readdirSync(ROOT, { recursive: true, encoding: 'utf8' }).map((path) => path.split(sep).join('/'));
  return paths
    .filter((path) => path.endsWith('.ts') && !path.startsWith(`${GENERATED}/`))
    .map((path) => ({ path, text: readFileSync(join(ROOT, path), 'utf8') }));
}

/** What a file imports from beside it: values, types, modules loaded later, and the scripts of workers. */
function importsOf({ path, text }: SourceFile): string[] {
  const found: string[] = [];
  const visit = (node: unknown): void => {
    if (typeof node !== 'object' || node === null) return;
    const { type, source, callee, arguments: given } = node as Record<string, unknown>;
    const wanted =
      type === 'NewExpression' && (callee as { name?: string }).name === 'URL' ? [given].flat()[0] : source;
    const { value } = (wanted ?? {}) as { value?: unknown };
    if (typeof value === 'string' && value.startsWith('.')) found.push(value);
    for (const part of Object.values(node)) visit(part);
  };
  const { program, errors } = parseSync(path, text);
  assert.deepEqual(errors, [], path);
  visit(program);
  return found;
}

const roomOf = (path: string) => (dirname(path) === '.' ? 'the entry' : dirname(path));

function importsBetween(files: readonly SourceFile[]): Imports {
  const rooms: Imports = new Map();
  for (const file of files) {
    const from = roomOf(file.path);
    const targets = rooms.get(from) ?? new Map<string, string>();
    rooms.set(from, targets);
    for (const specifier of importsOf(file)) {
      const target = relative('.', join(dirname(file.path), specifier));
      const to = roomOf(target);
      if (to !== from && to !== GENERATED && !target.startsWith('..'))
        targets.set(to, `${file.path} imports ${target}`);
    }
  }
  return rooms;
}

/** The imports that lead from a room back to it; nothing where there are none. */
function circleIn(rooms: Imports): string[] | undefined {
  const done = new Set<string>();
  const visit = (room: string, trail: string[]): string[] | undefined => {
    if (trail.includes(room)) return [...trail.slice(trail.indexOf(room)), room];
    if (done.has(room)) return undefined;
    for (const next of rooms.get(room)?.keys() ?? []) {
      const circle = visit(next, [...trail, room]);
      if (circle) return circle;
    }
    done.add(room);
    return undefined;
  };
  for (const room of rooms.keys()) {
    const circle = visit(room, []);
    if (circle) return circle.slice(1).map((to, index) => rooms.get(circle[index] ?? '')?.get(to) ?? '');
  }
  return undefined;
}

test('no room imports a room that imports it, directly or by others', () => {
  const files = sources();
  assert.ok(files.length > 100);
  assert.equal(circleIn(importsBetween(files))?.join(', '), undefined);
});

test('a circle of rooms is named by its imports, whichever kind they are', () => {
  const lines = {
    type: "import type { A } from '../low/one.ts';",
    value: "import { a } from '../low/one.ts';",
    passedOn: "export { a } from '../low/one.ts';",
    later: "const a = () => import('../low/one.ts');",
    inline: "type A = import('../low/one.ts').A;",
    worker: "new Worker(new URL('../low/one.ts', import.meta.url));",
  };
  for (const [kind, text] of Object.entries(lines)) {
    const files = [
      { path: 'main.ts', text: "import './high/top.ts';" },
      { path: 'high/top.ts', text },
      { path: 'middle/two.ts', text: "import '../high/top.ts'; import 'three';" },
      { path: 'low/one.ts', text: "import '../middle/two.ts'; import rows from '../../../terrains/published.json';" },
    ];
    const circle = ['high/top.ts imports low/one.ts', 'low/one.ts imports middle/two.ts'];
    assert.deepEqual(circleIn(importsBetween(files)), [...circle, 'middle/two.ts imports high/top.ts'], kind);
    assert.equal(circleIn(importsBetween(files.slice(0, 3))), undefined, kind);
  }
});

test('each file has a name of its own', () => {
  const names = new Map<string, string[]>();
  for (const { path } of sources()) {
    const name = basename(path).toLowerCase();
    names.set(name, [...(names.get(name) ?? []), path]);
  }
  assert.deepEqual(
    [...names.values()].filter((paths) => paths.length > 1),
    [],
  );
});
