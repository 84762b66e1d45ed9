/**
 * The occupancy surfaces as bands of spheres around the sensor, as in the paper's figure: the observed one within, the one
 * that the Gaussian process reconstructs around it, and the variance outermost, just outside the radius where subgoals lie.
 *
 * Most of a band is below the ground in front of it. What the ground hides shines through faintly.
 */

import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  type Color,
  DataTexture,
  FrontSide,
  GreaterDepth,
  Group,
  LessEqualDepth,
  LinearFilter,
  Mesh,
  NearestFilter,
  RedFormat,
  RepeatWrapping,
  ShaderMaterial,
  type Texture,
} from 'three';
import { PLASMA } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Pose } from '../protocol/simulationProtocol.ts';
import { type Layers, SURFACES, type Surface } from '../scene/layers.ts';
import type { Scenery, Seen } from './painterProtocol.ts';
import { colour } from './relief.ts';
import { scaleTexture } from './scaleTexture.ts';

/** Radius of each band as a share of the occupancy surface's: apart, so that all can be seen at once. */
const SHARE: Record<Surface, number> = { observed: 0.5, occupancy: 0.75, variance: 1.03 };
const LOWEST_RAD = (-15.5 * Math.PI) / 180;
const HIGHEST_RAD = (15.5 * Math.PI) / 180;
const AROUND = 120;
const UP = 8;

