/** Loads the wasm module with all planners and generated tasks (`crate/wasm-baselines`). In a worker, when it is wanted. */

/** The module, once it runs. */
export type TrialsModule = typeof import('../wasm/mapless_wasm_baselines.js');

export async function loadTrials(): Promise<TrialsModule> {
  const module = await import('../wasm/mapless_wasm_baselines.js');
  await module.default();
  return module;
}
