/** Places on the ground. World frame: x east, y north, in metres. */

export type { Goal, Heading, Place } from '../wasm/mapless_wasm.js';