const VERTEX = /* glsl */ `
varying vec2 direction;
void main() {
  direction = uv;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

/** A texel of zero is a place without a value. Values near \`clear\` are seen through, and \`threshold\` is drawn as a line. */
const FRAGMENT = /* glsl */ `
varying vec2 direction;
uniform sampler2D values;
uniform sampler2D scale;
uniform vec2 size;
uniform float clear;
uniform float opacity;
uniform float threshold;
uniform vec3 lineColour;
void main() {
  vec2 at = vec2((direction.y * (size.y - 1.0) + 0.5) / size.y, direction.x + 0.5 / size.x);
  float texel = texture2D(values, at).r * 255.0;
  if (texel < 0.5) discard;
  float value = (texel - 1.0) / 254.0;
  float line = threshold > 0.0 ? 1.0 - smoothstep(0.8, 1.8, abs(value - threshold) / max(fwidth(value), 1e-4)) : 0.0;
  float solid = mix(0.2, 1.0, smoothstep(0.0, 0.25, abs(value - clear)));
  vec3 colour = mix(texture2D(scale, vec2(value, 0.5)).rgb, lineColour, line);
  gl_FragColor = linearToOutputTexel(vec4(colour, opacity * max(solid, line)));
}
`;

interface Band {
  readonly group: Group;
  readonly bytes: Uint8Array<ArrayBuffer>;
  readonly texture: DataTexture;
  readonly uniforms: ShaderMaterial['uniforms'];
}

export class Bands {
  readonly group = new Group();
  /** At the sensor, within the robot's frame. */
  readonly #sensor = new Group();
  readonly #geometry = bandGeometry();
  readonly #occupancyScale = scaleTexture([...PLASMA].reverse());
  #varianceScale: Texture;
  #lineColour: Color;
  #bands: Record<Surface, Band> | undefined;
  #lattice = '';
  #radius_m = 0;
  #layers: Layers | undefined;

  constructor(theme: Theme) {
    this.#varianceScale = scaleTexture(theme.variance);
    this.#lineColour = colour(theme.goal);
    this.group.rotation.order = 'ZYX';
    this.group.add(this.#sensor);
  }

  theme(theme: Theme): void {
    this.#varianceScale.dispose();
    this.#varianceScale = scaleTexture(theme.variance);
    this.#lineColour = colour(theme.goal);
    const uniforms = this.#bands?.variance.uniforms;
    if (uniforms?.scale) uniforms.scale.value = this.#varianceScale;
    if (uniforms?.lineColour) uniforms.lineColour.value = this.#lineColour;
  }

  session({ image, occupancy_radius_m, mount }: Scenery): void {
    this.#radius_m = occupancy_radius_m;
    this.#sensor.position.set(mount.forward_m, mount.left_m, mount.height_m);
    this.#sensor.scale.setScalar(occupancy_radius_m);
    const lattice = `${image.columns} ${image.rows} ${image.rings}`;
    if (lattice === this.#lattice) return;
    this.#lattice = lattice;
    this.#sensor.clear();
    for (const band of Object.values(this.#bands ?? {})) band.texture.dispose();
    this.#bands = {
      observed: this.#newBand('observed', image.columns, image.rings, this.#occupancyScale, -1),
      occupancy: this.#newBand('occupancy', image.columns, image.rows, this.#occupancyScale, 0),
      variance: this.#newBand('variance', image.columns, image.rows, this.#varianceScale, 1),
    };
    if (this.#layers) this.layers(this.#layers);
  }

  layers(layers: Layers): void {
    this.#layers = layers;
    for (const surface of SURFACES) {
      const group = this.#bands?.[surface].group;
      if (group) group.visible = layers[surface];
    }
  }

  /** The robot has moved to here. */
  pose({ x, y, z, roll, pitch, yaw }: Pose): void {
    this.group.position.set(x, y, z);
    // Positive pitch lifts the nose, which is a negative turn about the left-pointing y axis.
    this.group.rotation.set(roll, -pitch, yaw);
  }

  show({ surfaces, buffers, threshold }: Seen): void {
    if (!surfaces || !this.#bands) return;
    const { observed, occupancy, variance } = this.#bands;
    quantise(buffers.observed, this.#radius_m, observed);
    quantise(buffers.occupancy, this.#radius_m, occupancy);
    quantise(buffers.variance, 1, variance);
    if (variance.uniforms.threshold) variance.uniforms.threshold.value = threshold;
  }

  #newBand(surface: Surface, columns: number, rows: number, scale: Texture, clear: number): Band {
    const bytes = new Uint8Array(columns * rows);
    // Azimuth-major, as the values come: a line of the texture is a column of the surface.
    const texture = new DataTexture(bytes, rows, columns, RedFormat);
    texture.unpackAlignment = 1;
    texture.wrapT = RepeatWrapping;
    const filter = surface === 'observed' ? NearestFilter : LinearFilter;
    texture.minFilter = filter;
    texture.magFilter = filter;
    const shared = {
      values: { value: texture },
      scale: { value: scale },
      size: { value: [columns, rows] },
      clear: { value: clear },
      threshold: { value: 0 },
      lineColour: { value: this.#lineColour },
    };
    const group = new Group();
    const layer = 1 + SURFACES.indexOf(surface);
    for (const hidden of [false, true]) {
      for (const side of [BackSide, FrontSide]) {
        const near = side === FrontSide;
        const material = new ShaderMaterial({
          vertexShader: VERTEX,
          fragmentShader: FRAGMENT,
          side,
          transparent: true,
          depthWrite: false,
          depthFunc: hidden ? GreaterDepth : LessEqualDepth,
          uniforms: { ...shared, opacity: { value: (near ? 0.5 : 0.92) * (hidden ? 0.4 : 1) } },
        });
        const mesh = new Mesh(this.#geometry, material);
        mesh.scale.setScalar(SHARE[surface]);
        // From the far side of the outermost band to the near side of it.
        mesh.renderOrder = near ? layer : -layer;
        mesh.frustumCulled = false;
        group.add(mesh);
      }
    }
    this.#sensor.add(group);
    return { group, bytes, texture, uniforms: shared };
  }
}

/** Values from 0 to `full` as bytes from 1 to 255; 0 where there is none. */
function quantise(values: Float32Array, full: number, { bytes, texture }: Band): void {
  for (let index = 0; index < bytes.length; index += 1) {
    const share = (values[index] ?? Number.NaN) / full;
    bytes[index] = Number.isNaN(share) ? 0 : 1.5 + 254 * Math.min(Math.max(share, 0), 1);
  }
  texture.needsUpdate = true;
}

/** A band of the unit sphere with x ahead and y to the left; `uv` is azimuth from straight behind and elevation, 0 to 1. */
function bandGeometry(): BufferGeometry {
  const place: number[] = [];
  const uv: number[] = [];
  const index: number[] = [];
  for (let i = 0; i <= AROUND; i += 1) {
    for (let j = 0; j <= UP; j += 1) {
      const azimuth = -Math.PI + (2 * Math.PI * i) / AROUND;
      const elevation = LOWEST_RAD + ((HIGHEST_RAD - LOWEST_RAD) * j) / UP;
      const flat = Math.cos(elevation);
      place.push(flat * Math.cos(azimuth), flat * Math.sin(azimuth), Math.sin(elevation));
      const lattice = (elevation + Math.PI / 12) / (Math.PI / 6);
      uv.push(i / AROUND, lattice);
      if (i === AROUND || j === UP) continue;
      const at = i * (UP + 1) + j;
      index.push(at, at + UP + 1, at + UP + 2, at, at + UP + 2, at + 1);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(place), 3));
  geometry.setAttribute('uv', new BufferAttribute(new Float32Array(uv), 2));
  geometry.setIndex(index);
  return geometry;
}
