/** Loads the wasm module that decides recorded drives again (`crate/wasm-replay`). In a worker, when a recording is opened. */

/** The module, once it runs. */
export type ReplayModule = typeof import('../wasm/mapless_wasm_replay.js');

export async function loadReplay(): Promise<ReplayModule> {
  const module = await import('../wasm/mapless_wasm_replay.js');
  await module.default();
  return module;
}
