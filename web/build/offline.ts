/** After the build: writes `sw.js`, the service worker with the list of the files that the page consists of. */

import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Plugin } from 'vite';

const TEMPLATE = 'web/src/offline/sw.js';

export const offline: Plugin = {
  name: 'offline',
  apply: 'build',
  writeBundle({ dir = 'dist' }) {
    const files = readdirSync(dir, { recursive: true, withFileTypes: true })
      .filter((entry) => entry.isFile() && entry.name !== 'sw.js')
      .map((entry) => join(entry.parentPath, entry.name))
      .sort();
    const hash = createHash('sha256');
    for (const file of [TEMPLATE, ...files]) hash.update(file).update(readFileSync(file));
    const paths = files.map((file) => file.slice(dir.length + 1).replaceAll('\\', '/'));
    const worker = readFileSync(TEMPLATE, 'utf8')
      .replace("'%VERSION%'", JSON.stringify(hash.digest('hex').slice(0, 16)))
      .replace("['%FILES%']", JSON.stringify(paths));
    writeFileSync(join(dir, 'sw.js'), worker);
  },
};
