/** What pointer and keyboard do to objects: place one, take one in hand, move, turn, size and delete it. */

import {
  endsOf,
  isDrawn,
  makeObject,
  moved,
  objectName,
  type PaletteKind,
  placeOf,
  resized,
  sizeWords,
  turned,
  type WorldObject,
  withEnd,
} from '../experiment/objects.ts';
import type { Place } from '../experiment/place.ts';
import { acrossScreen } from './acrossScreen.ts';
import type { Stage } from './stage.ts';

export type ChangeObjects = (objects: readonly WorldObject[]) => readonly WorldObject[];

export interface ObjectActions {
  /** Resolves once the objects are changed, or the reason why not is shown. */
  setObjects(change: ChangeObjects): Promise<void>;
  /** Somebody pressed with the tool in hand, on the ground or beside it. */
  pressed(onGround: boolean): void;
  /** Another object is in hand, or there are others. */
  changed(objects: readonly WorldObject[], held: number | undefined): void;
  /** What became of an object, for those who do not see it. */
  say(words: string): void;
}

/** What the pointer that is down is doing. */
type Gesture =
  /** Draws a wall or a way from here, or places where it was pressed. */
  | { readonly kind: 'place'; readonly from: Place }
  /** Moves the object in hand: its middle was so many pixels from the pointer. */
  | { readonly kind: 'move'; readonly middle: Place; readonly off_px: { readonly x: number; readonly y: number } }
  | { readonly kind: 'end'; readonly end: number };

const CURSOR_STEP_M = 0.5;
const MOVE_STEP_M = 0.25;
const TURN_STEP_RAD = Math.PI / 12;
const GROWTH = 1.15;
/** A drag shorter than this was a press. */
const DRAG_PX = 8;
/** What is drawn is no shorter than this. */
const SHORTEST_M = 0.5;
/** A finger is less exact than a mouse. */
const NEAR_PX = { mouse: 5, touch: 22 };
const RING_M = { point: 0.5, end: 0.3 };

export class ObjectTool {
  readonly #canvas: HTMLCanvasElement;
  readonly #stage: Stage;
  readonly #actions: ObjectActions;
  #inHand = false;
  #kind: PaletteKind = 'post';
  #objects: readonly WorldObject[] = [];
  #held: number | undefined;
  #gesture: Gesture | undefined;
  #pointer: number | undefined;
  #touches = 0;
  #pressed_px = { x: 0, y: 0 };
  /** Whether the pointer that is down has moved. */
  #dragged = false;
  #cursor: Place | undefined;
  /** Where a wall or a way began that waits for its end, by keyboard. */
  #anchor: Place | undefined;

