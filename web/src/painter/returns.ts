/** LiDAR returns, coloured by whether the planner uses them (those inside the occupancy radius), range, height or ring. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  Group,
  Points,
  ShaderMaterial,
  Vector2,
  Vector3,
} from 'three';
import { VIRIDIS } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import { isSetAside } from '../protocol/simulationProtocol.ts';
import { FARTHEST_RANGE_M, POINT_COLOURS, type PointColours } from '../scene/layers.ts';
import type { Seen } from './painterProtocol.ts';
import { colour } from './relief.ts';
import { scaleTexture } from './scaleTexture.ts';
import { SetAsideReturns } from './setAside.ts';

const CAPACITY = 28_800;

const VERTEX = /* glsl */ `
uniform vec3 sensor;
uniform float radius;
uniform float scale;
uniform vec3 up;
uniform vec2 heights;
uniform int mode;
varying float near;
varying float share;
void main() {
  vec3 ray = position - sensor;
  float ring = floor(degrees(asin(dot(normalize(ray), up))) / 2.0 + 8.0);
  share = mode == 1 ? length(ray) / FARTHEST : mode == 2 ? (position.z - heights.x) / (heights.y - heights.x) : ring / 15.0;
  near = 1.0 - smoothstep(radius - 0.02, radius + 0.02, length(ray));
  vec4 view = viewMatrix * vec4(position + vec3(0.0, 0.0, 0.02), 1.0);
  gl_Position = projectionMatrix * view;
  gl_PointSize = clamp(scale * mix(0.055, 0.07, near) / -view.z, 1.3, 8.0);
}
`;

const FRAGMENT = /* glsl */ `
uniform vec3 nearColour;
uniform vec3 farColour;
uniform sampler2D colours;
uniform int mode;
varying float near;
varying float share;
void main() {
  float from = length(gl_PointCoord - 0.5);
  float cover = 1.0 - smoothstep(0.36, 0.5, from);
  float opacity = cover * mix(0.42, 0.95, near);
  if (opacity < 0.02) discard;
  vec3 measured = texture2D(colours, vec2(clamp(share, 0.0, 1.0), 0.5)).rgb * (from > 0.33 ? 0.25 : 1.0);
  gl_FragColor = linearToOutputTexel(vec4(mode == 0 ? mix(farColour, nearColour, near) : measured, opacity));
}
`;

export class Returns {
  readonly group = new Group();
  readonly #points: Points<BufferGeometry, ShaderMaterial>;
  readonly #setAside = new SetAsideReturns(CAPACITY);
  readonly #positions: BufferAttribute;

  constructor() {
    this.#positions = new BufferAttribute(new Float32Array(3 * CAPACITY), 3).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry().setAttribute('position', this.#positions);
    // One point before there are any: its shader compiles with the others.
    geometry.setDrawRange(0, 1);
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      defines: { FARTHEST: FARTHEST_RANGE_M.toFixed(1) },
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
      uniforms: {
        sensor: { value: new Vector3() },
        up: { value: new Vector3() },
        heights: { value: new Vector2(0, 1) },
        mode: { value: 0 },
        colours: { value: null },
        radius: { value: 7 },
        scale: { value: 900 },
        nearColour: { value: new Color() },
        farColour: { value: new Color() },
      },
    });
    this.#points = new Points(geometry, material);
    this.#points.frustumCulled = false;
    // After the others: nothing covers them.
    this.#setAside.points.renderOrder = 1;
    this.group.add(this.#points, this.#setAside.points);
  }

  theme(theme: Theme): void {
    this.#setAside.theme(theme);
    this.#points.material.uniforms.nearColour?.value.copy(colour(theme.returnNear));
    this.#points.material.uniforms.farColour?.value.copy(colour(theme.returnFar));
    const { colours } = this.#points.material.uniforms;
    colours?.value?.dispose();
    // The end that is nearest to the ground's own lightness is left out.
    if (colours) colours.value = scaleTexture(theme.dark ? VIRIDIS.slice(2) : VIRIDIS.slice(0, -1));
  }

  /** Device pixels that one metre has, one metre away: points keep a size in metres. */
  scale(pixels: number, pixelRatio: number): void {
    this.#setAside.scale(pixels, pixelRatio);
    const { scale } = this.#points.material.uniforms;
    if (scale) scale.value = pixels;
  }

  colours(by: PointColours): void {
    this.group.visible = by !== 'none';
    const { mode } = this.#points.material.uniforms;
    if (mode) mode.value = POINT_COLOURS.indexOf(by);
  }

  /** Colours by height run from the lowest to the highest ground. */
  heights(min_m: number, max_m: number): void {
    this.#points.material.uniforms.heights?.value.set(min_m, Math.max(max_m, min_m + 0.1));
  }

  show({ buffers, returns, sensor }: Seen, radius_m: number): void {
    const places = this.#positions.array;
    let shown = 0;
    this.#setAside.clear();
    for (let at = 0; at < Math.min(returns, CAPACITY); at += 1) {
      const x = buffers.points[3 * at] ?? 0;
      const y = buffers.points[3 * at + 1] ?? 0;
      const z = buffers.points[3 * at + 2] ?? 0;
      const kind = buffers.return_kinds[at] ?? 0;
      if (isSetAside(kind)) {
        this.#setAside.add(x, y, z, kind);
      } else {
        places[shown] = x;
        places[shown + 1] = y;
        places[shown + 2] = z;
        shown += 3;
      }
    }
    this.#setAside.show();
    this.#positions.clearUpdateRanges();
    this.#positions.addUpdateRange(0, shown);
    this.#positions.needsUpdate = true;
    this.#points.geometry.setDrawRange(0, shown / 3);
    const { uniforms } = this.#points.material;
    uniforms.sensor?.value.copy(sensor.position);
    uniforms.up?.value.copy(sensor.z_axis);
    if (uniforms.radius) uniforms.radius.value = radius_m;
  }
}
