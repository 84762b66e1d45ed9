/** `npm run lighthouse`: audits the built page with Lighthouse, prints the scores, and fails below the page's goals. */

import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { preview } from 'vite';

const LIGHTHOUSE = 'lighthouse@12.8.2';
const GOALS: Readonly<Record<string, number>> = { performance: 95, accessibility: 100, 'best-practices': 100 };

interface Report {
  readonly categories: Record<
    string,
    { readonly score: number; readonly auditRefs: readonly { readonly id: string }[] }
  >;
  readonly audits: Record<
    string,
    { readonly score: number | null; readonly title: string; readonly displayValue?: string }
  >;
}

const server = await preview({ preview: { host: '127.0.0.1', port: Number(process.env.MAPLESS_PAGE_PORT ?? 4173) } });
const address = server.resolvedUrls?.local[0];
if (!address) throw new Error('The page is not served: build it first, with `npm run build`.');
const chrome = [process.env.CHROME, '/usr/bin/chromium', '/usr/bin/google-chrome'].find(
  (path) => path && existsSync(path),
);
const out = join(mkdtempSync(join(tmpdir(), 'lighthouse-')), 'report.json');
const flags = '--headless=new --no-sandbox --enable-unsafe-swiftshader --disable-background-networking';
const audit = spawn(
  'npx',
  [
    '--yes',
    LIGHTHOUSE,
    address,
    '--quiet',
    '--preset=desktop',
    `--only-categories=${Object.keys(GOALS).join(',')}`,
    `--chrome-flags=${flags}`,
    '--output=json',
    `--output-path=${out}`,
  ],
  { stdio: 'inherit', env: { ...process.env, ...(chrome ? { CHROME_PATH: chrome } : {}) } },
);
const code = await new Promise((resolve) => audit.on('close', resolve));
await server.close();
if (code !== 0) throw new Error(`Lighthouse ended with ${code}.`);

const report: Report = JSON.parse(readFileSync(out, 'utf8'));
for (const [category, goal] of Object.entries(GOALS)) {
  const { score = 0, auditRefs = [] } = report.categories[category] ?? {};
  const reached = Math.round(100 * score);
  process.stdout.write(`${category}: ${reached} (goal ${goal})\n`);
  if (reached < goal) process.exitCode = 1;
  for (const { id } of auditRefs) {
    const audit = report.audits[id];
    if (audit?.score !== null && audit && audit.score < 0.9) {
      process.stdout.write(`  ${audit.title} ${audit.displayValue ?? ''}\n`);
    }
  }
}
