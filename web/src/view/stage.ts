/** The 3D view as the page has it: camera, robot between two ticks, and what is where. The painter draws it in a worker. */

import { Raycaster, Vector2 } from 'three';
import type { Theme } from '../colours/theme.ts';
import type { Place } from '../experiment/place.ts';
import type { HeightField, Vector } from '../ground/heightField.ts';
import { type Graphics, PainterClient } from '../painter/painterClient.ts';
import { type GhostStep, sceneryOf, seenIn } from '../painter/painterProtocol.ts';
import type { Frame, GroundPatch, Pose, SessionInfo, Solid } from '../protocol/simulationProtocol.ts';
import { type Colouring, FIRST_LAYERS, type Layers } from '../scene/layers.ts';
import type { Finder, Target } from '../scene/selection.ts';
import { sensorAt } from '../scene/sensor.ts';
import { Glide } from './glide.ts';
import { nearestMark, projector } from './nearestMark.ts';
import { middle, nearestSolid } from './nearestSolid.ts';
import { type CameraMode, Viewpoint } from './viewpoint.ts';

/** The first look passes the robot's right side by this much, to show both it and the ground ahead. */
const FIRST_LOOK_RAD = 0.35;
/** At slow motion the robot still glides no longer than this from tick to tick. */
const LONGEST_GLIDE_MS = 250;

export class Stage {
  readonly #canvas: HTMLCanvasElement;
  readonly #painter: PainterClient;
  readonly #viewpoint: Viewpoint;
  readonly #glide = new Glide();
  readonly #believedGlide = new Glide();
  #info: SessionInfo | undefined;
  #field: HeightField | undefined;
  /** The ground before the stroke that is made. */
  #before: HeightField | undefined;
  #frame: Frame | undefined;
  #solids: readonly Solid[] = [];
  #shown: Pose | undefined;
  #believed: Pose | undefined;
  #layers = FIRST_LAYERS;
  #speed = 1;
  /** Whether the camera or the robot has moved since the painter heard of them. */
  #moved = true;
  /** Who waits until nothing moves. */
  #waiting: (() => void)[] = [];

