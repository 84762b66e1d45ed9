/** The camera: behind the robot, in its eye, above it or free; moved by mouse, touch and keys, and never in the ground. */

import { MathUtils, MOUSE, PerspectiveCamera, Quaternion, TOUCH, Vector3 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { wrap } from '../base/format.ts';
import type { HeightField, Vector } from '../ground/heightField.ts';
import { DEPTH_M } from '../painter/painterProtocol.ts';
import type { Pose } from '../protocol/simulationProtocol.ts';
import { Gaze } from './gaze.ts';

/** `chase` follows behind the robot, `eye` is its sensor, `top` follows from above with north up, `free` stays. */
export type CameraMode = 'chase' | 'eye' | 'top' | 'free';

export const FIELD_OF_VIEW_DEG = 42;
const NEAREST_M = 3;
const FARTHEST_M = 260;
const FOLLOW_DISTANCE_M = 14.5;
const FOLLOW_ELEVATION_RAD = 0.45;
/** The camera looks this far above the robot's feet. */
const TARGET_LIFT_M = 0.4;
/** Room between the camera and the ground under it. */
const CLEARANCE_M = 0.8;
/** From above, the circle that the planner looks at and as much again around it. */
const TOP_DISTANCE_M = 34;
/** From where the whole ground is seen. */
export const OVERVIEW_ELEVATION_RAD = 0.85;
/** The chasing camera swings behind a turning robot within about this time. */
const SWING_MS = 900;
/** Less than this it makes at once. */
const LEAST_SWING_RAD = 0.002;
/** Smaller moves nobody sees. */
const LEAST_MOVE_M = 1e-6;
const LEAST_MOVE_RAD = 1e-6;
/** How far the camera rises with each picture while a hill hides the robot. */
const RISE_RAD = 0.03;

/** How far from the middle of a ground all of it is in a view of this aspect, seen from the middle of its south side. */
export function overviewDistance_m(ground: Pick<HeightField, 'width_m' | 'depth_m'>, aspect: number): number {
  const slope = Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2));
  // The near edge, which looks widest, has to fit in a narrow view.
  const nearer_m = 0.5 * ground.depth_m * Math.cos(OVERVIEW_ELEVATION_RAD);
  return Math.max((0.55 * ground.depth_m) / slope, (0.53 * ground.width_m) / (slope * aspect) + nearer_m);
}

export class Viewpoint {
  readonly #camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, DEPTH_M.near, DEPTH_M.far);
  readonly #controls: OrbitControls;
  readonly #gaze: Gaze;
  /** Where the camera was when it last moved. */
  readonly #before = { position: new Vector3(), quaternion: new Quaternion() };
  readonly #reduced = window.matchMedia('(prefers-reduced-motion: reduce)');
  #mode: CameraMode = 'chase';
  #dragging = false;
  /** The robot's heading when it was tracked last, and how much of its turns the camera has still to make. */
  #heading_rad: number | undefined;
  #swing_rad = 0;
  #swung_ms = 0;

