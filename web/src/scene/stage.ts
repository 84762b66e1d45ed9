/** The 3D view: owns the renderer and shows what frames say. Draws only when something changed. */

import {
  AmbientLight,
  DirectionalLight,
  type Object3D,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import type { Frame, Place, Pose, SessionInfo } from '../core/protocol.ts';
import type { Finder, Target } from '../ui/attention.ts';
import { wrap } from '../ui/format.ts';
import type { Colouring } from '../ui/groundKey.ts';
import type { Theme } from '../ui/theme.ts';
import { Glide } from './glide.ts';
import type { HeightField, Vector } from './heightfield.ts';
import { Husky } from './husky.ts';
import { FIRST_LAYERS, type Layers } from './layers.ts';
import { Overlays } from './overlays.ts';
import { Pacer } from './pacer.ts';
import { Places } from './places.ts';
import { Relief } from './relief.ts';
import { Returns } from './returns.ts';
import { Route } from './route.ts';
import { Subgoals } from './subgoals.ts';
import { SUN } from './sunlight.ts';
import { type CameraMode, Viewpoint } from './viewpoint.ts';
import { Waypoints } from './waypoints.ts';

/** Triangles of finer grids cost more than they show; a processor draws far fewer of them than a graphics card. */
const GRID_VERTICES = { hardware: 512, software: 160 };
/** The first look passes the robot's right side by this much, to show both it and the way ahead. */
const FIRST_LOOK_RAD = 0.35;
/** At slow motion the robot still glides no longer than this from tick to tick. */
const LONGEST_GLIDE_MS = 250;
/** The way not taken again, or not yet. */
const PALE = 0.35;

export class Stage {
  readonly #canvas: HTMLCanvasElement;
  readonly #pacer = new Pacer();
  readonly #renderer: WebGLRenderer;
  readonly #viewpoint: Viewpoint;
  readonly #scene = new Scene();
  readonly #returns = new Returns();
  readonly #route = new Route();
  readonly #ahead = new Route(PALE);
  readonly #subgoals = new Subgoals();
  readonly #places = new Places();
  readonly #waypoints = new Waypoints();
  readonly #glide = new Glide();
  readonly #overlays: Overlays;
  readonly #sensor = new Vector3();
  readonly #husky = new Husky();
  readonly #relief: Relief;
  #info: SessionInfo | undefined;
  #shown: Pose | undefined;
  #speed = 1;
  #dirty = true;
  /** Who waits until nothing moves. */
  #patient: (() => void)[] = [];
  /** Called with the view right after each drawing: later its pixels are gone. */
  drawn: ((view: HTMLCanvasElement) => void) | undefined;
  #colouring: Colouring = 'elevation';

  constructor(canvas: HTMLCanvasElement, theme: Theme) {
    this.#canvas = canvas;
    this.#renderer = new WebGLRenderer({ canvas, antialias: !this.#pacer.software, alpha: true });
    this.#viewpoint = new Viewpoint(canvas, () => this.invalidate());
    const vertices = this.#pacer.software ? GRID_VERTICES.software : GRID_VERTICES.hardware;
    this.#relief = new Relief(vertices, theme, () => this.invalidate());
    this.#scene.add(this.#relief.mesh, this.#husky.group);
    const sun = new DirectionalLight(0xfff3df, 3.2);
    sun.position.set(...SUN);
    this.#scene.add(new AmbientLight(0xd5e0f2, 2.1), sun);
    this.#scene.add(this.#ahead.line, this.#waypoints.group);
    this.#scene.add(this.#route.line, this.#returns.points, this.#subgoals.group, this.#places.group);
    this.#overlays = new Overlays(theme, FIRST_LAYERS, this.#height);
    this.#scene.add(this.#overlays.group);
    this.theme(theme);
    new ResizeObserver(() => this.#resize()).observe(canvas);
    canvas.addEventListener('webglcontextrestored', () => this.invalidate());
    requestAnimationFrame((now_ms) => this.#loop(now_ms));
  }

  get field(): HeightField | undefined {
    return this.#info && this.#relief.field;
  }

  /** The robot as it is drawn now, between two ticks. */
  get robot(): Pose | undefined {
    return this.#shown;
  }

  get camera(): CameraMode {
    return this.#viewpoint.mode;
  }

  get viewHeading_rad(): number {
    return this.#viewpoint.heading_rad;
  }

  /** Shows something more, which tells of its changes with `invalidate`. */
  add(part: Object3D): void {
    this.#scene.add(part);
    this.invalidate();
  }

  invalidate(): void {
    this.#dirty = true;
  }

  /** Resolves once everything is drawn as it is and nothing moves any more. */
  still(): Promise<void> {
    return new Promise((resolve) => this.#patient.push(resolve));
  }

  theme(theme: Theme): void {
    const marks = [this.#returns, this.#route, this.#ahead, this.#subgoals, this.#places, this.#waypoints];
    for (const part of [this.#relief, ...marks, this.#overlays]) part.theme(theme);
    this.invalidate();
  }

  /** Uses the time until there is ground: has the shaders compiled, by a picture without pixels. */
  prepare(): void {
    requestAnimationFrame(() => this.#warmUp());
  }

  session(info: SessionInfo, field: HeightField | undefined): void {
    if (!this.#info) this.#husky.mast(info.sensor_height_m);
    this.#info = info;
    if (field) this.#replaceGround(field);
    this.#overlays.session(info);
    if (field) this.#returns.heights(field.min_m, field.max_m);
    this.#relief.colouring(this.#colouring, info.limits);
    const { start, goal } = info;
    this.#places.show(goal, start, this.#height);
    this.#waypoints.show(info.waypoints, this.#height);
    if (field) {
      const towards = Math.atan2(goal.y - start.y, goal.x - start.x);
      this.#viewpoint.reset();
      this.#husky.group.visible = true;
      this.#viewpoint.follow({ ...start, z: this.#height(start.x, start.y) }, towards - FIRST_LOOK_RAD);
    }
    this.invalidate();
  }

  frame(frame: Frame): void {
    const { pose } = frame;
    if (frame.anew) {
      this.#route.clear();
      this.#ahead.clear();
      this.#glide.reset();
    }
    if (frame.ahead) this.#ahead.extend(frame.ahead);
    this.#waypoints.passed(frame.waypointsPassed);
    this.#route.extend(frame.path);
    this.#glide.to(
      pose,
      performance.now(),
      Math.min((1000 * (this.#info?.period_s ?? 0)) / this.#speed, LONGEST_GLIDE_MS),
    );
    this.#returns.show(frame, this.#radius_m);
    this.#subgoals.show(frame.subgoals, this.#height);
    this.#overlays.show(frame);
    this.invalidate();
  }

  layers(layers: Layers): void {
    this.#returns.colours(layers.points);
    this.#subgoals.group.visible = layers.subgoals;
    this.#overlays.layers(layers);
    this.invalidate();
  }

  /** Marks what somebody points at. */
  mark(frame: Frame, target: Target | undefined): void {
    this.#overlays.mark(frame, target);
    this.invalidate();
  }

  /** How to find the subgoal or segment under a place of the window, within so many pixels. */
  pointedAt(clientX: number, clientY: number, within_px: number): Finder | undefined {
    return this.#overlays.pointedAt(this.#canvas, this.#viewpoint.camera, clientX, clientY, within_px);
  }

  /** The field's heights have changed. */
  sculpted(): void {
    this.#relief.sculpted();
    if (this.field) this.#returns.heights(this.field.min_m, this.field.max_m);
    this.#places.settle(this.#height);
    this.#waypoints.settle(this.#height);
    this.invalidate();
  }

  /** By what the ground is coloured. */
  colouring(colouring: Colouring): void {
    this.#colouring = colouring;
    if (this.#info) this.#relief.colouring(colouring, this.#info.limits);
    this.invalidate();
  }

  /** How fast simulated time runs, so that the robot glides from tick to tick. */
  speed(speed: number): void {
    this.#speed = speed;
  }

  /** Looks from elsewhere; `free` from above the whole ground. */
  view(mode: CameraMode): void {
    const robot = this.#shown;
    if (mode === 'free' && this.field) this.#viewpoint.overview(this.field);
    else if (robot && mode === 'chase') this.#viewpoint.follow(robot, robot.yaw - FIRST_LOOK_RAD);
    else if (robot && mode === 'top') this.#viewpoint.above(robot);
    else if (robot && mode === 'eye') this.#viewpoint.eye(robot, this.#sensorAt(robot));
    this.#husky.group.visible = mode !== 'eye';
    this.#resize();
  }

  /** Lets the camera stay where it is while the robot drives on. */
  release(): void {
    this.#viewpoint.release();
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
    this.#relief.brush(at, from, radius_m);
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

  get #radius_m(): number {
    return this.#info?.occupancy_radius_m ?? 0;
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
    this.#relief.ground(field);
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
    if (this.#patient.length > 0) this.#viewpoint.settle();
    if (!this.#dirty && !this.#relief.relighting) for (const rested of this.#patient.splice(0)) rested();
    const { field } = this;
    // No picture of the ground without the robot, which comes right after it.
    if (!field || !this.#shown || !this.#pacer.due(now_ms) || !this.#dirty) return;
    this.#dirty = false;
    const { camera } = this.#viewpoint;
    this.#viewpoint.clear(field);
    this.#subgoals.attach(this.#sensor, camera.position);
    this.#places.face(camera.position);
    this.#waypoints.face(camera.position);
    this.#renderer.render(this.#scene, camera);
    this.drawn?.(this.#canvas);
    if (this.#pacer.drew(now_ms)) this.#resize();
  }

  #warmUp(): void {
    if (this.field) return;
    this.#viewpoint.follow(this.#husky.group.position);
    this.#renderer.setScissor(0, 0, 0, 0);
    this.#renderer.setScissorTest(true);
    this.#renderer.render(this.#scene, this.#viewpoint.camera);
    this.#renderer.setScissorTest(false);
  }

  #moveRobot(): void {
    const pose = this.#glide.at(performance.now());
    const before = this.#shown;
    if (!pose || pose === before) return;
    this.#shown = pose;
    this.#husky.pose(pose);
    this.#overlays.pose(pose);
    if (before) {
      const [east, north] = [pose.x - before.x, pose.y - before.y];
      this.#husky.roll(east * Math.cos(pose.yaw) + north * Math.sin(pose.yaw), wrap(pose.yaw - before.yaw));
    }
    this.#viewpoint.track(pose, this.#sensorAt(pose));
    this.#relief.robot(pose.x, pose.y, pose.yaw, this.#radius_m);
    this.invalidate();
  }
}