  /** Throws where the browser lets no worker draw. */
  constructor(canvas: HTMLCanvasElement, theme: Theme, graphics: Graphics) {
    this.#canvas = canvas;
    this.#painter = new PainterClient(canvas, theme, graphics);
    this.#viewpoint = new Viewpoint(canvas, () => {
      this.#moved = true;
    });
    new ResizeObserver(() => this.#resize()).observe(canvas);
    requestAnimationFrame(() => this.#loop());
  }

  get field(): HeightField | undefined {
    return this.#field;
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

  /** Resolves once everything is drawn as it is and nothing moves any more. */
  still(): Promise<void> {
    return new Promise((resolve) => this.#waiting.push(resolve));
  }

  /** Gives every picture, from the present one on (that one in full resolution if it is to be `fine`), to `film`, which closes it, and `undefined` when there will be no more; or to nobody. */
  film(film: ((picture: ImageBitmap | undefined) => void) | undefined, fine: boolean): void {
    this.#painter.film(film, fine);
  }

  theme(theme: Theme): void {
    this.#painter.send({ type: 'theme', theme });
  }

  session(info: SessionInfo, field: HeightField | undefined): void {
    this.#info = info;
    this.#solids = info.solids;
    this.#painter.send({ type: 'scenery', scenery: sceneryOf(info), ground: field?.ground });
    if (!field) return;
    this.#field = field;
    this.#shown = undefined;
    this.#glide.reset();
    this.#believedGlide.reset();
    const { start, goal } = info;
    const towards = Number.isFinite(goal.x) ? Math.atan2(goal.y - start.y, goal.x - start.x) : start.heading_rad;
    this.#viewpoint.reset();
    this.#viewpoint.follow({ ...start, z: field.height(start.x, start.y) }, towards - FIRST_LOOK_RAD);
  }

  /** Heights around the robot where no ground is known: marks stand on them, and nothing of them is drawn. */
  surroundings(field: HeightField): void {
    this.#field = field;
    this.#painter.send({ type: 'surroundings', ground: field.ground });
  }

  frame(frame: Frame): void {
    this.#frame = frame;
    if (frame.anew) this.#glide.reset();
    if (frame.anew || !frame.believed) this.#believedGlide.reset();
    const period_ms = 1000 * (this.#info?.period_s ?? 0);
    const [now_ms, span_ms] = [performance.now(), Math.min(period_ms / this.#speed, LONGEST_GLIDE_MS)];
    this.#glide.to(frame.pose, now_ms, span_ms);
    if (frame.believed) this.#believedGlide.to(frame.believed, now_ms, span_ms);
    this.#painter.send({ type: 'seen', seen: seenIn(frame) });
  }

  layers(layers: Layers): void {
    this.#layers = layers;
    this.#painter.send({ type: 'layers', layers });
  }

  /** Marks what somebody points at in the newest frame. */
  mark(target: Target | undefined): void {
    this.#painter.send({ type: 'mark', target });
  }

  /** How to find the subgoal or segment under a place of the window, within so many pixels. */
  pointedAt(clientX: number, clientY: number, within_px: number): Finder | undefined {
    const find: Finder = (frame) => {
      const project = projector(this.#canvas.getBoundingClientRect(), this.#viewpoint.camera);
      const shown = { ...this.#layers, radius_m: this.#info?.occupancy_radius_m ?? 0, height: this.#height };
      return nearestMark(frame, shown, within_px, (place) => {
        const at = project(place);
        return at ? Math.hypot(at.x - clientX, at.y - clientY) : Number.POSITIVE_INFINITY;
      });
    };
    return this.#frame && find(this.#frame) ? find : undefined;
  }

  /** The field has these new heights. */
  sculpted(patch: GroundPatch, solids: readonly Solid[]): void {
    this.#solids = solids;
    this.#painter.send({ type: 'patch', patch, solids });
  }

  colouring(colouring: Colouring): void {
    this.#painter.send({ type: 'colouring', colouring });
  }

  /** How fast simulated time runs, so that the robot glides from tick to tick. */
  speed(speed: number): void {
    this.#speed = speed;
  }

  /** Other robots on the same course in place of those before, each in its colour. */
  ghosts(colours: readonly string[]): void {
    this.#painter.send({ type: 'ghosts', colours });
  }

  /** How each of them goes on. */
  ghostSteps(steps: readonly GhostStep[]): void {
    this.#painter.send({ type: 'ghostSteps', steps });
  }

  /** Looks from elsewhere; `free` from above the whole ground. */
  view(mode: CameraMode): void {
    const robot = this.#shown;
    if (mode === 'free' && this.#field) this.#viewpoint.overview(this.#field);
    else if (robot && mode === 'chase') this.#viewpoint.follow(robot, robot.yaw - FIRST_LOOK_RAD);
    else if (robot && mode === 'top') this.#viewpoint.above(robot);
    else if (robot && mode === 'eye') this.#viewpoint.eye(robot, this.#sensorOf(robot));
    this.#moved = true;
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
    this.#moved = true;
  }

  /** Moves the view over the ground, by shares of the distance to what is looked at. */
  move(right: number, ahead: number): void {
    if (!this.#field) return;
    this.#viewpoint.move(right, ahead, this.#field);
    this.#moved = true;
  }

  /** The brush's ring, drawn out along the line from `from`; a radius of zero hides it. */
  brush(at: Place, from: Place, radius_m: number): void {
    this.#painter.send({ type: 'brush', at: { x: at.x, y: at.y }, from: { x: from.x, y: from.y }, radius_m });
  }

  /** The point of the ground under a place of the window. */
  pick(clientX: number, clientY: number): Vector | undefined {
    const { origin, direction } = this.#ray(clientX, clientY);
    return (this.#before ?? this.#field)?.intersect(origin, direction);
  }

  /** While a stroke is made, `pick` finds places on the ground as it was before: else a hill that is raised would meet the ray ever nearer to the eye. */
  pickAsBefore(stroke: boolean): void {
    this.#before = stroke ? this.#field?.copy() : undefined;
  }

  /** The object in hand, if any, and how far it is dragged from where it stands. */
  held(object: number | undefined, by: Place = { x: 0, y: 0 }): void {
    this.#painter.send({ type: 'held', object, by: { x: by.x, y: by.y } });
  }

  /** The object under a place of the window, or within so many pixels of it. */
  objectAt(clientX: number, clientY: number, within_px: number): number | undefined {
    const { origin, direction } = this.#ray(clientX, clientY);
    const { fov } = this.#viewpoint.camera;
    const room = (within_px * 2 * Math.tan((fov * Math.PI) / 360)) / this.#canvas.clientHeight;
    return nearestSolid([...this.#solids, ...(this.#frame?.movers ?? [])], origin, direction, room);
  }

  /** Where the shapes of an object are on average. */
  middleOf(object: number): Vector | undefined {
    return middle([...this.#solids, ...(this.#frame?.movers ?? [])].filter((solid) => solid.object === object));
  }

  /** Where a place on the ground is in the window; nothing if it is behind the camera. */
  project({ x, y }: Place): { x: number; y: number } | undefined {
    const project = projector(this.#canvas.getBoundingClientRect(), this.#viewpoint.camera);
    return project({ x, y, z: this.#height(x, y) });
  }

  #ray(clientX: number, clientY: number): { origin: Vector; direction: Vector } {
    const box = this.#canvas.getBoundingClientRect();
    const at = new Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2);
    const caster = new Raycaster();
    caster.setFromCamera(at, this.#viewpoint.camera);
    return caster.ray;
  }

  #height = (x: number, y: number): number => this.#field?.height(x, y) ?? 0;

  #sensorOf(robot: Pose): Vector {
    return sensorAt(robot, this.#info?.mount);
  }

  #resize(): void {
    const { clientWidth, clientHeight } = this.#canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.#painter.send({ type: 'size', width_px: clientWidth, height_px: clientHeight });
    this.#viewpoint.resize(clientWidth / clientHeight);
    this.#moved = true;
  }

  #loop(): void {
    requestAnimationFrame(() => this.#loop());
    this.#viewpoint.update();
    this.#moveRobot();
    if (this.#waiting.length > 0) this.#viewpoint.settle();
    if (this.#moved) this.#look();
    else this.#rest();
  }

  #look(): void {
    const [robot, field] = [this.#shown, this.#field];
    if (!robot || !field) return;
    this.#moved = false;
    this.#viewpoint.clear(field);
    const { position, quaternion, fov } = this.#viewpoint.camera;
    const look = {
      position: position.toArray(),
      quaternion: quaternion.toArray(),
      fieldOfView_deg: fov,
      robot,
      believed: this.#believed,
      eye: this.#viewpoint.mode === 'eye',
    };
    this.#painter.send({ type: 'look', look });
  }

  #rest(): void {
    const waiting = this.#waiting.splice(0);
    if (waiting.length === 0) return;
    this.#painter.rest().then(() => {
      for (const rested of waiting) rested();
    });
  }

  #moveRobot(): void {
    const now_ms = performance.now();
    const believed = this.#believedGlide.at(now_ms);
    if (believed !== this.#believed) this.#moved = true;
    this.#believed = believed;
    const pose = this.#glide.at(now_ms);
    if (!pose || pose === this.#shown) return;
    this.#shown = pose;
    this.#viewpoint.track(pose, this.#sensorOf(pose));
    this.#moved = true;
  }
}
