/** The path driven so far, as a line of constant width on the screen. */

import { InstancedInterleavedBuffer, InterleavedBufferAttribute } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Theme } from '../colours/theme.ts';
import { colour } from './relief.ts';

/** Points are kept at this distance, so that the longest trials fit. */
const SPACING_M = 0.15;
const CAPACITY = 8192;
const LIFT_M = 0.07;

export class Route {
  readonly line: LineSegments2;
  readonly #buffer = new InstancedInterleavedBuffer(new Float32Array(6 * CAPACITY), 6, 1);
  readonly #material: LineMaterial;
  #last: [number, number, number] | undefined;
  #count = 0;

  constructor(opacity = 0.95) {
    this.#material = new LineMaterial({ linewidth: 3.5, transparent: true, opacity });
    const geometry = new LineSegmentsGeometry();
    geometry.setAttribute('instanceStart', new InterleavedBufferAttribute(this.#buffer, 3, 0));
    geometry.setAttribute('instanceEnd', new InterleavedBufferAttribute(this.#buffer, 3, 3));
    geometry.instanceCount = 0;
    this.line = new LineSegments2(geometry, this.#material);
    this.line.frustumCulled = false;
  }

  theme(theme: Theme): void {
    this.#material.color.copy(colour(theme.accent));
  }

  /** A colour of its own, for the path of another robot. */
  paint(hex: string): void {
    this.#material.color.set(hex);
  }

  clear(): void {
    this.#last = undefined;
    this.#count = 0;
    this.line.geometry.instanceCount = 0;
  }

  extend(xyz: Float32Array): void {
    const first = this.#count;
    for (let index = 0; index + 2 < xyz.length; index += 3) {
      const point: [number, number, number] = [xyz[index] ?? 0, xyz[index + 1] ?? 0, (xyz[index + 2] ?? 0) + LIFT_M];
      if (!this.#last) {
        this.#last = point;
        continue;
      }
      const away_m = Math.hypot(point[0] - this.#last[0], point[1] - this.#last[1]);
      if (away_m < SPACING_M || this.#count >= CAPACITY) continue;
      this.#buffer.array.set([...this.#last, ...point], 6 * this.#count);
      this.#last = point;
      this.#count += 1;
    }
    if (this.#count === first) return;
    this.#buffer.addUpdateRange(6 * first, 6 * (this.#count - first));
    this.#buffer.needsUpdate = true;
    this.line.geometry.instanceCount = this.#count;
  }
}
