/** Loads the wasm module that reads heights from files (`crate/wasm-heights`). In the worker, when such a file is opened. */

/** The module, once it runs. */
export type HeightsModule = typeof import('../wasm/mapless_wasm_heights.js');

export async function loadHeights(): Promise<HeightsModule> {
  const module = await import('../wasm/mapless_wasm_heights.js');
  await module.default();
  return module;
}
