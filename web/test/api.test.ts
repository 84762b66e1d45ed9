import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import type { App } from '../src/app/app.ts';
import { publish } from '../src/app/windowApi.ts';

test('docs/API.md names every method of the API and no other', () => {
  const page: { mapless?: object } = {};
  Object.assign(globalThis, { window: page });
  publish({} as App);
  const methods = Object.keys(page.mapless ?? {});
  const text = readFileSync(new URL('../../docs/API.md', import.meta.url), 'utf8');
  const rows = text.split('\n').filter((line) => line.startsWith('| `'));
  const named = rows.flatMap((row) => [...(row.split('|')[1] ?? '').matchAll(/`(\w+)\(/g)].map(([, name]) => name));
  assert.deepEqual(named.sort(), methods.sort());
});