  constructor(canvas: HTMLCanvasElement, stage: Stage, actions: ObjectActions) {
    this.#canvas = canvas;
    this.#stage = stage;
    this.#actions = actions;
    canvas.addEventListener('pointerdown', (event) => this.#down(event));
    canvas.addEventListener('pointermove', (event) => this.#move(event));
    canvas.addEventListener('pointerup', (event) => this.#up(event, true));
    canvas.addEventListener('pointercancel', (event) => this.#up(event, false));
    canvas.addEventListener('pointerleave', () => this.#hideCursor());
    canvas.addEventListener('keydown', (event) => this.#key(event));
    canvas.addEventListener('blur', () => this.#hideCursor());
  }

  /** Whether this is the tool in hand. */
  select(inHand: boolean): void {
    if (inHand === this.#inHand) return;
    this.#inHand = inHand;
    this.#drop();
    this.#cursor = undefined;
    this.hold(undefined);
  }

  /** What is placed next. */
  kind(kind: PaletteKind): void {
    this.#kind = kind;
    this.#anchor = undefined;
  }

  /** What is on the ground now. */
  show(objects: readonly WorldObject[]): void {
    const fewer = objects.length < this.#objects.length;
    this.#objects = objects;
    if (fewer && this.#held !== undefined) this.hold(undefined);
    else this.#actions.changed(objects, this.#held);
  }

  /** Takes an object in hand, or none. */
  hold(object: number | undefined): void {
    this.#held = object;
    this.#stage.held(object);
    this.#actions.changed(this.#objects, object);
    this.#ring();
  }

  turn(times: number): void {
    this.#alter((object) => turned(object, times * TURN_STEP_RAD));
  }

  grow(times: number): void {
    this.#alter((object) => resized(object, GROWTH ** times));
  }

  remove(): void {
    const held = this.#held;
    const gone = held === undefined ? undefined : this.#objects[held];
    if (held === undefined || !gone) return;
    this.hold(undefined);
    this.#actions.say(`${objectName(gone, held)} deleted`);
    this.#actions.setObjects((objects) => objects.filter((_, index) => index !== held));
  }

  #down(event: PointerEvent): void {
    if (event.pointerType === 'touch') this.#touches += 1;
    if (!this.#inHand || event.button !== 0) return;
    if (this.#touches > 1) {
      // A second finger moves the view instead.
      this.#drop();
      return;
    }
    const near_px = NEAR_PX[event.pointerType === 'touch' ? 'touch' : 'mouse'];
    const at = this.#stage.pick(event.clientX, event.clientY);
    const gesture = this.#gestureAt(event, near_px, at);
    this.#actions.pressed(gesture !== undefined);
    if (!gesture) return;
    this.#gesture = gesture;
    this.#pointer = event.pointerId;
    this.#canvas.setPointerCapture(event.pointerId);
    this.#pressed_px = { x: event.clientX, y: event.clientY };
    this.#dragged = false;
    this.#cursor = at;
    this.#ring();
  }

  #gestureAt({ clientX, clientY }: PointerEvent, near_px: number, at: Place | undefined): Gesture | undefined {
    const held = this.#held === undefined ? undefined : this.#objects[this.#held];
    const end = endsOf_px(held, this.#stage).findIndex(
      (px) => px && Math.hypot(px.x - clientX, px.y - clientY) < near_px + DRAG_PX,
    );
    if (end >= 0) return { kind: 'end', end };
    const object = this.#stage.objectAt(clientX, clientY, near_px);
    if (object === undefined) return at && { kind: 'place', from: at };
    this.hold(object);
    const middle = this.#stage.middleOf(object);
    const px = middle && this.#stage.project(middle);
    return middle && px && { kind: 'move', middle, off_px: { x: px.x - clientX, y: px.y - clientY } };
  }

  #move(event: PointerEvent): void {
    if (!this.#inHand || (this.#pointer !== undefined && event.pointerId !== this.#pointer)) return;
    const { clientX, clientY } = event;
    const { x, y } = this.#pressed_px;
    this.#dragged ||= this.#pointer !== undefined && Math.hypot(clientX - x, clientY - y) > DRAG_PX;
    const off_px = this.#gesture?.kind === 'move' ? this.#gesture.off_px : { x: 0, y: 0 };
    const at = this.#stage.pick(clientX + off_px.x, clientY + off_px.y);
    if (at) this.#cursor = at;
    if (this.#dragged && this.#gesture?.kind === 'move') this.#stage.held(this.#held, this.#moved(this.#gesture));
    const over = this.#pointer === undefined && this.#stage.objectAt(clientX, clientY, NEAR_PX.mouse) !== undefined;
    this.#canvas.classList.toggle('is-over', over);
    if (over) this.#cursor = undefined;
    this.#ring();
  }

  #moved({ middle }: Gesture & { kind: 'move' }): Place {
    const to = this.#cursor ?? middle;
    return { x: to.x - middle.x, y: to.y - middle.y };
  }

  #up(event: PointerEvent, done: boolean): void {
    if (event.pointerType === 'touch') this.#touches = Math.max(0, this.#touches - 1);
    if (event.pointerId !== this.#pointer) return;
    const [gesture, cursor, dragged] = [this.#gesture, this.#cursor, this.#dragged];
    this.#pointer = undefined;
    this.#gesture = undefined;
    if (!done) this.#stage.held(this.#held);
    else if (gesture?.kind === 'place') this.#place(gesture.from, dragged ? cursor : undefined);
    else if (gesture?.kind === 'move' && dragged) {
      const by = this.#moved(gesture);
      this.#alter((object) => moved(object, by));
    } else if (gesture?.kind === 'end' && dragged && cursor) {
      this.#alter((object) => withEnd(object, gesture.end, cursor));
    }
    if (event.pointerType === 'touch') this.#cursor = undefined;
    this.#ring();
  }

  #key(event: KeyboardEvent): void {
    if (!this.#inHand || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (step) this.#step(step[0] ?? 0, step[1] ?? 0, event.shiftKey ? 5 : 1);
    else if (event.key === 'Enter') this.#apply();
    else if (!this.#act(event.key)) return;
    event.preventDefault();
  }

  /** What a key does to the object in hand, or to what is being drawn; says whether there is such a thing. */
  #act(key: string): boolean {
    if (key === 'Escape' && this.#anchor) {
      this.#anchor = undefined;
      this.#ring();
      return true;
    }
    if (this.#held === undefined) return false;
    if (key === 'r') this.turn(1);
    else if (key === 'R') this.turn(-1);
    else if (key === '+' || key === '=') this.grow(1);
    else if (key === '-') this.grow(-1);
    else if (key === 'Delete' || key === 'Backspace') this.remove();
    else if (key === 'Escape') this.hold(undefined);
    else return false;
    return true;
  }

  /** Moves the object in hand, or else the cursor, over the screen. */
  #step(right: number, ahead: number, steps: number): void {
    const heading_rad = this.#stage.viewHeading_rad;
    if (this.#held !== undefined) {
      const by = acrossScreen(heading_rad, right * steps * MOVE_STEP_M, ahead * steps * MOVE_STEP_M);
      this.#alter((object) => moved(object, by));
      return;
    }
    const from = this.#cursor ?? this.#stage.robot;
    if (!from) return;
    const by = acrossScreen(heading_rad, right * steps * CURSOR_STEP_M, ahead * steps * CURSOR_STEP_M);
    const to = { x: from.x + by.x, y: from.y + by.y };
    if (this.#stage.field?.contains(to.x, to.y)) this.#cursor = to;
    this.#ring();
  }

  /** Enter: puts the object in hand down, takes the one at the cursor, or places one. */
  #apply(): void {
    const at = this.#cursor ?? this.#stage.robot;
    if (this.#held !== undefined) {
      const held = this.#objects[this.#held];
      this.#cursor = held && placeOf(held);
      this.hold(undefined);
      return;
    }
    if (!at) return;
    const px = this.#stage.project(at);
    const object = this.#anchor || !px ? undefined : this.#stage.objectAt(px.x, px.y, NEAR_PX.mouse);
    if (object !== undefined) this.hold(object);
    else if (isDrawn(this.#kind) && !this.#anchor) {
      this.#anchor = at;
      this.#actions.say('Move to its other end, then press Enter');
    } else {
      const from = this.#anchor ?? at;
      this.#anchor = undefined;
      this.#place(from, at);
    }
    this.#ring();
  }

  #place(from: Place, to: Place | undefined): void {
    const { robot } = this.#stage;
    const heading_rad = robot ? Math.atan2(from.y - robot.y, from.x - robot.x) : 0;
    const end = to && Math.hypot(to.x - from.x, to.y - from.y) >= SHORTEST_M ? to : undefined;
    const made = makeObject(this.#kind, from, heading_rad, end);
    this.#set((objects) => {
      this.#held = objects.length;
      return [...objects, made];
    }, 'placed');
  }

  #alter(change: (object: WorldObject) => WorldObject): void {
    const held = this.#held;
    if (held === undefined) return;
    this.#set((objects) => objects.map((object, index) => (index === held ? change(object) : object)), 'is now');
  }

  #set(change: ChangeObjects, what: string): void {
    this.#actions.setObjects(change).then(() => {
      const held = this.#held;
      const object = held === undefined ? undefined : this.#objects[held];
      this.hold(object ? held : undefined);
      if (held === undefined || !object) return;
      const { x, y } = placeOf(object);
      const place = `${x.toFixed(1)} m east, ${y.toFixed(1)} m north`;
      this.#actions.say(`${objectName(object, held)} ${what} at ${place}, ${sizeWords(object)}`);
    });
  }

  #drop(): void {
    this.#pointer = undefined;
    this.#gesture = undefined;
    this.#anchor = undefined;
    this.#canvas.classList.remove('is-over');
    if (this.#held !== undefined) this.#stage.held(this.#held);
  }

  #hideCursor(): void {
    if (!this.#inHand || this.#pointer !== undefined) return;
    this.#cursor = undefined;
    this.#ring();
  }

  /** Where something would be placed, or the line that is being drawn. */
  #ring(): void {
    const [at, gesture] = [this.#cursor, this.#gesture];
    const held = this.#held === undefined ? undefined : this.#objects[this.#held];
    const drawn = gesture?.kind === 'place' && isDrawn(this.#kind) ? gesture.from : this.#anchor;
    const stays = gesture?.kind === 'end' && held ? otherEnd(held, gesture.end) : undefined;
    const from = drawn ?? stays;
    const hidden = !this.#inHand || !at || gesture?.kind === 'move';
    const radius_m = hidden ? 0 : from ? RING_M.end : RING_M.point;
    this.#stage.brush(at ?? { x: 0, y: 0 }, from ?? at ?? { x: 0, y: 0 }, radius_m);
  }
}

/** Where in the window the ends are that can be dragged. */
function endsOf_px(object: WorldObject | undefined, stage: Stage) {
  return object ? endsOf(object).map((end) => stage.project(end)) : [];
}

/** The place that stays while an end is dragged. */
function otherEnd(object: WorldObject, end: number): Place | undefined {
  return object.kind === 'wall' ? endsOf(object)[1 - end] : placeOf(object);
}
