/** The 3D view: owns the renderer and the camera and shows what frames say. Draws only when something changed. */

import {
  AmbientLight,
  DirectionalLight,
  MathUtils,
  MOUSE,
  PerspectiveCamera,
  Raycaster,
  Scene,
  SRGBColorSpace,
  TOUCH,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { type Frame, type Pose, type SessionInfo, TICK_RATE_HZ } from '../core/protocol.ts';
import { wrap } from '../ui/format.ts';
import type { Theme } from '../ui/theme.ts';
import type { HeightField, Vector } from './heightfield.ts';
import { Husky } from './husky.ts';
import { Pacer } from './pacer.ts';
import { Places } from './places.ts';
import { Relief } from './relief.ts';
import { Returns } from './returns.ts';
import { Route } from './route.ts';
import { Subgoals } from './subgoals.ts';
import { SUN } from './sunlight.ts';

const FIELD_OF_VIEW_DEG = 42;
/** Triangles of finer grids cost more than they show; a processor draws far fewer of them than a graphics card. */
const GRID_VERTICES = { hardware: 512, software: 160 };
const FOLLOW_DISTANCE_M = 14.5;
const FOLLOW_ELEVATION_RAD = 0.45;

export class Stage {
  readonly #canvas: HTMLCanvasElement;
  readonly #pacer = new Pacer();
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 0.1, 1500);
  readonly #controls: OrbitControls;
  readonly #returns = new Returns();
  readonly #route = new Route();
  readonly #subgoals = new Subgoals();
  readonly #places = new Places();
  readonly #raycaster = new Raycaster();
  readonly #sensor = new Vector3();
  #husky: Husky | undefined;
  #relief: Relief | undefined;
  #theme: Theme;
  #info: SessionInfo | undefined;
  #from: Pose | undefined;
  #to: Pose | undefined;
  #shown: Pose | undefined;
  #frameAt_ms = 0;
  #frameSpan_ms = 100;
  #speed = 1;
  #follow = true;
  #dragging = false;
  #dirty = true;

  constructor(canvas: HTMLCanvasElement, theme: Theme) {
    this.#canvas = canvas;
    this.#theme = theme;
    this.#renderer = new WebGLRenderer({ canvas, antialias: !this.#pacer.software, alpha: true });
    this.#renderer.outputColorSpace = SRGBColorSpace;
    this.#camera.up.set(0, 0, 1);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.maxPolarAngle = MathUtils.degToRad(86);
    this.#controls.minDistance = 3;
    this.#controls.maxDistance = 260;
    this.#controls.enableDamping = !window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.#controls.dampingFactor = 0.12;
    this.#controls.addEventListener('change', () => this.invalidate());
    this.#controls.addEventListener('start', () => {
      this.#dragging = true;
    });
    this.#controls.addEventListener('end', () => {
      this.#dragging = false;
    });
    const sun = new DirectionalLight(0xfff3df, 3.2);
    sun.position.set(...SUN);
    this.#scene.add(new AmbientLight(0xd5e0f2, 2.1), sun);
    this.#scene.add(this.#route.line, this.#returns.points, this.#subgoals.group, this.#places.group);
    this.theme(theme);
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
    canvas.addEventListener('webglcontextrestored', () => this.invalidate());
    requestAnimationFrame((now_ms) => this.#loop(now_ms));
  }

  get field(): HeightField | undefined {
    return this.#relief?.field;
  }

  /** The robot as it is drawn now, between two ticks. */
  get robot(): Pose | undefined {
    return this.#shown;
  }

  get following(): boolean {
    return this.#follow;
  }

  invalidate(): void {
    this.#dirty = true;
  }

  theme(theme: Theme): void {
    this.#theme = theme;
    this.#relief?.theme(theme);
    this.#returns.theme(theme);
    this.#route.theme(theme);
    this.#subgoals.theme(theme);
    this.#places.theme(theme);
    this.invalidate();
  }

  session(info: SessionInfo, field: HeightField | undefined): void {
    this.#info = info;
    if (field) {
      if (this.#relief) {
        this.#scene.remove(this.#relief.mesh);
        this.#relief.dispose();
      }
      const vertices = this.#pacer.software ? GRID_VERTICES.software : GRID_VERTICES.hardware;
      this.#relief = new Relief(field, vertices, this.#theme, () => this.invalidate());
      this.#scene.add(this.#relief.mesh);
    }
    if (!this.#husky) {
      this.#husky = new Husky(info.sensor_height_m);
      this.#scene.add(this.#husky.group);
    }
    this.#places.show(info.goal, info.start, this.#height);
    if (field) this.#jumpTo(info);
    this.invalidate();
  }

  frame(frame: Frame): void {
    const { pose, tick, buffers, returns } = frame;
    if (tick === 0) this.#route.clear();
    this.#route.extend(frame.path);
    // Where drawing is slower than ticking, the robot has glided on since it was last drawn.
    this.#glide();
    const jump = !this.#to || tick === 0 || Math.hypot(pose.x - this.#to.x, pose.y - this.#to.y) > 3;
    this.#from = jump ? pose : (this.#shown ?? pose);
    this.#to = pose;
    this.#frameAt_ms = performance.now();
    this.#frameSpan_ms = Math.min(1000 / (TICK_RATE_HZ * this.#speed), 250);
    const sensor = this.#sensorAt(pose);
    const radius_m = this.#info?.occupancy_radius_m ?? 0;
    this.#returns.show(buffers.points, returns, sensor, radius_m);
    this.#subgoals.show(frame.subgoals, this.#height);
    this.invalidate();
  }

  sculpted(): void {
    this.#relief?.sculpted();
    this.#places.settle(this.#height);
    this.invalidate();
  }

  /** How fast simulated time runs, so that the robot glides from tick to tick. */
  speed(speed: number): void {
    this.#speed = speed;
  }

  follow(follow: boolean): void {
    this.#follow = follow;
    if (follow && this.#shown) this.#aim(this.#shown.x, this.#shown.y, this.#shown.z, FOLLOW_DISTANCE_M);
    this.invalidate();
  }

  /** The whole ground from the south, from above. */
  overview(): void {
    this.#follow = false;
    const field = this.field;
    if (!field) return;
    const middle = { x: field.width_m / 2, y: field.depth_m / 2 };
    const away_m =
      (0.55 * Math.max(field.width_m / Math.min(this.#camera.aspect, 1.5), field.depth_m)) /
      Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2));
    this.#controls.target.set(middle.x, middle.y, field.min_m);
    this.#camera.position.set(middle.x, middle.y - 0.66 * away_m, field.min_m + 0.75 * away_m);
    this.#controls.update();
    this.invalidate();
  }

  /** With a tool in hand the main button and one finger belong to the tool; two fingers and the other button still move the view. */
  toolInHand(inHand: boolean): void {
    this.#controls.mouseButtons = {
      LEFT: inHand ? null : MOUSE.ROTATE,
      MIDDLE: MOUSE.DOLLY,
      RIGHT: inHand ? MOUSE.ROTATE : MOUSE.PAN,
    };
    this.#controls.touches = { ONE: inHand ? null : TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
  }

  /** Turns, tilts or zooms by keyboard. */
  nudge(turn_rad: number, tilt_rad: number, zoom: number): void {
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const distance_m = MathUtils.clamp(offset.length() * zoom, this.#controls.minDistance, this.#controls.maxDistance);
    const azimuth = Math.atan2(offset.y, offset.x) + turn_rad;
    const elevation = MathUtils.clamp(Math.asin(offset.z / offset.length()) + tilt_rad, 0.08, 1.54);
    this.#camera.position.set(
      this.#controls.target.x + distance_m * Math.cos(elevation) * Math.cos(azimuth),
      this.#controls.target.y + distance_m * Math.cos(elevation) * Math.sin(azimuth),
      this.#controls.target.z + distance_m * Math.sin(elevation),
    );
    this.#controls.update();
    this.invalidate();
  }

  brush(x: number, y: number, radius_m: number): void {
    this.#relief?.brush(x, y, radius_m);
    this.invalidate();
  }

  /** The point of the ground under a place of the window. */
  pick(clientX: number, clientY: number): Vector | undefined {
    const box = this.#canvas.getBoundingClientRect();
    const at = new Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2);
    this.#raycaster.setFromCamera(at, this.#camera);
    const { origin, direction } = this.#raycaster.ray;
    return this.field?.intersect(origin, direction);
  }

  /** Direction in which the viewer looks, in the plane. */
  get viewHeading_rad(): number {
    const { target } = this.#controls;
    return Math.atan2(target.y - this.#camera.position.y, target.x - this.#camera.position.x);
  }

  #height = (x: number, y: number): number => this.field?.height(x, y) ?? 0;

  #sensorAt(pose: Pose): Vector3 {
    const height_m = this.#info?.sensor_height_m ?? 0;
    const [sr, cr, sp, cp] = [Math.sin(pose.roll), Math.cos(pose.roll), Math.sin(pose.pitch), Math.cos(pose.pitch)];
    const [sy, cy] = [Math.sin(pose.yaw), Math.cos(pose.yaw)];
    // The body's z axis in the world: nose-up pitch tips it backwards, left-up roll tips it to the right.
    const [forward, left] = [-sp * cr, -sr];
    return this.#sensor.set(
      pose.x + height_m * (forward * cy - left * sy),
      pose.y + height_m * (forward * sy + left * cy),
      pose.z + height_m * cp * cr,
    );
  }

  /** A first look: from behind the robot, towards the goal. */
  #jumpTo(info: SessionInfo): void {
    this.#shown = undefined;
    this.#to = undefined;
    this.#follow = true;
    const { start, goal } = info;
    this.#aim(
      start.x,
      start.y,
      this.#height(start.x, start.y),
      FOLLOW_DISTANCE_M,
      Math.atan2(goal.y - start.y, goal.x - start.x) - 0.35,
    );
  }

  #aim(x: number, y: number, z: number, distance_m: number, heading_rad = this.viewHeading_rad): void {
    this.#controls.target.set(x, y, z + 0.4);
    const flat_m = distance_m * Math.cos(FOLLOW_ELEVATION_RAD);
    this.#camera.position.set(
      x - flat_m * Math.cos(heading_rad),
      y - flat_m * Math.sin(heading_rad),
      z + distance_m * Math.sin(FOLLOW_ELEVATION_RAD),
    );
    this.#controls.update();
  }

  #resize(): void {
    const { clientWidth, clientHeight } = this.#canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.#renderer.setPixelRatio(this.#pacer.pixelRatio);
    this.#renderer.setSize(clientWidth, clientHeight, false);
    this.#camera.aspect = clientWidth / clientHeight;
    this.#camera.updateProjectionMatrix();
    this.#returns.scale((clientHeight * this.#pacer.pixelRatio) / Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2)));
    this.invalidate();
  }

  #loop(now_ms: number): void {
    requestAnimationFrame((next_ms) => this.#loop(next_ms));
    this.#controls.update();
    this.#glide();
    if (!this.#pacer.due(now_ms) || !this.#dirty) return;
    this.#dirty = false;
    this.#keepAbove();
    if (this.#follow && !this.#dragging) this.#keepSight();
    this.#subgoals.attach(this.#sensor, this.#camera.position);
    this.#places.face(this.#camera.position);
    this.#renderer.render(this.#scene, this.#camera);
    if (this.#pacer.drew(now_ms)) this.#resize();
  }

  /** Moves the drawn robot from the last tick's pose to the newest. */
  #glide(): void {
    if (!this.#from || !this.#to) return;
    const t = this.#frameSpan_ms > 0 ? Math.min((performance.now() - this.#frameAt_ms) / this.#frameSpan_ms, 1) : 1;
    const [from, to] = [this.#from, this.#to];
    const mix = (a: number, b: number) => a + (b - a) * t;
    const pose: Pose = {
      x: mix(from.x, to.x),
      y: mix(from.y, to.y),
      z: mix(from.z, to.z),
      roll: mix(from.roll, to.roll),
      pitch: mix(from.pitch, to.pitch),
      yaw: from.yaw + wrap(to.yaw - from.yaw) * t,
    };
    const before = this.#shown;
    this.#shown = pose;
    if (before && before.x === pose.x && before.y === pose.y && before.yaw === pose.yaw) return;
    this.#husky?.pose(pose);
    if (before) {
      const step = { x: pose.x - before.x, y: pose.y - before.y, z: pose.z - before.z };
      this.#husky?.roll(step.x * Math.cos(pose.yaw) + step.y * Math.sin(pose.yaw), wrap(pose.yaw - before.yaw));
    }
    if (this.#follow) {
      const { target } = this.#controls;
      const shift = new Vector3(pose.x, pose.y, pose.z + 0.4).sub(target);
      target.add(shift);
      this.#camera.position.add(shift);
    }
    this.#sensorAt(pose);
    this.#relief?.robot(pose.x, pose.y, pose.yaw, this.#info?.occupancy_radius_m ?? 0);
    this.invalidate();
  }

  /** Lifts the following camera, a little with each picture, while a hill hides the robot. */
  #keepSight(): void {
    const { position } = this.#camera;
    const { target } = this.#controls;
    const line = target.clone().sub(position);
    const hit = this.field?.intersect(position, line);
    // The target hovers above the robot's feet; what the ray meets beyond it hides nothing.
    if (!hit || Math.hypot(hit.x - position.x, hit.y - position.y) > Math.hypot(line.x, line.y) - 0.6) return;
    this.nudge(0, 0.03, 1);
  }

  /** The camera never dips into a hill. */
  #keepAbove(): void {
    const { position } = this.#camera;
    if (!this.field?.contains(position.x, position.y)) return;
    const floor = this.#height(position.x, position.y) + 0.8;
    if (position.z < floor) position.z = floor;
  }
}
