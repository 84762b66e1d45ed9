/** A colour scale as a texture for shaders. */

import { DataTexture, LinearFilter, SRGBColorSpace } from 'three';
import { type Rgb, ramp } from '../colours/scale.ts';

const STEPS = 64;

export function scaleTexture(stops: readonly Rgb[]): DataTexture {
  const bytes = new Uint8Array(4 * STEPS);
  for (let step = 0; step < STEPS; step += 1) bytes.set([...ramp(stops, step / (STEPS - 1)), 255], 4 * step);
  const texture = new DataTexture(bytes, STEPS, 1);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = LinearFilter;
  texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
