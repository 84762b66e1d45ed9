/** The ground as a solid relief: a grid displaced by a height texture, with cut sides, contour lines and rings. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  FloatType,
  LinearFilter,
  Mesh,
  RedFormat,
  ShaderMaterial,
  Vector2,
  Vector3,
  Vector4,
} from 'three';
import type { Rgb } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Place } from '../experiment/place.ts';
import { HeightField } from '../ground/heightField.ts';
import type { Solid } from '../protocol/simulationProtocol.ts';
import { COLOURINGS, type Colouring, STEEPEST_SHOWN_RAD } from '../scene/layers.ts';
import { FRAGMENT, VERTEX } from './reliefShader.ts';
import { SUN, sunlight } from './sunlight.ts';

/** Shadows follow a stroke of the brush after this pause. */
const RELIGHT_DELAY_MS = 120;
/** Half a Husky's length: slopes are taken over what it stands on. */
const FOOTPRINT_M = 0.4;

/** There is a ground before one is loaded. */
const LEVEL = { columns: 2, rows: 2, cell_m: 1, heights_m: new Float32Array(4) };

export class Relief {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  readonly #verticesPerSide: number;
  readonly #changed: () => void;
  #field: HeightField;
  #solids: readonly Solid[] = [];
  #heights = new DataTexture();
  #light = new DataTexture();
  #brightness = new Uint8Array();
  #relightTimer: ReturnType<typeof setTimeout> | undefined;

