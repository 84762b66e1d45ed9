/** Lets the page be checked before the wasm modules are built; where the generated types exist, they win. */
declare module '*/mapless_wasm.js' {
  const start: (from: { module_or_path: Response }) => Promise<unknown>;
  export default start;
  export const Session: import('./wasm.ts').CoreModule['Session'];
  export const read_scenario: import('./wasm.ts').CoreModule['read_scenario'];
  export const generated_recipe: import('./wasm.ts').CoreModule['generated_recipe'];
  export const level_places: import('./wasm.ts').CoreModule['level_places'];
  export const terrain_preview: import('./wasm.ts').CoreModule['terrain_preview'];
}

declare module '*/mapless_wasm_baselines.js' {
  const start: () => Promise<unknown>;
  export default start;
  export const Ground: import('../trials/wasm.ts').TrialsModule['Ground'];
  export const Runner: import('../trials/wasm.ts').TrialsModule['Runner'];
  export const generated_task: import('../trials/wasm.ts').TrialsModule['generated_task'];
  export const wilson: import('../trials/wasm.ts').TrialsModule['wilson'];
  export const mean_and_deviation: import('../trials/wasm.ts').TrialsModule['mean_and_deviation'];
}
