import { defineConfig, type Plugin } from 'vite';
import { offline } from './web/build/offline.ts';

/**
 * Nothing leaves the page's own origin: scripts, the worker, wasm and styles come from `self` and nothing else is
 * allowed. Only the built page carries the policy, because the development server injects inline styles.
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
          "connect-src 'self'",
          "worker-src 'self'",
          "manifest-src 'self'",
          "base-uri 'none'",
          "form-action 'none'",
        ].join('; '),
      },
    },
  ],
};

export default defineConfig({
  // Relative addresses: any static host serves the page, under any path.
  base: './',
  publicDir: 'web/public',
  plugins: [contentSecurityPolicy, offline],
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
