/** Returns that the planner sets aside, larger than the others and each kind in its colour and form. */

import { BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Points, ShaderMaterial } from 'three';
import type { Theme } from '../colours/theme.ts';
import { RETURN_KINDS, type SetAsideKind } from '../protocol/simulationProtocol.ts';
import { colour } from './relief.ts';

const CODE = (kind: SetAsideKind) => RETURN_KINDS.indexOf(kind).toFixed(1);

const VERTEX = /* glsl */ `
attribute float kind;
uniform float scale;
uniform float pixel;
flat varying float form;
void main() {
  form = kind;
  vec4 view = viewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * view;
  gl_PointSize = clamp(scale * 0.12 / -view.z, 6.0 * pixel, 16.0 * pixel);
}
`;

const FRAGMENT = /* glsl */ `
uniform vec3 strayColour;
uniform vec3 bodyColour;
uniform vec3 overheadColour;
uniform vec3 edgeColour;
flat varying float form;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  // How far from the line of the form: a cross, a square, a triangle.
  float away;
  vec3 ink;
  if (form == STRAY) {
    away = max(min(abs(at.x - at.y), abs(at.x + at.y)) * 0.7, max(abs(at.x), abs(at.y)) - 0.75);
    ink = strayColour;
  } else if (form == BODY) {
    away = abs(max(abs(at.x), abs(at.y)) - 0.6);
    ink = bodyColour;
  } else {
    away = abs(max(abs(at.x) * 0.87 - at.y * 0.5, at.y) - 0.42);
    ink = overheadColour;
  }
  if (away > 0.38) discard;
  gl_FragColor = linearToOutputTexel(vec4(mix(ink, edgeColour, smoothstep(0.2, 0.27, away)), 1.0));
}
`;

export class SetAsideReturns {
  readonly points: Points<BufferGeometry, ShaderMaterial>;
  readonly #positions: BufferAttribute;
  readonly #kinds: BufferAttribute;
  #shown = 0;

  constructor(capacity: number) {
    this.#positions = new BufferAttribute(new Float32Array(3 * capacity), 3).setUsage(DynamicDrawUsage);
    this.#kinds = new BufferAttribute(new Uint8Array(capacity), 1).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry().setAttribute('position', this.#positions).setAttribute('kind', this.#kinds);
    // One point before there are any: its shader compiles with the others.
    geometry.setDrawRange(0, 1);
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      defines: { STRAY: CODE('stray'), BODY: CODE('body') },
      uniforms: {
        scale: { value: 900 },
        pixel: { value: 1 },
        strayColour: { value: new Color() },
        bodyColour: { value: new Color() },
        overheadColour: { value: new Color() },
        edgeColour: { value: new Color() },
      },
    });
    this.points = new Points(geometry, material);
    this.points.frustumCulled = false;
  }

  theme(theme: Theme): void {
    const { strayColour, bodyColour, overheadColour, edgeColour } = this.points.material.uniforms;
    strayColour?.value.copy(colour(theme.returnStray));
    bodyColour?.value.copy(colour(theme.returnBody));
    overheadColour?.value.copy(colour(theme.returnOverhead));
    edgeColour?.value.copy(colour(theme.surface));
  }

  /** Device pixels that one metre has, one metre away, and that one pixel of the page has. */
  scale(pixels: number, pixelRatio: number): void {
    const { scale, pixel } = this.points.material.uniforms;
    if (scale) scale.value = pixels;
    if (pixel) pixel.value = pixelRatio;
  }

  clear(): void {
    this.#shown = 0;
  }

  add(x: number, y: number, z: number, kind: number): void {
    this.#positions.setXYZ(this.#shown, x, y, z);
    this.#kinds.setX(this.#shown, kind);
    this.#shown += 1;
  }

  /** Draws what was added since it was cleared. */
  show(): void {
    for (const attribute of [this.#positions, this.#kinds]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, attribute.itemSize * this.#shown);
      attribute.needsUpdate = this.#shown > 0;
    }
    this.points.geometry.setDrawRange(0, this.#shown);
  }
}
