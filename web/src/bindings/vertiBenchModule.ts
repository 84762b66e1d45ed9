/** Loads the wasm module that reads worlds of Verti-Bench (`crate/wasm-verti-bench`), when such a world is opened. */

/** The module, once it runs. */
export type VertiBenchModule = typeof import('../wasm/mapless_wasm_verti_bench.js');

export async function loadVertiBench(): Promise<VertiBenchModule> {
  const module = await import('../wasm/mapless_wasm_verti_bench.js');
  await module.default();
  return module;
}
