// `wasm.mjs node FOLDER` and `wasm.mjs CHROME FOLDER` answer requests as `mapless-bench` does, with the wasm module in FOLDER, here
// or on a page in the browser CHROME.

import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';

const [where, folder] = process.argv.slice(2);
const MODULE = 'mapless_bench.js';
const TYPES = { '.js': 'text/javascript', '.wasm': 'application/wasm', '': 'text/html' };

/** The answering function, with the module in this process. */
async function inNode() {
  const { initSync, answer } = await import(pathToFileURL(join(folder, MODULE)));
  initSync({ module: readFileSync(join(folder, 'mapless_bench_bg.wasm')) });
  return { answer, close: () => {} };
}

/** The answering function, with the module on a page of its own. */
async function inBrowser(executablePath) {
  const { chromium } = await import('@playwright/test');
  const page = `<script type="module">
    import init, { answer } from './${MODULE}';
    await init();
    window.answer = answer;
  </script>`;
  const server = createServer(({ url }, response) => {
    response.setHeader('Content-Type', TYPES[extname(url)] ?? 'application/octet-stream');
    try {
      response.end(url === '/' ? page : readFileSync(join(folder, url)));
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  const args = ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--disable-component-update', '--no-first-run'];
  const browser = await chromium.launch({ executablePath, args });
  const tab = await browser.newPage();
  tab.setDefaultTimeout(0);
  await tab.goto(`http://127.0.0.1:${server.address().port}/`);
  await tab.waitForFunction(() => window.answer !== undefined);
  return {
    answer: (request) => tab.evaluate((request) => window.answer(request), request),
    close: () => browser.close().then(() => server.close()),
  };
}

const { answer, close } = await (where === 'node' ? inNode() : inBrowser(where));
for await (const request of createInterface({ input: process.stdin })) {
  console.log(await answer(request));
}
await close();
