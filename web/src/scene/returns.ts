/** LiDAR returns. Those inside the occupancy radius, the only ones that the planner uses, are bright. */

import { BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Points, ShaderMaterial, Vector3 } from 'three';
import type { Theme } from '../ui/theme.ts';
import { colour } from './relief.ts';

const CAPACITY = 28_800;

const VERTEX = /* glsl */ `
uniform vec3 sensor;
uniform float radius;
uniform float scale;
varying float near;
void main() {
  near = 1.0 - smoothstep(radius - 0.02, radius + 0.02, distance(position, sensor));
  vec4 view = viewMatrix * vec4(position + vec3(0.0, 0.0, 0.02), 1.0);
  gl_Position = projectionMatrix * view;
  gl_PointSize = clamp(scale * mix(0.055, 0.07, near) / -view.z, 1.3, 8.0);
}
`;

const FRAGMENT = /* glsl */ `
uniform vec3 nearColour;
uniform vec3 farColour;
varying float near;
void main() {
  float from = length(gl_PointCoord - 0.5);
  float cover = 1.0 - smoothstep(0.36, 0.5, from);
  float opacity = cover * mix(0.42, 0.95, near);
  if (opacity < 0.02) discard;
  gl_FragColor = linearToOutputTexel(vec4(mix(farColour, nearColour, near), opacity));
}
`;

export class Returns {
  readonly points: Points<BufferGeometry, ShaderMaterial>;
  readonly #positions: BufferAttribute;

  constructor() {
    this.#positions = new BufferAttribute(new Float32Array(3 * CAPACITY), 3).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry().setAttribute('position', this.#positions);
    geometry.setDrawRange(0, 0);
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
      uniforms: {
        sensor: { value: new Vector3() },
        radius: { value: 7 },
        scale: { value: 900 },
        nearColour: { value: new Color() },
        farColour: { value: new Color() },
      },
    });
    this.points = new Points(geometry, material);
    this.points.frustumCulled = false;
  }

  theme(theme: Theme): void {
    this.points.material.uniforms.nearColour?.value.copy(colour(theme.returnNear));
    this.points.material.uniforms.farColour?.value.copy(colour(theme.returnFar));
  }

  /** Device pixels that one metre has, one metre away: points keep a size in metres. */
  scale(pixels: number): void {
    const { scale } = this.points.material.uniforms;
    if (scale) scale.value = pixels;
  }

  show(xyz: Float32Array, count: number, sensor: Vector3, radius_m: number): void {
    const shown = Math.min(count, CAPACITY);
    this.#positions.array.set(xyz.subarray(0, 3 * shown));
    this.#positions.clearUpdateRanges();
    this.#positions.addUpdateRange(0, 3 * shown);
    this.#positions.needsUpdate = true;
    this.points.geometry.setDrawRange(0, shown);
    const { uniforms } = this.points.material;
    uniforms.sensor?.value.copy(sensor);
    if (uniforms.radius) uniforms.radius.value = radius_m;
  }
}
