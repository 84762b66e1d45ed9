/* tslint:disable */
/* eslint-disable */

/**
 * A regular grid of heights: row by row, each from west to east, the southern row first.
 */
export class Heights {
    private constructor();
    free(): void;
    [Symbol.dispose](): void;
    /**
     * The heights in metres. They can be taken once.
     */
    take_heights_m(): Float32Array;
    /**
     * Spacing of the samples, in metres.
     */
    readonly cell_m: number;
    /**
     * Samples from west to east.
     */
    readonly columns: number;
    /**
     * Samples from south to north.
     */
    readonly rows: number;
    /**
     * What was done to the file's numbers that its owner should know, each with the file's name.
     */
    readonly warnings: string[];
}

/**
 * Reads a file in the format that its extension names, as a recipe's `[import]` says.
 *
 * # Errors
 * A fault of the file, with its name, place, value and expectation.
 */
export function read_heights(file: string, bytes: Uint8Array | number[], cell_m: number | null | undefined, height_min_m: number | null | undefined, height_max_m: number | null | undefined, holes: string): Heights;

/**
 * Runs once when the page loads the module.
 */
export function start(): void;

export type InitInput = RequestInfo | URL | Response | BufferSource | WebAssembly.Module;

export interface InitOutput {
    readonly memory: WebAssembly.Memory;
    readonly __wbg_heights_free: (a: number, b: number) => void;
    readonly heights_cell_m: (a: number) => number;
    readonly heights_columns: (a: number) => number;
    readonly heights_rows: (a: number) => number;
    readonly heights_take_heights_m: (a: number) => [number, number];
    readonly heights_warnings: (a: number) => [number, number];
    readonly read_heights: (a: number, b: number, c: number, d: number, e: number, f: number, g: number, h: number, i: number, j: number, k: number, l: number) => [number, number, number];
    readonly start: () => void;
    readonly __wbindgen_externrefs: WebAssembly.Table;
    readonly __wbindgen_free: (a: number, b: number, c: number) => void;
    readonly __externref_drop_slice: (a: number, b: number) => void;
    readonly __wbindgen_malloc: (a: number, b: number) => number;
    readonly __wbindgen_realloc: (a: number, b: number, c: number, d: number) => number;
    readonly __externref_table_dealloc: (a: number) => void;
    readonly __wbindgen_start: () => void;
}

export type SyncInitInput = BufferSource | WebAssembly.Module;

/**
 * Instantiates the given `module`, which can either be bytes or
 * a precompiled `WebAssembly.Module`.
 *
 * @param {{ module: SyncInitInput }} module - Passing `SyncInitInput` directly is deprecated.
 *
 * @returns {InitOutput}
 */
export function initSync(module: { module: SyncInitInput } | SyncInitInput): InitOutput;

/**
 * If `module_or_path` is {RequestInfo} or {URL}, makes a request and
 * for everything else, calls `WebAssembly.instantiate` directly.
 *
 * @param {{ module_or_path: InitInput | Promise<InitInput> }} module_or_path - Passing `InitInput` directly is deprecated.
 *
 * @returns {Promise<InitOutput>}
 */
export default function __wbg_init (module_or_path?: { module_or_path: InitInput | Promise<InitInput> } | InitInput | Promise<InitInput>): Promise<InitOutput>;
