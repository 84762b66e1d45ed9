import { existsSync } from 'node:fs';
import { defineConfig } from '@playwright/test';

/** The machine's own browser: `CHROME`, or Debian's. Playwright's download is the last resort. */
const executablePath = [process.env.CHROME, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']
  .filter((path) => path !== undefined)
  .find((path) => existsSync(path));

const port = Number(process.env.MAPLESS_PAGE_PORT ?? 4173);

export default defineConfig({
  testDir: 'tests/page',
  outputDir: 'test-results',
  // The page renders in software and simulates in a worker: two pages at once would starve each other.
  workers: 1,
  fullyParallel: false,
  // Tests wait for what is to come, and a busy machine may take long: these end only what hangs.
  timeout: 1_200_000,
  expect: { timeout: 300_000 },
  reporter: [['list']],
  use: {
    // What a page keeps for a visit without a network costs each opening a tenth; tests of that allow it.
    serviceWorkers: 'block',
    actionTimeout: 300_000,
    baseURL: `http://127.0.0.1:${port}`,
    viewport: { width: 1440, height: 900 },
    // The processor draws the 3D view, and at half the resolution has less to do. Tests of the resolution set their own.
    deviceScaleFactor: 0.5,
    screenshot: 'only-on-failure',
    launchOptions: {
      ...(executablePath ? { executablePath } : {}),
      args: [
        '--no-sandbox',
        '--disable-background-networking',
        '--disable-component-update',
        '--disable-sync',
        '--no-first-run',
        '--disable-quic',
        '--enable-unsafe-swiftshader',
      ],
    },
  },
  webServer: {
    command: `npx vite preview --port ${port} --strictPort`,
    url: `http://127.0.0.1:${port}/`,
    reuseExistingServer: false,
    // The server is up when it answers; on a busy machine that takes longer than the minute given by default.
    timeout: 600_000,
  },
});
