/** What the core writes a frame's arrays to. */

import type { FrameBuffers } from '../wasm/mapless_wasm.js';

/** Beams of a sensor that turns once: a ring has 1800. What a scan holds beyond these is left out. */
const BEAMS_PER_RING = 1800;
const FEWEST_RINGS = 16;

export function newFrameBuffers(image: {
  readonly columns: number;
  readonly rows: number;
  readonly rings: number;
}): FrameBuffers {
  const { columns, rows, rings } = image;
  const beams = BEAMS_PER_RING * Math.max(FEWEST_RINGS, rings);
  return {
    points: new Float32Array(3 * beams),
    return_kinds: new Uint8Array(beams),
    observed: new Float32Array(columns * rings),
    occupancy: new Float32Array(columns * rows),
    variance: new Float32Array(columns * rows),
    profile: new Float32Array(columns),
    former: new Float32Array(columns),
    truth: new Float32Array(columns),
    kinds: new Uint8Array(columns),
  };
}
