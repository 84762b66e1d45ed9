/** Draws the 3D view as it is told to. Draws only when something changed. */

import { AmbientLight, DirectionalLight, Group, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { wrap } from '../base/format.ts';
import type { Theme } from '../colours/theme.ts';
import { HeightField, type PlacedGround } from '../ground/heightField.ts';
import type { GroundPatch, Pose, Solid } from '../protocol/simulationProtocol.ts';
import { type Colouring, FIRST_LAYERS, type Layers } from '../scene/layers.ts';
import { sensorAt } from '../scene/sensor.ts';
import { Believed } from './believed.ts';
import { Ghosts } from './ghosts.ts';
import { Husky } from './husky.ts';
import { Overlays } from './overlays.ts';
import type { Pacer } from './pacer.ts';
import { DEPTH_M, type FromPainter, type Look, type Scenery, type Seen, type ToPainter } from './painterProtocol.ts';
import { Places } from './places.ts';
import { Refusals } from './refusals.ts';
import { Relief } from './relief.ts';
import { Returns } from './returns.ts';
import { Route } from './route.ts';
import { Solids } from './solids.ts';
import { Subgoals } from './subgoals.ts';
import { SUN } from './sunlight.ts';
import { Waypoints } from './waypoints.ts';

/** Triangles of finer grids cost more than they show; a processor draws far fewer of them than a graphics card. */
const GRID_VERTICES = { hardware: 512, software: 160 };
/** What has stood for so long is drawn once more, as finely as the screen shows it. */
const STILL_MS = 400;
/** The part of the run that comes after the time shown. */
const PALE = 0.35;

export class Painter {
  readonly #canvas: OffscreenCanvas;
  readonly #post: (message: FromPainter, transfer?: Transferable[]) => void;
  readonly #pacer: Pacer;
  readonly #renderer: WebGLRenderer;
  readonly #refusals: Refusals;
  readonly #camera = new PerspectiveCamera(50, 1, DEPTH_M.near, DEPTH_M.far);
  readonly #scene = new Scene();
  /** All but the ground and the robot: not in the first picture, which is there sooner without their shaders. */
  readonly #marks = new Group();
  readonly #returns = new Returns();
  readonly #route = new Route();
  readonly #ahead = new Route(PALE);
  readonly #subgoals = new Subgoals();
  readonly #places = new Places();
  readonly #waypoints = new Waypoints();
  readonly #solids = new Solids();
  readonly #ghosts = new Ghosts();
  readonly #believed = new Believed();
  readonly #husky = new Husky();
  readonly #overlays: Overlays;
  readonly #relief: Relief;
  #size_px = { width: 1, height: 1 };
  /** Whether canvas and camera have this size. */
  #fits = false;
  /** Pixels of the last picture for each of the page's, and when it was drawn. */
  #pixelRatio = 0;
  #drawn_ms = 0;
  #scenery: Scenery | undefined;
  #colouring: Colouring = 'elevation';
  /** The robot as it is drawn; nothing until it stands on the present ground. */
  #robot: Pose | undefined;
  readonly #sensor = new Vector3();
  #dirty = true;
  #first: 'to come' | 'under way' | 'drawn' = 'to come';
  #filming = false;
  /** Whether the next picture is to be a fine one, whatever moves. */
  #fine = false;
  /** Who waits until nothing changes. */
  #resting: number[] = [];

  constructor(
    context: WebGL2RenderingContext,
    canvas: OffscreenCanvas,
    theme: Theme,
    pacer: Pacer,
    post: (message: FromPainter, transfer?: Transferable[]) => void,
  ) {
    this.#canvas = canvas;
    this.#post = post;
    const { software } = pacer;
    this.#pacer = pacer;
    this.#renderer = new WebGLRenderer({ canvas, context });
    // It waits for the graphics process three times for each shader program; `Refusals` asks only why one was refused.
    this.#renderer.debug.checkShaderErrors = false;
    this.#refusals = new Refusals(context);
    canvas.addEventListener('webglcontextlost', () => post({ type: 'lost' }));
    canvas.addEventListener('webglcontextrestored', () => {
      post({ type: 'restored' });
      this.#dirty = true;
    });
    this.#relief = new Relief(GRID_VERTICES[software ? 'software' : 'hardware'], theme, () => {
      this.#dirty = true;
    });
    const sun = new DirectionalLight(0xfff3df, 3.2);
    sun.position.set(...SUN);
    this.#overlays = new Overlays(theme, FIRST_LAYERS, this.#height);
    this.#scene.add(new AmbientLight(0xd5e0f2, 2.1), sun);
    this.#scene.add(this.#relief.mesh, this.#husky.group);
    this.#marks.add(this.#ahead.line, this.#waypoints.group, this.#route.line, this.#returns.group);
    this.#marks.add(
      this.#subgoals.group,
      this.#places.group,
      this.#overlays.group,
      this.#ghosts.group,
      this.#believed.group,
      this.#solids.group,
    );
    this.#theme(theme);
    this.#warmUp();
    requestAnimationFrame((now_ms) => this.#loop(now_ms));
  }

  obey(message: Exclude<ToPainter, { type: 'begin' }>): void {
    if (message.type === 'rest') {
      this.#resting.push(message.id);
      return;
    }
    this.#dirty = true;
    switch (message.type) {
      case 'size':
        this.#size_px = { width: message.width_px, height: message.height_px };
        this.#fits = false;
        break;
      case 'theme':
        this.#theme(message.theme);
        break;
      case 'scenery':
        this.#arrange(message.scenery, message.ground);
        break;
      case 'surroundings':
        this.#surround(message.ground);
        break;
      case 'patch':
        this.#sculpt(message.patch, message.solids);
        break;
      case 'seen':
        this.#show(message.seen);
        break;
      case 'look':
        this.#look(message.look);
        break;
      case 'layers':
        this.#layers(message.layers);
        break;
      case 'colouring':
        this.#colouring = message.colouring;
        if (this.#scenery) this.#relief.colouring(message.colouring, this.#scenery.limits);
        break;
      case 'mark':
        this.#overlays.mark(message.target);
        break;
      case 'held':
        this.#solids.hold(message.object, message.by, this.#height);
        break;
      case 'brush':
        this.#relief.brush(message.at, message.from, message.radius_m);
        break;
      case 'ghosts':
        this.#ghosts.set(message.colours, this.#scenery?.mount);
        break;
      case 'ghostSteps':
        this.#ghosts.show(message.steps);
        break;
      case 'film':
        this.#filming = message.wanted;
        this.#fine = message.fine;
        break;
    }
  }

  #height = (x: number, y: number): number => this.#relief.field.height(x, y);

  #theme(theme: Theme): void {
    const marks = [
      this.#returns,
      this.#route,
      this.#ahead,
      this.#subgoals,
      this.#places,
      this.#waypoints,
      this.#solids,
      this.#believed,
    ];
    for (const part of [this.#relief, ...marks, this.#overlays]) part.theme(theme);
  }

  #arrange(scenery: Scenery, ground: PlacedGround | undefined): void {
    this.#husky.mount(scenery.mount);
    this.#believed.mount(scenery.mount);
    this.#scenery = scenery;
    if (ground) {
      this.#relief.ground(new HeightField(ground));
      this.#relief.mesh.visible = true;
      this.#robot = undefined;
      this.#colourByHeight();
    }
    this.#overlays.session(scenery);
    this.#relief.colouring(this.#colouring, scenery.limits);
    this.#places.show(scenery.goal, scenery.start, this.#height);
    this.#waypoints.show(scenery.waypoints, this.#height);
    this.#stand(scenery.solids);
  }

  #surround(ground: PlacedGround): void {
    this.#relief.surroundings(new HeightField(ground));
    this.#colourByHeight();
    this.#places.settle(this.#height);
  }

  #sculpt(patch: GroundPatch, solids: readonly Solid[]): void {
    this.#relief.field.patch(patch);
    this.#relief.sculpted();
    this.#colourByHeight();
    this.#places.settle(this.#height);
    this.#waypoints.settle(this.#height);
    this.#stand(solids);
  }

  /** The shapes of what stands, where it stands now. */
  #stand(solids: readonly Solid[]): void {
    if (this.#scenery) this.#solids.stand(this.#scenery.objects, solids, this.#height);
    this.#relief.solids(solids);
  }

  #colourByHeight(): void {
    const { min_m, max_m } = this.#relief.field;
    this.#returns.heights(min_m, max_m);
  }

  #show(seen: Seen): void {
    if (seen.anew) {
      this.#route.clear();
      this.#ahead.clear();
    }
    if (seen.ahead) this.#ahead.extend(seen.ahead);
    this.#waypoints.passed(seen.waypoints_passed);
    this.#route.extend(seen.trail);
    this.#returns.show(seen, this.#scenery?.occupancy_radius_m ?? 0);
    this.#subgoals.show(seen.subgoals, this.#height);
    this.#overlays.show(seen);
    this.#solids.walk(seen.movers);
  }

  #layers(layers: Layers): void {
    this.#returns.colours(layers.points);
    this.#subgoals.group.visible = layers.subgoals;
    this.#overlays.layers(layers);
  }

  #look({ position, quaternion, fieldOfView_deg, robot, believed, eye }: Look): void {
    this.#camera.position.set(...position);
    this.#camera.quaternion.set(...quaternion);
    if (this.#camera.fov !== fieldOfView_deg) {
      this.#camera.fov = fieldOfView_deg;
      this.#fits = false;
    }
    this.#husky.group.visible = !eye;
    this.#believed.show(eye ? undefined : believed);
    this.#move(robot);
  }

  #move(pose: Pose): void {
    const before = this.#robot;
    this.#robot = pose;
    this.#husky.pose(pose);
    this.#overlays.pose(pose);
    if (before) {
      const [east, north] = [pose.x - before.x, pose.y - before.y];
      this.#husky.roll(east * Math.cos(pose.yaw) + north * Math.sin(pose.yaw), wrap(pose.yaw - before.yaw));
    }
    this.#sensor.copy(sensorAt(pose, this.#scenery?.mount));
    this.#relief.robot(pose.x, pose.y, pose.yaw, this.#scenery?.occupancy_radius_m ?? 0);
  }

  #resize(pixelRatio: number): void {
    const { width, height } = this.#size_px;
    this.#pixelRatio = pixelRatio;
    this.#renderer.setPixelRatio(pixelRatio);
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    // Returns keep a size in metres.
    const heightAtOneMetre = 2 * Math.tan((this.#camera.fov * Math.PI) / 360);
    this.#returns.scale((height * pixelRatio) / heightAtOneMetre, pixelRatio);
    this.#fits = true;
  }

  #loop(now_ms: number): void {
    requestAnimationFrame((next_ms) => this.#loop(next_ms));
    if (this.#first === 'under way') this.#completeFirst();
    const stands = !this.#dirty && !this.#relief.relighting;
    const coarse = this.#robot !== undefined && this.#pixelRatio < this.#pacer.finest;
    if (stands && !coarse) for (const id of this.#resting.splice(0)) this.#post({ type: 'rested', id });
    const sharpen = stands && coarse && (this.#resting.length > 0 || now_ms - this.#drawn_ms > STILL_MS);
    // No picture of the ground without the robot, which comes right after it.
    if (!this.#robot || !this.#pacer.due(now_ms) || !(this.#dirty || sharpen)) return;
    this.#dirty = false;
    this.#drawn_ms = now_ms;
    const pixelRatio = sharpen || this.#fine ? this.#pacer.finest : this.#pacer.pixelRatio;
    this.#fine = false;
    // Only now, as it empties the canvas: until there is another picture, the last one stays.
    if (!this.#fits || pixelRatio !== this.#pixelRatio) this.#resize(pixelRatio);
    const { position } = this.#camera;
    this.#subgoals.attach(this.#sensor, position);
    this.#places.face(position);
    this.#waypoints.face(position);
    this.#renderer.render(this.#scene, this.#camera);
    this.#tellRefusals();
    if (this.#first === 'to come') this.#first = 'under way';
    if (this.#filming) this.#sendPicture();
    // The time that a fine picture takes says nothing of the others.
    if (pixelRatio === this.#pacer.pixelRatio && this.#pacer.drew(now_ms)) this.#dirty = true;
  }

  #tellRefusals(): void {
    for (const why of this.#refusals.among(this.#renderer.info.programs ?? [])) this.#post({ type: 'refused', why });
  }

  /** There is a first picture: the browser has room for another. */
  #completeFirst(): void {
    this.#first = 'drawn';
    this.#post({ type: 'drawn' });
    this.#scene.add(this.#marks);
    this.#dirty = true;
  }

  /** Right after the drawing: later its pixels are gone. */
  async #sendPicture(): Promise<void> {
    const picture = await createImageBitmap(this.#canvas);
    this.#post({ type: 'picture', picture }, [picture]);
  }

  /** Uses the time until there is ground: has the shaders compiled, by a picture without pixels. */
  #warmUp(): void {
    this.#camera.up.set(0, 0, 1);
    this.#camera.position.set(-8, 0, 5);
    this.#camera.lookAt(0, 0, 0);
    this.#renderer.setScissor(0, 0, 0, 0);
    this.#renderer.setScissorTest(true);
    this.#renderer.render(this.#scene, this.#camera);
    this.#renderer.setScissorTest(false);
  }
}
