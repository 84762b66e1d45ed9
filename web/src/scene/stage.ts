/** The 3D view: owns the renderer and shows what frames say. Draws only when something changed. */

import { AmbientLight, DirectionalLight, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import { type Frame, type Place, type Pose, type SessionInfo, TICK_RATE_HZ } from '../core/protocol.ts';
import { wrap } from '../ui/format.ts';
import type { Colouring } from '../ui/groundKey.ts';
import type { Theme } from '../ui/theme.ts';
import { Glide } from './glide.ts';
import type { HeightField, Vector } from './heightfield.ts';
import { Husky } from './husky.ts';
import { Pacer } from './pacer.ts';
import { Places } from './places.ts';
import { Relief } from './relief.ts';
import { Returns } from './returns.ts';
import { Route } from './route.ts';
import { Subgoals } from './subgoals.ts';
import { SUN } from './sunlight.ts';
import { Viewpoint } from './viewpoint.ts';

/** Triangles of finer grids cost more than they show; a processor draws far fewer of them than a graphics card. */
const GRID_VERTICES = { hardware: 512, software: 160 };
/** The first look passes the robot's right side by this much, to show both it and the way ahead. */
const FIRST_LOOK_RAD = 0.35;
/** At slow motion the robot still glides no longer than this from tick to tick. */
const LONGEST_GLIDE_MS = 250;

export class Stage {
  readonly #canvas: HTMLCanvasElement;
  readonly #pacer = new Pacer();
  readonly #renderer: WebGLRenderer;
  readonly #viewpoint: Viewpoint;
  readonly #scene = new Scene();
  readonly #returns = new Returns();
  readonly #route = new Route();
  readonly #subgoals = new Subgoals();
  readonly #places = new Places();
  readonly #glide = new Glide();
  readonly #sensor = new Vector3();
  #husky: Husky | undefined;
  #relief: Relief | undefined;
  #theme: Theme;
  #info: SessionInfo | undefined;
  #shown: Pose | undefined;
  #speed = 1;
  #dirty = true;
  #colouring: Colouring = 'elevation';

  constructor(canvas: HTMLCanvasElement, theme: Theme) {
    this.#canvas = canvas;
    this.#theme = theme;
    this.#renderer = new WebGLRenderer({ canvas, antialias: !this.#pacer.software, alpha: true });
    this.#viewpoint = new Viewpoint(canvas, () => this.invalidate());
    const sun = new DirectionalLight(0xfff3df, 3.2);
    sun.position.set(...SUN);
    this.#scene.add(new AmbientLight(0xd5e0f2, 2.1), sun);
    this.#scene.add(this.#route.line, this.#returns.points, this.#subgoals.group, this.#places.group);
    this.theme(theme);
    new ResizeObserver(() => this.#resize()).observe(canvas);
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
    return this.#viewpoint.following;
  }

  get viewHeading_rad(): number {
    return this.#viewpoint.heading_rad;
  }

  invalidate(): void {
    this.#dirty = true;
  }

  theme(theme: Theme): void {
    this.#theme = theme;
    for (const part of [this.#relief, this.#returns, this.#route, this.#subgoals, this.#places]) part?.theme(theme);
    this.invalidate();
  }

  session(info: SessionInfo, field: HeightField | undefined): void {
    this.#info = info;
    if (field) this.#replaceGround(field);
    if (!this.#husky) {
      this.#husky = new Husky(info.sensor_height_m);
      this.#scene.add(this.#husky.group);
    }
    this.#relief?.colouring(this.#colouring, info.limits);
    const { start, goal } = info;
    this.#places.show(goal, start, this.#height);
    if (field) {
      const towards = Math.atan2(goal.y - start.y, goal.x - start.x);
      this.#viewpoint.follow({ ...start, z: this.#height(start.x, start.y) }, towards - FIRST_LOOK_RAD);
    }
    this.invalidate();
  }

  frame(frame: Frame): void {
    const { pose, tick, buffers, returns } = frame;
    if (tick === 0) {
      this.#route.clear();
      this.#glide.reset();
    }
    this.#route.extend(frame.path);
    this.#glide.to(pose, performance.now(), Math.min(1000 / (TICK_RATE_HZ * this.#speed), LONGEST_GLIDE_MS));
    this.#returns.show(buffers.points, returns, this.#sensorAt(pose), this.#info?.occupancy_radius_m ?? 0);
    this.#subgoals.show(frame.subgoals, this.#height);
    this.invalidate();
  }

  /** The field's heights have changed. */
  sculpted(): void {
    this.#relief?.sculpted();
    this.#places.settle(this.#height);
    this.invalidate();
  }

  /** By what the ground is coloured. */
  colouring(colouring: Colouring): void {
    this.#colouring = colouring;
    if (this.#info) this.#relief?.colouring(colouring, this.#info.limits);
    this.invalidate();
  }

  /** How fast simulated time runs, so that the robot glides from tick to tick. */
  speed(speed: number): void {
    this.#speed = speed;
  }

  toggleFollow(): void {
    if (this.following) this.#viewpoint.release();
    else if (this.#shown) this.#viewpoint.follow(this.#shown);
    this.invalidate();
  }

  overview(): void {
    if (this.field) this.#viewpoint.overview(this.field);
    this.invalidate();
  }

  toolInHand(inHand: boolean): void {
    this.#viewpoint.toolInHand(inHand);
  }

  nudge(turn_rad: number, tilt_rad: number, zoom: number): void {
    this.#viewpoint.nudge(turn_rad, tilt_rad, zoom);
    this.invalidate();
  }

  /** The brush's ring, drawn out along the line from `from`; a radius of zero hides it. */
  brush(at: Place, from: Place, radius_m: number): void {
    this.#relief?.brush(at, from, radius_m);
    this.invalidate();
  }

  /** The point of the ground under a place of the window. */
  pick(clientX: number, clientY: number): Vector | undefined {
    const box = this.#canvas.getBoundingClientRect();
    const at = new Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2);
    const caster = new Raycaster();
    caster.setFromCamera(at, this.#viewpoint.camera);
    return this.field?.intersect(caster.ray.origin, caster.ray.direction);
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

  #replaceGround(field: HeightField): void {
    if (this.#relief) {
      this.#scene.remove(this.#relief.mesh);
      this.#relief.dispose();
    }
    const vertices = this.#pacer.software ? GRID_VERTICES.software : GRID_VERTICES.hardware;
    this.#relief = new Relief(field, vertices, this.#theme, () => this.invalidate());
    this.#scene.add(this.#relief.mesh);
    this.#shown = undefined;
    this.#glide.reset();
  }

  #resize(): void {
    const { clientWidth, clientHeight } = this.#canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.#renderer.setPixelRatio(this.#pacer.pixelRatio);
    this.#renderer.setSize(clientWidth, clientHeight, false);
    this.#viewpoint.resize(clientWidth / clientHeight);
    this.#returns.scale((clientHeight * this.#pacer.pixelRatio) / this.#viewpoint.heightAtOneMetre);
    this.invalidate();
  }

  #loop(now_ms: number): void {
    requestAnimationFrame((next_ms) => this.#loop(next_ms));
    this.#viewpoint.update();
    this.#moveRobot();
    if (!this.#pacer.due(now_ms) || !this.#dirty) return;
    this.#dirty = false;
    const { camera } = this.#viewpoint;
    if (this.field) this.#viewpoint.clear(this.field);
    this.#subgoals.attach(this.#sensor, camera.position);
    this.#places.face(camera.position);
    this.#renderer.render(this.#scene, camera);
    if (this.#pacer.drew(now_ms)) this.#resize();
  }

  #moveRobot(): void {
    const pose = this.#glide.at(performance.now());
    const before = this.#shown;
    if (!pose || pose === before) return;
    this.#shown = pose;
    this.#husky?.pose(pose);
    if (before) {
      const [east, north] = [pose.x - before.x, pose.y - before.y];
      this.#husky?.roll(east * Math.cos(pose.yaw) + north * Math.sin(pose.yaw), wrap(pose.yaw - before.yaw));
    }
    this.#viewpoint.track(pose);
    this.#sensorAt(pose);
    this.#relief?.robot(pose.x, pose.y, pose.yaw, this.#info?.occupancy_radius_m ?? 0);
    this.invalidate();
  }
}
