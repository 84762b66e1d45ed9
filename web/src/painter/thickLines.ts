/** Coloured lines of constant width on the screen, drawn anew with every tick. */

import { type Color, InstancedInterleavedBuffer, InterleavedBufferAttribute } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

/** Ends of a piece with the colour of each: x, y, z, x, y, z, and red, green, blue twice. */
const STRIDE = 12;

export class ThickLines {
  readonly line: LineSegments2;
  readonly #buffer: InstancedInterleavedBuffer;
  readonly #capacity: number;
  #count = 0;

  constructor(capacity: number, width_px: number, opacity = 1) {
    this.#capacity = capacity;
    this.#buffer = new InstancedInterleavedBuffer(new Float32Array(STRIDE * capacity), STRIDE, 1);
    const geometry = new LineSegmentsGeometry();
    ['instanceStart', 'instanceEnd', 'instanceColorStart', 'instanceColorEnd'].forEach((name, index) => {
      geometry.setAttribute(name, new InterleavedBufferAttribute(this.#buffer, 3, 3 * index));
    });
    geometry.instanceCount = 0;
    const material = new LineMaterial({ linewidth: width_px, vertexColors: true, transparent: true, opacity });
    this.line = new LineSegments2(geometry, material);
    this.line.frustumCulled = false;
  }

  clear(): void {
    this.#count = 0;
  }

  /** Adds a line through points given as x, y, z after each other; what is beyond the capacity is left out. */
  add(points: readonly number[], colour: Color): void {
    const { r, g, b } = colour;
    for (let at = 0; at + 5 < points.length && this.#count < this.#capacity; at += 3) {
      this.#buffer.array.set([...points.slice(at, at + 6), r, g, b, r, g, b], STRIDE * this.#count);
      this.#count += 1;
    }
  }

  /** Shows what was added since the lines were cleared. */
  done(): void {
    this.line.geometry.instanceCount = this.#count;
    this.#buffer.clearUpdateRanges();
    this.#buffer.addUpdateRange(0, STRIDE * this.#count);
    this.#buffer.needsUpdate = true;
  }
}