  constructor(canvas: HTMLCanvasElement, changed: () => void) {
    this.#camera.up.set(0, 0, 1);
    this.#gaze = new Gaze(canvas, this.#camera, changed);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.maxPolarAngle = MathUtils.degToRad(86);
    this.#controls.minDistance = NEAREST_M;
    this.#controls.maxDistance = FARTHEST_M;
    this.#controls.enableDamping = !this.#reduced.matches;
    this.#controls.dampingFactor = 0.12;
    this.#controls.addEventListener('change', () => {
      if (this.#hasMoved()) changed();
    });
    this.#controls.addEventListener('start', () => {
      this.#dragging = true;
    });
    this.#controls.addEventListener('end', () => {
      this.#dragging = false;
    });
  }

  /** Where it stands now, ready to cast rays through. */
  get camera(): PerspectiveCamera {
    this.#camera.updateMatrixWorld();
    return this.#camera;
  }

  get mode(): CameraMode {
    return this.#mode;
  }

  /** Direction in which the viewer looks, in the plane. */
  get heading_rad(): number {
    if (this.#mode === 'eye') return (this.#heading_rad ?? 0) + this.#gaze.turn_rad;
    const { target } = this.#controls;
    return Math.atan2(target.y - this.#camera.position.y, target.x - this.#camera.position.x);
  }

  resize(aspect: number): void {
    this.#camera.aspect = aspect;
    this.#camera.updateProjectionMatrix();
  }

  /** Lets a drag run out gently, and goes on to swing behind the robot, which may stand by now. */
  update(): void {
    if (this.#mode !== 'eye') this.#controls.update();
    const now_ms = performance.now();
    const rest = Math.abs(this.#swing_rad) < LEAST_SWING_RAD ? 0 : Math.exp((this.#swung_ms - now_ms) / SWING_MS);
    this.#swung_ms = now_ms;
    this.#swing(1 - rest);
  }

  /** Swings all the way behind the robot at once. */
  settle(): void {
    this.#swing(1);
  }

  /** Stands behind the robot as seen along `heading_rad`, and follows it from now on. */
  follow(robot: Vector, heading_rad = this.heading_rad): void {
    this.#enter('chase');
    this.#aim(robot);
    this.#stand(heading_rad + Math.PI, FOLLOW_ELEVATION_RAD, FOLLOW_DISTANCE_M);
  }

  /** Looks down on the robot, north up, and follows it from now on. */
  above(robot: Vector): void {
    this.#enter('top');
    this.#aim(robot);
    this.#stand(-Math.PI / 2, Math.PI / 2, TOP_DISTANCE_M);
  }

  /** Looks through the robot's sensor from now on. */
  eye(pose: Pose, sensor: Vector): void {
    this.#enter('eye');
    this.#gaze.begin();
    this.track(pose, sensor);
  }

  /** Stays where it is while the robot drives on. */
  release(): void {
    this.#enter('free');
  }

  /** The robot and its sensor have moved to here. */
  track(robot: Pose, sensor: Vector): void {
    if (this.#mode === 'eye') this.#gaze.stand(robot, sensor);
    if (this.#mode === 'chase' || this.#mode === 'top') {
      const before = this.#controls.target.clone();
      this.#aim(robot);
      this.#camera.position.add(this.#controls.target).sub(before);
    }
    this.#swing_rad += wrap(robot.yaw - (this.#heading_rad ?? robot.yaw));
    this.#heading_rad = robot.yaw;
  }

  /** Forgets the robot: the next place is that of another run. */
  reset(): void {
    this.#heading_rad = undefined;
    this.#swing_rad = 0;
  }

  /** The whole ground from the south, from above. */
  overview(field: HeightField): void {
    this.#enter('free');
    this.#controls.target.set(field.west_m + field.width_m / 2, field.south_m + field.depth_m / 2, field.min_m);
    this.#stand(-Math.PI / 2, OVERVIEW_ELEVATION_RAD, overviewDistance_m(field, this.#camera.aspect));
  }

  /** Makes a share of the robot's turns that the chasing camera has still to make; any other makes none. */
  #swing(share: number): void {
    if (this.#mode !== 'chase' || this.#reduced.matches || this.#dragging) this.#swing_rad = 0;
    const part_rad = share * this.#swing_rad;
    this.#swing_rad -= part_rad;
    if (part_rad !== 0) this.nudge(part_rad, 0, 1);
  }

  #aim(robot: Vector): void {
    this.#controls.target.set(robot.x, robot.y, robot.z + TARGET_LIFT_M);
  }

  #enter(mode: CameraMode): void {
    if (this.#mode === 'eye') this.#gaze.end();
    this.#mode = mode;
    this.#swing_rad = 0;
    this.#controls.enabled = mode !== 'eye';
    // From above, a drag turns the map and never tilts it.
    this.#controls.maxPolarAngle = mode === 'top' ? 0 : MathUtils.degToRad(86);
    if (mode === 'eye' || this.#camera.fov === FIELD_OF_VIEW_DEG) return;
    this.#camera.fov = FIELD_OF_VIEW_DEG;
    this.#camera.updateProjectionMatrix();
  }

  /** With a tool in hand the main button and one finger are the tool's; the other button and two fingers move the view. */
  toolInHand(inHand: boolean): void {
    this.#gaze.toolInHand = inHand;
    this.#controls.mouseButtons = {
      LEFT: inHand ? null : MOUSE.ROTATE,
      MIDDLE: MOUSE.DOLLY,
      RIGHT: inHand ? MOUSE.ROTATE : MOUSE.PAN,
    };
    this.#controls.touches = { ONE: inHand ? null : TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
  }

  /** Turns, tilts and zooms by steps. */
  nudge(turn_rad: number, tilt_rad: number, zoom: number): void {
    if (this.#mode === 'eye') {
      this.#gaze.nudge(-turn_rad, -tilt_rad, zoom);
      return;
    }
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const distance_m = offset.length();
    this.#stand(
      Math.atan2(offset.y, offset.x) + turn_rad,
      MathUtils.clamp(Math.asin(offset.z / distance_m) + tilt_rad, 0.08, this.#mode === 'top' ? Math.PI / 2 : 1.54),
      MathUtils.clamp(distance_m * zoom, NEAREST_M, FARTHEST_M),
    );
  }

  /** Moves what is looked at over the ground, by shares of the distance to it, and stays there while the robot drives on. */
  move(right: number, ahead: number, field: HeightField): void {
    if (this.#mode === 'eye') return;
    const { target } = this.#controls;
    const [from, heading_rad] = [target.clone(), this.heading_rad];
    const distance_m = this.#camera.position.distanceTo(target);
    const [sin, cos] = [distance_m * Math.sin(heading_rad), distance_m * Math.cos(heading_rad)];
    target.x = MathUtils.clamp(from.x + ahead * cos + right * sin, field.west_m, field.west_m + field.width_m);
    target.y = MathUtils.clamp(from.y + ahead * sin - right * cos, field.south_m, field.south_m + field.depth_m);
    target.z += field.height(target.x, target.y) - field.height(from.x, from.y);
    this.#camera.position.add(target).sub(from);
    this.#enter('free');
    this.#controls.update();
  }

  /** Before each picture: out of the ground, and up while a hill hides the robot that it follows. */
  clear(field: HeightField): void {
    if (this.#mode === 'eye') return;
    const { position } = this.#camera;
    if (field.contains(position.x, position.y)) {
      position.z = Math.max(position.z, field.height(position.x, position.y) + CLEARANCE_M);
    }
    if (this.#mode !== 'chase' || this.#dragging) return;
    const line = this.#controls.target.clone().sub(position);
    const hit = field.intersect(position, line);
    // What the ray meets at the robot or beyond it hides nothing.
    if (!hit || Math.hypot(hit.x - position.x, hit.y - position.y) > Math.hypot(line.x, line.y) - 0.6) return;
    this.nudge(0, RISE_RAD, 1);
  }

  /**
   * Whether the camera has moved since it was asked last: at the nearest and the farthest, rounding has the controls tell of a zoom
   * with every picture.
   */
  #hasMoved(): boolean {
    const { position, quaternion } = this.#camera;
    const { position: place, quaternion: direction } = this.#before;
    const turn_rad = quaternion.angleTo(direction);
    if (position.distanceTo(place) < LEAST_MOVE_M && turn_rad < LEAST_MOVE_RAD) return false;
    place.copy(position);
    direction.copy(quaternion);
    return true;
  }

  /** Places the camera around its target. */
  #stand(azimuth_rad: number, elevation_rad: number, distance_m: number): void {
    const flat_m = distance_m * Math.cos(elevation_rad);
    const { target } = this.#controls;
    this.#camera.position.set(
      target.x + flat_m * Math.cos(azimuth_rad),
      target.y + flat_m * Math.sin(azimuth_rad),
      target.z + distance_m * Math.sin(elevation_rad),
    );
    this.#controls.update();
  }
}
