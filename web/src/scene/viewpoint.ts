/** The camera: orbits by mouse, touch and keys, follows the robot, and stays where it can see. */

import { MathUtils, MOUSE, PerspectiveCamera, TOUCH, Vector3 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { HeightField, Vector } from './heightfield.ts';

const FIELD_OF_VIEW_DEG = 42;
const NEAREST_M = 3;
const FARTHEST_M = 260;
const FOLLOW_DISTANCE_M = 14.5;
const FOLLOW_ELEVATION_RAD = 0.45;
/** The camera looks this far above the robot's feet. */
const TARGET_LIFT_M = 0.4;
/** Room between the camera and the ground under it. */
const CLEARANCE_M = 0.8;
/** How far the camera rises with each picture while a hill hides the robot. */
const RISE_RAD = 0.03;

export class Viewpoint {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 0.1, 1500);
  readonly #controls: OrbitControls;
  #following = true;
  #dragging = false;

  constructor(canvas: HTMLCanvasElement, changed: () => void) {
    this.camera.up.set(0, 0, 1);
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.maxPolarAngle = MathUtils.degToRad(86);
    this.#controls.minDistance = NEAREST_M;
    this.#controls.maxDistance = FARTHEST_M;
    this.#controls.enableDamping = !window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.#controls.dampingFactor = 0.12;
    this.#controls.addEventListener('change', changed);
    this.#controls.addEventListener('start', () => {
      this.#dragging = true;
    });
    this.#controls.addEventListener('end', () => {
      this.#dragging = false;
    });
  }

  get following(): boolean {
    return this.#following;
  }

  /** Direction in which the viewer looks, in the plane. */
  get heading_rad(): number {
    const { target } = this.#controls;
    return Math.atan2(target.y - this.camera.position.y, target.x - this.camera.position.x);
  }

  /** The window's height in metres, one metre away. */
  get heightAtOneMetre(): number {
    return 2 * Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2));
  }

  resize(aspect: number): void {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
  }

  /** Lets a drag run out gently. */
  update(): void {
    this.#controls.update();
  }

  /** Stands behind the robot as seen along `heading_rad`, and follows it from now on. */
  follow(robot: Vector, heading_rad = this.heading_rad): void {
    this.#following = true;
    this.#controls.target.set(robot.x, robot.y, robot.z + TARGET_LIFT_M);
    this.#stand(heading_rad + Math.PI, FOLLOW_ELEVATION_RAD, FOLLOW_DISTANCE_M);
  }

  /** Stays where it is while the robot drives on. */
  release(): void {
    this.#following = false;
  }

  /** The robot has moved to here. */
  track(robot: Vector): void {
    if (!this.#following) return;
    const shift = new Vector3(robot.x, robot.y, robot.z + TARGET_LIFT_M).sub(this.#controls.target);
    this.#controls.target.add(shift);
    this.camera.position.add(shift);
  }

  /** The whole ground from the south, from above. */
  overview(field: HeightField): void {
    this.#following = false;
    const width_m = Math.max(field.width_m / Math.min(this.camera.aspect, 1.5), field.depth_m);
    this.#controls.target.set(field.width_m / 2, field.depth_m / 2, field.min_m);
    this.#stand(-Math.PI / 2, 0.85, (1.1 * width_m) / this.heightAtOneMetre);
  }

  /** With a tool in hand the main button and one finger are the tool's; the other button and two fingers move the view. */
  toolInHand(inHand: boolean): void {
    this.#controls.mouseButtons = {
      LEFT: inHand ? null : MOUSE.ROTATE,
      MIDDLE: MOUSE.DOLLY,
      RIGHT: inHand ? MOUSE.ROTATE : MOUSE.PAN,
    };
    this.#controls.touches = { ONE: inHand ? null : TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
  }

  /** Turns, tilts and zooms by steps. */
  nudge(turn_rad: number, tilt_rad: number, zoom: number): void {
    const offset = this.camera.position.clone().sub(this.#controls.target);
    const distance_m = offset.length();
    this.#stand(
      Math.atan2(offset.y, offset.x) + turn_rad,
      MathUtils.clamp(Math.asin(offset.z / distance_m) + tilt_rad, 0.08, 1.54),
      MathUtils.clamp(distance_m * zoom, NEAREST_M, FARTHEST_M),
    );
  }

  /** Before each picture: out of the ground, and up while a hill hides the robot that it follows. */
  clear(field: HeightField): void {
    const { position } = this.camera;
    if (field.contains(position.x, position.y)) {
      position.z = Math.max(position.z, field.height(position.x, position.y) + CLEARANCE_M);
    }
    if (!this.#following || this.#dragging) return;
    const line = this.#controls.target.clone().sub(position);
    const hit = field.intersect(position, line);
    // What the ray meets at the robot or beyond it hides nothing.
    if (!hit || Math.hypot(hit.x - position.x, hit.y - position.y) > Math.hypot(line.x, line.y) - 0.6) return;
    this.nudge(0, RISE_RAD, 1);
  }

  /** Places the camera around its target. */
  #stand(azimuth_rad: number, elevation_rad: number, distance_m: number): void {
    const flat_m = distance_m * Math.cos(elevation_rad);
    const { target } = this.#controls;
    this.camera.position.set(
      target.x + flat_m * Math.cos(azimuth_rad),
      target.y + flat_m * Math.sin(azimuth_rad),
      target.z + distance_m * Math.sin(elevation_rad),
    );
    this.#controls.update();
  }
}
