/** Loads the wasm core (`crate/wasm`). Its face is what wasm-bindgen writes from the Rust types. */

import { messageOf } from '../base/messageOf.ts';

/** The core, once it runs. */
export type Core = typeof import('../wasm/mapless_wasm.js');

/** Compiles and starts the core. */
export async function loadCore(): Promise<Core> {
  try {
    // The wasm is fetched beside the module that starts it, not after it.
    const [core, file] = await Promise.all([
      import('../wasm/mapless_wasm.js'),
      fetch(new URL('../wasm/mapless_wasm_bg.wasm', import.meta.url)),
    ]);
    await core.default({ module_or_path: file });
    return core;
  } catch (cause) {
    const why = messageOf(cause);
    throw new Error(`The simulation could not be loaded; reload the page to try again. (${why})`, { cause });
  }
}
