/* tslint:disable */
/* eslint-disable */

/**
 * Names and contents of the files of a task: scenario and recipe are text, the heights a PNG image.
 */
export class VertiBenchTask {
    private constructor();
    free(): void;
    [Symbol.dispose](): void;
    /**
     * Of the heights.
     */
    heights_name: string;
    /**
     * The heights.
     */
    get heights(): Uint8Array;
    /**
     * The heights.
     */
    set heights(value: Uint8Array | number[]);
    /**
     * Of the recipe.
     */
    recipe_name: string;
    /**
     * The recipe of the terrain, with rocks and trees.
     */
    recipe: string;
    /**
     * Of the scenario.
     */
    scenario_name: string;
    /**
     * The scenario.
     */
    scenario: string;
}

/**
 * A world with its heights.
 */
export class VertiBenchWorld {
    private constructor();
    free(): void;
    [Symbol.dispose](): void;
    /**
     * The files of a pair, counted from 1, with all lengths times `scale`, such as `1/5`.
     *
     * # Errors
     * A rock or tree off the map, a pair that the world does not have, or what is no scale.
     */
    task(pair: number, scale: string): VertiBenchTask;
    /**
     * How steep and how dense it is: `low`, `mid` or `high`.
     */
    readonly difficulty: string;
    /**
     * Its number.
     */
    readonly number: number;
    /**
     * How many pairs of start and goal it has.
     */
    readonly pairs: number;
}

/**
 * Reads a world's description, `config3_mid.yaml` and its like, and its heights, `3.bmp`.
 *
 * # Errors
 * A fault of a file, with its name, place, value and expectation; ground that gives.
 */
export function read_verti_bench(config_name: string, config: string, image_name: string, image: Uint8Array | number[]): VertiBenchWorld;

/**
 * Runs once when the page loads the module.
 */
export function start(): void;

export type InitInput = RequestInfo | URL | Response | BufferSource | WebAssembly.Module;

export interface InitOutput {
    readonly memory: WebAssembly.Memory;
    readonly __wbg_get_vertibenchtask_heights: (a: number) => [number, number];
    readonly __wbg_get_vertibenchtask_heights_name: (a: number) => [number, number];
    readonly __wbg_get_vertibenchtask_recipe: (a: number) => [number, number];
    readonly __wbg_get_vertibenchtask_recipe_name: (a: number) => [number, number];
    readonly __wbg_get_vertibenchtask_scenario: (a: number) => [number, number];
    readonly __wbg_get_vertibenchtask_scenario_name: (a: number) => [number, number];
    readonly __wbg_set_vertibenchtask_heights: (a: number, b: number, c: number) => void;
    readonly __wbg_set_vertibenchtask_heights_name: (a: number, b: number, c: number) => void;
    readonly __wbg_set_vertibenchtask_recipe: (a: number, b: number, c: number) => void;
    readonly __wbg_set_vertibenchtask_recipe_name: (a: number, b: number, c: number) => void;
    readonly __wbg_set_vertibenchtask_scenario: (a: number, b: number, c: number) => void;
    readonly __wbg_set_vertibenchtask_scenario_name: (a: number, b: number, c: number) => void;
    readonly __wbg_vertibenchtask_free: (a: number, b: number) => void;
    readonly __wbg_vertibenchworld_free: (a: number, b: number) => void;
    readonly read_verti_bench: (a: number, b: number, c: number, d: number, e: number, f: number, g: number, h: number) => [number, number, number];
    readonly start: () => void;
    readonly vertibenchworld_difficulty: (a: number) => [number, number];
    readonly vertibenchworld_number: (a: number) => number;
    readonly vertibenchworld_pairs: (a: number) => number;
    readonly vertibenchworld_task: (a: number, b: number, c: number, d: number) => [number, number, number];
    readonly __wbindgen_externrefs: WebAssembly.Table;
    readonly __wbindgen_free: (a: number, b: number, c: number) => void;
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