  /** A grid of at most `verticesPerSide` squared, level at first; `changed` is called when the picture changes by itself. */
  constructor(verticesPerSide: number, theme: Theme, changed: () => void) {
    this.#verticesPerSide = verticesPerSide;
    this.#changed = changed;
    this.mesh = new Mesh(
      new BufferGeometry(),
      new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        side: DoubleSide,
        uniforms: {
          heights: { value: null },
          light: { value: null },
          cell: { value: 1 },
          size: { value: new Vector2() },
          base: { value: 0 },
          reach: { value: 1 },
          colouring: { value: 0 },
          steepest: { value: STEEPEST_SHOWN_RAD },
          limits: { value: new Vector2() },
          slopeColours: { value: [] },
          standColours: { value: [] },
          range: { value: new Vector2() },
          sun: { value: new Vector3(...SUN) },
          relief: { value: [] },
          rock: { value: new Color() },
          contour: { value: new Vector4() },
          robot: { value: new Vector4(0, 0, 0, 0) },
          ringRadius: { value: 0 },
          ringColour: { value: new Color() },
          brush: { value: new Vector4(0, 0, 0, 0) },
          brushRadius: { value: 0 },
          brushColour: { value: new Color() },
        },
      }),
    );
    // Heights live in a texture: three cannot know the true bounds.
    this.mesh.frustumCulled = false;
    this.#field = new HeightField(LEVEL);
    this.ground(this.#field);
    this.theme(theme);
  }

  get field(): HeightField {
    return this.#field;
  }

  /** Another ground. The material stays: compiling its shaders takes longer than all else here. */
  ground(field: HeightField): void {
    clearTimeout(this.#relightTimer);
    this.#relightTimer = undefined;
    for (const old of [this.mesh.geometry, this.#heights, this.#light]) old.dispose();
    const { columns, rows, cell_m } = field;
    this.#field = field;
    this.mesh.geometry = geometry(field, this.#verticesPerSide);
    this.#heights = new DataTexture(field.heights_m, columns, rows, RedFormat, FloatType);
    this.#heights.needsUpdate = true;
    this.#brightness = new Uint8Array(columns * rows);
    this.#light = new DataTexture(this.#brightness, columns, rows, RedFormat);
    this.#light.unpackAlignment = 1;
    this.#light.minFilter = LinearFilter;
    this.#light.magFilter = LinearFilter;
    this.#relight();
    this.#set('heights', this.#heights);
    this.#set('light', this.#light);
    this.#set('cell', cell_m);
    this.#set('size', new Vector2(columns, rows));
    this.#set('reach', Math.max(1, Math.round(FOOTPRINT_M / cell_m)));
    this.#fitRange();
  }

  /** Heights for marks to stand on, where no ground is known: none is drawn. */
  surroundings(field: HeightField): void {
    this.#field = field;
    this.mesh.visible = false;
  }

  theme(theme: Theme): void {
    this.#set('relief', theme.relief.map(colour));
    this.#set('slopeColours', theme.slope.map(colour));
    this.#set('standColours', theme.stand.map(colour));
    this.#set('rock', colour(theme.rock));
    const line = colour(theme.contour);
    this.#set('contour', new Vector4(line.r, line.g, line.b, theme.dark ? 0.34 : 0.3));
    this.#set('ringColour', colour(theme.ink));
    this.#set('brushColour', colour(theme.accent));
  }

  /** Shows the field's new heights. */
  sculpted(): void {
    this.#heights.needsUpdate = true;
    this.#fitRange();
    this.#relightSoon();
  }

  /** What stands on the ground and casts a shadow. */
  solids(solids: readonly Solid[]): void {
    if (JSON.stringify(solids) === JSON.stringify(this.#solids)) return;
    this.#solids = solids;
    this.#relightSoon();
  }

  #relightSoon(): void {
    clearTimeout(this.#relightTimer);
    this.#relightTimer = setTimeout(() => {
      this.#relightTimer = undefined;
      this.#relight();
      this.#changed();
    }, RELIGHT_DELAY_MS);
  }

  /** Whether shadows have still to follow a stroke. */
  get relighting(): boolean {
    return this.#relightTimer !== undefined;
  }

  /** By what to colour, with the tilt that the robot may have. */
  colouring(colouring: Colouring, limits: { readonly roll_rad: number; readonly pitch_rad: number }): void {
    this.#set('colouring', COLOURINGS.indexOf(colouring));
    const { roll_rad, pitch_rad } = limits;
    this.mesh.material.uniforms.limits?.value.set(Math.min(roll_rad, pitch_rad), Math.max(roll_rad, pitch_rad));
  }

  /** Ring of the occupancy radius and soft shadow under the robot. */
  robot(x: number, y: number, yaw: number, ringRadius_m: number): void {
    this.mesh.material.uniforms.robot?.value.set(x, y, Math.cos(yaw), Math.sin(yaw));
    this.#set('ringRadius', ringRadius_m);
  }

  /** The brush's ring, drawn out along a line; a radius of zero hides it. */
  brush(at: Place, from: Place, radius_m: number): void {
    this.mesh.material.uniforms.brush?.value.set(at.x, at.y, from.x, from.y);
    this.#set('brushRadius', radius_m);
  }

  #set(name: string, value: unknown): void {
    const uniform = this.mesh.material.uniforms[name];
    if (uniform) uniform.value = value;
  }

  #relight(): void {
    sunlight(this.field, this.#solids, this.#brightness);
    this.#light.needsUpdate = true;
  }

  #fitRange(): void {
    const { min_m, max_m, width_m } = this.field;
    this.mesh.material.uniforms.range?.value.set(min_m, Math.max(max_m, min_m + 1));
    this.#set('base', min_m - 0.035 * width_m);
  }
}

export function colour([red, green, blue]: Rgb): Color {
  return new Color().setRGB(red / 255, green / 255, blue / 255, 'srgb');
}

/** Grid samples as `place` = (column, row, 0 top | 1 base) and, on the cut sides, the outward `side` normal. */
function geometry({ columns, rows }: HeightField, verticesPerSide: number): BufferGeometry {
  const stride = Math.max(1, Math.ceil(Math.max(columns, rows) / verticesPerSide));
  const xs = samples(columns, stride);
  const ys = samples(rows, stride);
  const place: number[] = [];
  const side: number[] = [];
  const index: number[] = [];
  const vertex = (column: number, row: number, base: number, east: number, north: number) => {
    place.push(column, row, base);
    side.push(east, north);
    return place.length / 3 - 1;
  };
  for (const row of ys) for (const column of xs) vertex(column, row, 0, 0, 0);
  for (let j = 0; j + 1 < ys.length; j += 1) {
    for (let i = 0; i + 1 < xs.length; i += 1) {
      const a = j * xs.length + i;
      const d = a + xs.length;
      index.push(a, a + 1, d + 1, a, d + 1, d);
    }
  }
  const wall = (line: readonly (readonly [number, number])[], east: number, north: number) => {
    let last: [number, number] | undefined;
    for (const [column, row] of line) {
      const pair: [number, number] = [vertex(column, row, 0, east, north), vertex(column, row, 1, east, north)];
      if (last) index.push(last[0], last[1], pair[1], last[0], pair[1], pair[0]);
      last = pair;
    }
  };
  wall(
    xs.map((column) => [column, 0] as const),
    0,
    -1,
  );
  wall(
    xs.map((column) => [column, rows - 1] as const),
    0,
    1,
  );
  wall(
    ys.map((row) => [0, row] as const),
    -1,
    0,
  );
  wall(
    ys.map((row) => [columns - 1, row] as const),
    1,
    0,
  );
  const result = new BufferGeometry();
  result.setAttribute('position', new BufferAttribute(new Float32Array(place), 3));
  result.setAttribute('side', new BufferAttribute(new Float32Array(side), 2));
  result.setIndex(new BufferAttribute(new Uint32Array(index), 1));
  return result;
}

/** Every `stride`-th sample, and always the last. */
function samples(count: number, stride: number): number[] {
  const all = Array.from({ length: Math.ceil(count / stride) }, (_, step) => step * stride);
  if (all.at(-1) !== count - 1) all.push(count - 1);
  return all;
}
