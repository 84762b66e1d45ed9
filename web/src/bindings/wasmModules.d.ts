/** Lets the page be checked before the wasm modules are built; where the generated types exist, they win. */
declare module '*/mapless_wasm.js' {
  const start: (from: { module_or_path: Response }) => Promise<unknown>;
  export default start;
  export const Session: import('./simulationModule.ts').CoreModule['Session'];
  export const read_scenario: import('./simulationModule.ts').CoreModule['read_scenario'];
  export const generated_recipe: import('./simulationModule.ts').CoreModule['generated_recipe'];
  export const level_places: import('./simulationModule.ts').CoreModule['level_places'];
  export const terrain_preview: import('./simulationModule.ts').CoreModule['terrain_preview'];
}

declare module '*/mapless_wasm_baselines.js' {
  const start: () => Promise<unknown>;
  export default start;
  export const Ground: import('./trialsModule.ts').TrialsModule['Ground'];
  export const Runner: import('./trialsModule.ts').TrialsModule['Runner'];
  export const generated_task: import('./trialsModule.ts').TrialsModule['generated_task'];
  export const wilson: import('./trialsModule.ts').TrialsModule['wilson'];
  export const mean_and_deviation: import('./trialsModule.ts').TrialsModule['mean_and_deviation'];
}
