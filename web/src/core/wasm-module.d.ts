/** Lets the page be checked before the core is built; where the generated types exist, they win. */
declare module '*/mapless_wasm.js' {
  const start: () => Promise<unknown>;
  export default start;
  export const Session: import('./wasm.ts').CoreModule['Session'];
  export const terrain_of: import('./wasm.ts').CoreModule['terrain_of'];
}
