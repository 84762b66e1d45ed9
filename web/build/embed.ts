/** Makes the npm package in `target/embed` of what `cargo xtask build` has made: `npm run embed`. */

import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, rmSync } from 'node:fs';
import { build } from 'vite';

const OUT = 'target/embed';
const SOURCE = 'web/embed';
const CORE = ['mapless_wasm.js', 'mapless_wasm.d.ts', 'mapless_wasm_bg.wasm'];

if (!existsSync('dist/index.html')) throw new Error('There is no dist/index.html: run cargo xtask build first.');
rmSync(OUT, { recursive: true, force: true });
mkdirSync(`${OUT}/wasm`, { recursive: true });
await build({
  configFile: false,
  logLevel: 'warn',
  build: {
    outDir: OUT,
    emptyOutDir: false,
    target: 'es2022',
    minify: false,
    lib: { entry: { scene: `${SOURCE}/scene.ts`, core: `${SOURCE}/core.ts` }, formats: ['es'] },
    rolldownOptions: {
      external: [/mapless_wasm\.js$/, /^node:/],
      output: {
        entryFileNames: '[name].js',
        paths: (id) => (id.endsWith('mapless_wasm.js') ? './wasm/mapless_wasm.js' : id),
      },
    },
  },
});
const types = ['--emitDeclarationOnly', '--declaration', '--noEmit', 'false', '--outDir', `${OUT}/types`];
execFileSync('npx', ['tsc', '-p', `${SOURCE}/tsconfig.json`, ...types], { stdio: 'inherit' });
for (const file of CORE) cpSync(`web/src/wasm/${file}`, `${OUT}/wasm/${file}`);
for (const file of ['package.json', 'README.md', 'example.html']) cpSync(`${SOURCE}/${file}`, `${OUT}/${file}`);
for (const file of ['LICENSE-MIT', 'LICENSE-APACHE']) cpSync(file, `${OUT}/${file}`);
cpSync('dist', `${OUT}/page`, { recursive: true });
// Types of the core stand beside those of what uses it.
mkdirSync(`${OUT}/types/src/wasm`, { recursive: true });
cpSync('web/src/wasm/mapless_wasm.d.ts', `${OUT}/types/src/wasm/mapless_wasm.d.ts`);
