// `page_memory.mjs CHROME DIST SECONDS` plays the built page in DIST and prints what it holds then, in bytes: JavaScript and wasm of
// the page and its worker, after a collection.

import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { setTimeout } from 'node:timers/promises';
import { chromium } from '@playwright/test';

const [executablePath, dist, seconds] = process.argv.slice(2);
const TYPES = {
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.html': 'text/html',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml',
};

const server = createServer(({ url }, response) => {
  // A page that is isolated from others may ask for its own memory.
  response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
  response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
  const path = url === '/' ? '/index.html' : new URL(url, 'http://localhost').pathname;
  response.setHeader('Content-Type', TYPES[extname(path)] ?? 'application/octet-stream');
  try {
    response.end(readFileSync(join(dist, path)));
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] });
try {
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.locator('#outcome').filter({ hasText: 'Driving' }).waitFor();
  await setTimeout(1000 * Number(seconds));
  // The browser answers at its own time, within 20 s.
  const { bytes } = await page.evaluate(() => performance.measureUserAgentSpecificMemory());
  console.log(bytes);
} finally {
  await browser.close();
  server.close();
}
