import { defineConfig, type Plugin } from 'vite';
import { offline } from './web/build/offline.ts';

/**
 * Scripts, the worker, wasm and styles come from `self` and nothing else is allowed. Data may be fetched from an address
 * that somebody gives. Only the built page carries the policy, because the development server injects inline styles.
 */
const contentSecurityPolicy: Plugin = {
  name: 'content-security-policy',
  apply: 'build',
  transformIndexHtml: () => [
    {
      tag: 'meta',
      injectTo: 'head-prepend',
      attrs: {
        'http-equiv': 'Content-Security-Policy',
        content: [
          "default-src 'none'",
          "script-src 'self' 'wasm-unsafe-eval'",
          "style-src 'self'",
          "img-src 'self' data: blob:",
          "connect-src 'self' https:",
          "worker-src 'self'",
          // planner.html has a policy of its own: there somebody's own planner is kept.
          "frame-src 'self'",
          "manifest-src 'self'",
          "base-uri 'none'",
          "form-action 'none'",
        ].join('; '),
      },
    },
  ],
};

/**
 * The page's main part is fetched beside the small entry that asks for it, not after it. The entry starts the core: it is
 * not to wait for a first picture, as browsers have `async` scripts do unless they are urgent.
 */
const startEarly: Plugin = {
  name: 'start-early',
  apply: 'build',
  transformIndexHtml: {
    order: 'post',
    handler(html, { bundle = {} }) {
      const page = Object.values(bundle).find((file) => file.type === 'chunk' && file.name === 'page');
      const entry = '<script async type="module"';
      if (!page || !html.includes(entry))
        throw new Error('The build has no entry, or no chunk of web/src/boot/page.ts.');
      const tags = [
        { tag: 'link', injectTo: 'head' as const, attrs: { rel: 'modulepreload', href: `./${page.fileName}` } },
      ];
      return { html: html.replace(entry, '<script async blocking="render" type="module"'), tags };
    },
  },
};

export default defineConfig({
  // Relative addresses: any static host serves the page, under any path.
  base: './',
  publicDir: 'web/public',
  plugins: [contentSecurityPolicy, startEarly, offline],
  worker: { format: 'es' },
  build: {
    target: 'es2022',
    outDir: 'dist',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 900,
  },
  preview: { host: '127.0.0.1', port: 8080 },
});
