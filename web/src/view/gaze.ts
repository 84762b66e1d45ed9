/** Looking around from the robot's sensor: one finger or the mouse turns the gaze, two fingers or the wheel zoom. */

import { Euler, MathUtils, Matrix4, type PerspectiveCamera, Quaternion, Vector3 } from 'three';
import type { Vector } from '../ground/heightField.ts';
import type { Pose } from '../protocol/simulationProtocol.ts';

const WIDEST_DEG = 84;
const NARROWEST_DEG = 20;
const FIRST_DEG = 68;
const FIRST_TILT_RAD = -0.12;
const STEEPEST_RAD = 1.35;
/** The camera looks along its own -z with y up; the body's x is forward and z up. */
const BODY_FROM_CAMERA = new Quaternion().setFromRotationMatrix(
  new Matrix4().makeBasis(new Vector3(0, -1, 0), new Vector3(0, 0, 1), new Vector3(-1, 0, 0)),
);

export class Gaze {
  readonly #camera: PerspectiveCamera;
  readonly #changed: () => void;
  readonly #pointers = new Map<number, { x: number; y: number }>();
  readonly #reduced = window.matchMedia('(prefers-reduced-motion: reduce)');
  /** Whether the robot's eye is the camera, and whether a tool has the main button and single fingers. */
  active = false;
  toolInHand = false;
  #turn_rad = 0;
  #tilt_rad = 0;
  #fov_deg = FIRST_DEG;
  /** Where the robot is and its sensor: also while it stands, the gaze turns. */
  #place: { readonly pose: Pose; readonly sensor: Vector } | undefined;

  constructor(canvas: HTMLCanvasElement, camera: PerspectiveCamera, changed: () => void) {
    this.#camera = camera;
    this.#changed = changed;
    canvas.addEventListener('pointerdown', ({ pointerId, clientX, clientY }) => {
      if (!this.active) return;
      this.#pointers.set(pointerId, { x: clientX, y: clientY });
      canvas.setPointerCapture(pointerId);
    });
    canvas.addEventListener('pointermove', (event) => this.#move(event, canvas.clientHeight));
    for (const end of ['pointerup', 'pointercancel'] as const) {
      canvas.addEventListener(end, ({ pointerId }) => this.#pointers.delete(pointerId));
    }
    canvas.addEventListener('wheel', ({ deltaY }) => this.active && this.nudge(0, 0, Math.exp(0.001 * deltaY)), {
      passive: true,
    });
  }

  /** Direction of the gaze from the robot's nose, positive to the left. */
  get turn_rad(): number {
    return this.#turn_rad;
  }

  /** Looks ahead from now on. */
  begin(): void {
    this.active = true;
    this.#turn_rad = 0;
    this.#tilt_rad = FIRST_TILT_RAD;
    this.#fov_deg = FIRST_DEG;
  }

  end(): void {
    this.active = false;
    this.#pointers.clear();
  }

  /** Turns and tilts the gaze, and zooms. */
  nudge(turn_rad: number, tilt_rad: number, zoom: number): void {
    this.#turn_rad += turn_rad;
    this.#tilt_rad = MathUtils.clamp(this.#tilt_rad + tilt_rad, -STEEPEST_RAD, STEEPEST_RAD);
    this.#fov_deg = MathUtils.clamp(this.#fov_deg * zoom, NARROWEST_DEG, WIDEST_DEG);
    this.#look();
    this.#changed();
  }

  /** Puts the camera where the sensor is. */
  stand(pose: Pose, sensor: Vector): void {
    this.#place = { pose, sensor };
    this.#look();
  }

  #look(): void {
    if (!this.#place) return;
    const { pose, sensor } = this.#place;
    // The horizon stays level where moving pictures are unwelcome.
    const [roll, pitch] = this.#reduced.matches ? [0, 0] : [pose.roll, pose.pitch];
    const body = new Quaternion().setFromEuler(new Euler(roll, -pitch, pose.yaw, 'ZYX'));
    const gaze = new Quaternion().setFromEuler(new Euler(0, -this.#tilt_rad, this.#turn_rad, 'ZYX'));
    this.#camera.position.set(sensor.x, sensor.y, sensor.z);
    this.#camera.quaternion.copy(body.multiply(gaze).multiply(BODY_FROM_CAMERA));
    if (this.#camera.fov === this.#fov_deg) return;
    this.#camera.fov = this.#fov_deg;
    this.#camera.updateProjectionMatrix();
  }

  #move({ pointerId, clientX, clientY, buttons }: PointerEvent, height: number): void {
    const from = this.#pointers.get(pointerId);
    if (!from || !this.active) return;
    const to = { x: clientX, y: clientY };
    const other = [...this.#pointers].find(([id]) => id !== pointerId)?.[1];
    this.#pointers.set(pointerId, to);
    if (other) {
      const apart = (one: { x: number; y: number }) => Math.hypot(one.x - other.x, one.y - other.y);
      this.nudge(0, 0, apart(from) / Math.max(apart(to), 1));
    } else if (!this.toolInHand || (buttons & 2) > 0) {
      // The ground under the pointer stays there.
      const step_rad = MathUtils.degToRad(this.#fov_deg) / height;
      this.nudge(step_rad * (to.x - from.x), step_rad * (to.y - from.y), 1);
    }
  }
}
