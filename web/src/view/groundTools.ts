/** What pointer and keyboard do to the ground: drop a goal, drop a start, sculpt. */

import type { Brush } from '../editor/strokeInHand.ts';
import type { Goal, Heading, Place } from '../experiment/place.ts';
import { BRUSHES, type BrushName, strength_m } from '../ground/brushes.ts';
import { acrossScreen } from './acrossScreen.ts';
import type { Stage } from './stage.ts';

export const TOOLS = [
  'look',
  'goal',
  'start',
  'raise',
  'lower',
  'smooth',
  'flatten',
  'height',
  'ramp',
  'roughen',
  'crater',
  'ditch',
  'boulder',
  'objects',
] as const;
export type Tool = (typeof TOOLS)[number];

/** How the brush is set. */
export interface BrushSetting {
  readonly radius_m: number;
  /** From 0 to 1. */
  readonly strength: number;
  /** Where the ground is to be with the tool for a set height. */
  readonly height_m: number;
}

export interface ToolActions {
  setGoal(goal: Goal): void;
  /** A waypoint before the goal, after the others. */
  addWaypoint(place: Place): void;
  setStart(start: Heading): void;
  /** Somebody pressed with a tool in hand, on the ground or beside it. */
  pressed(onGround: boolean): void;
  /** By shares of the distance to what is looked at. */
  moveView(right: number, ahead: number): void;
  /** Begins a stroke, which hears of its touches and its end. */
  stroke(brush: Brush): { touch(place: Place): void; end(): void };
}

const DAB_INTERVAL_MS = 40;
const CURSOR_STEP_M = 0.5;
/** A ramp or ditch dragged less than this was a slip. */
const SHORTEST_LINE_M = 0.3;
/** A goal or a start dragged less than this, over the ground or on the screen, was pressed: that sets no heading. */
const HEADING_DRAG_M = 0.6;
const HEADING_DRAG_PX = 14;
const LOOK_STEP_RAD = 0.12;
/** In shares of the distance to what is looked at. */
const MOVE_STEP = 0.08;

export function isBrush(tool: Tool): tool is BrushName {
  return tool in BRUSHES;
}

export class GroundTools {
  readonly #canvas: HTMLCanvasElement;
  readonly #stage: Stage;
  readonly #actions: ToolActions;
  #tool: Tool = 'look';
  #adding = false;
  #brush: BrushSetting = { radius_m: 2, strength: 0.35, height_m: 0 };
  #stroke: ReturnType<ToolActions['stroke']> | undefined;
  /** Where a line began that waits for its end, by keyboard. */
  #anchor: Place | undefined;
  #pointer: number | undefined;
  #touches = 0;
  #pressed: Place | undefined;
  #pressed_px = { x: 0, y: 0 };
  #cursor: Place | undefined;
  #lastDab_ms = 0;
  #dabbing: ReturnType<typeof setInterval> | undefined;

  constructor(canvas: HTMLCanvasElement, stage: Stage, actions: ToolActions) {
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
    this.select('look');
  }

  select(tool: Tool): void {
    this.#tool = tool;
    this.#stop();
    this.#anchor = undefined;
    this.#cursor = undefined;
    this.#stage.toolInHand(tool !== 'look');
    this.#canvas.dataset.tool = tool;
    this.#ring();
  }

  /** Whether the goal's tool adds waypoints, also without the Shift key. */
  addWaypoints(adding: boolean): void {
    this.#adding = adding;
  }

  brush(setting: BrushSetting): void {
    this.#brush = setting;
    this.#ring();
  }

  /** Whether the pointer is another one's: of the camera, or of the tool for objects. */
  get #idle(): boolean {
    return this.#tool === 'look' || this.#tool === 'objects';
  }

  #down(event: PointerEvent): void {
    this.#canvas.focus({ preventScroll: true });
    if (event.pointerType === 'touch') this.#touches += 1;
    if (this.#touches > 1) {
      // A second finger moves the view instead.
      this.#stop();
      return;
    }
    if (this.#idle || event.button !== 0) return;
    const at = this.#stage.pick(event.clientX, event.clientY);
    this.#actions.pressed(at !== undefined);
    if (!at) return;
    this.#pointer = event.pointerId;
    this.#canvas.setPointerCapture(event.pointerId);
    this.#pressed = at;
    this.#pressed_px = { x: event.clientX, y: event.clientY };
    this.#cursor = at;
    this.#ring();
    if (!isBrush(this.#tool)) return;
    const { gesture } = BRUSHES[this.#tool];
    if (gesture === 'line') return;
    this.#stroke = this.#begin(this.#tool, at);
    this.#stage.pickAsBefore(true);
    this.#dab();
    // A still pointer keeps on working, like a spray can.
    if (gesture === 'spray') this.#dabbing = setInterval(() => this.#dab(), DAB_INTERVAL_MS);
  }

  #move(event: PointerEvent): void {
    if (this.#idle) return;
    if (this.#pointer !== undefined && event.pointerId !== this.#pointer) return;
    const at = this.#stage.pick(event.clientX, event.clientY);
    if (!at) return;
    this.#cursor = at;
    this.#ring();
    if (this.#dabbing !== undefined && performance.now() - this.#lastDab_ms >= DAB_INTERVAL_MS) this.#dab();
  }

  #up(event: PointerEvent, done: boolean): void {
    if (event.pointerType === 'touch') this.#touches = Math.max(0, this.#touches - 1);
    if (event.pointerId !== this.#pointer) return;
    const [pressed, cursor] = [this.#pressed, this.#cursor];
    this.#stop();
    if (!done || !pressed || !cursor) return;
    if (isBrush(this.#tool)) this.#line(this.#tool, pressed, cursor);
    const heading_rad = this.#dragged_rad(event, pressed, cursor);
    if (this.#tool === 'goal') this.#drivesTo(pressed, heading_rad, event.shiftKey);
    if (this.#tool === 'start') this.#startsAt(pressed, heading_rad);
    if (event.pointerType === 'touch') this.#hideCursor();
  }

  /** Which way the pointer was dragged over the ground, unless it was hardly moved. */
  #dragged_rad({ clientX, clientY }: PointerEvent, from: Place, to: Place): number | undefined {
    const [east, north] = [to.x - from.x, to.y - from.y];
    const { x, y } = this.#pressed_px;
    const moved = Math.hypot(east, north) > HEADING_DRAG_M && Math.hypot(clientX - x, clientY - y) > HEADING_DRAG_PX;
    return moved ? Math.atan2(north, east) : undefined;
  }

  /** Without a heading the robot may face any way at the goal. */
  #drivesTo({ x, y }: Place, heading_rad: number | undefined, shifted: boolean): void {
    if (this.#adding || shifted) this.#actions.addWaypoint({ x, y });
    else this.#actions.setGoal(heading_rad === undefined ? { x, y } : { x, y, heading_rad });
  }

  /** Without a heading the robot faces where the view looks. */
  #startsAt({ x, y }: Place, heading_rad = this.#stage.viewHeading_rad): void {
    this.#actions.setStart({ x, y, heading_rad });
  }

  #key(event: KeyboardEvent): void {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || this.#tool === 'objects') return;
    if (this.#tool === 'look') {
      if (step && event.shiftKey) this.#actions.moveView(MOVE_STEP * (step[0] ?? 0), MOVE_STEP * (step[1] ?? 0));
      else if (step) this.#stage.nudge(-(step[0] ?? 0) * LOOK_STEP_RAD, (step[1] ?? 0) * LOOK_STEP_RAD, 1);
      else if (event.key === '+' || event.key === '=') this.#stage.nudge(0, 0, 0.88);
      else if (event.key === '-') this.#stage.nudge(0, 0, 1.14);
      else return;
      event.preventDefault();
      return;
    }
    if (step) this.#moveCursor(step[0] ?? 0, step[1] ?? 0, event.shiftKey ? 5 : 1);
    else if (event.key === 'Enter') this.#apply(event.shiftKey);
    else return;
    event.preventDefault();
  }

  /** Steps the cursor across the screen's directions, whichever way the camera looks. */
  #moveCursor(right: number, ahead: number, steps: number): void {
    const field = this.#stage.field;
    const from = this.#cursor ?? this.#stage.robot;
    if (!field || !from) return;
    const length_m = CURSOR_STEP_M * steps;
    const by = acrossScreen(this.#stage.viewHeading_rad, right * length_m, ahead * length_m);
    const to = { x: from.x + by.x, y: from.y + by.y };
    if (field.contains(to.x, to.y)) this.#cursor = to;
    this.#ring();
  }

  #apply(shifted: boolean): void {
    const at = this.#cursor ?? this.#stage.robot;
    if (!at) return;
    if (this.#tool === 'goal') this.#drivesTo(at, undefined, shifted);
    else if (this.#tool === 'start') this.#startsAt(at);
    else if (isBrush(this.#tool)) {
      this.#cursor = at;
      this.#applyBrush(this.#tool, at);
    }
  }

  /** Enter: a touch, or the begin and then the end of a line. */
  #applyBrush(tool: BrushName, at: Place): void {
    if (BRUSHES[tool].gesture !== 'line') {
      const stroke = this.#begin(tool, at);
      stroke.touch(at);
      stroke.end();
    } else if (this.#anchor) {
      this.#line(tool, this.#anchor, at);
      this.#anchor = undefined;
    } else {
      this.#anchor = at;
    }
    this.#ring();
  }

  #begin(tool: BrushName, at: Place): ReturnType<ToolActions['stroke']> {
    const { radius_m, strength, height_m } = this.#brush;
    const { kind } = BRUSHES[tool];
    const under_m = Math.round(100 * (this.#stage.field?.height(at.x, at.y) ?? 0)) / 100;
    return this.#actions.stroke({
      kind,
      radius_m,
      strength_m: strength_m(tool, radius_m, strength),
      ...(kind === 'level' ? { height_m: tool === 'height' ? height_m : under_m } : {}),
      // Each stroke roughens in its own way.
      ...(kind === 'roughen' ? { seed: Math.floor(Math.random() * 1e6) } : {}),
    });
  }

  /** A ramp or a ditch, unless it has no length. */
  #line(tool: BrushName, from: Place, to: Place): void {
    if (BRUSHES[tool].gesture !== 'line' || Math.hypot(to.x - from.x, to.y - from.y) < SHORTEST_LINE_M) return;
    const stroke = this.#begin(tool, from);
    stroke.touch(from);
    stroke.touch(to);
    stroke.end();
  }

  #dab(): void {
    if (!this.#cursor || !this.#stroke) return;
    this.#lastDab_ms = performance.now();
    this.#stroke.touch(this.#cursor);
  }

  #stop(): void {
    clearInterval(this.#dabbing);
    this.#dabbing = undefined;
    this.#stroke?.end();
    this.#stroke = undefined;
    this.#stage.pickAsBefore(false);
    this.#pointer = undefined;
    this.#pressed = undefined;
  }

  #hideCursor(): void {
    if (this.#pointer !== undefined) return;
    this.#cursor = undefined;
    this.#ring();
  }

  #ring(): void {
    const at = this.#cursor;
    const brush = isBrush(this.#tool) ? BRUSHES[this.#tool] : undefined;
    const turns = this.#tool === 'start' || (this.#tool === 'goal' && !this.#adding);
    const from = this.#anchor ?? (turns || brush?.gesture === 'line' ? this.#pressed : undefined);
    const radius_m = this.#idle || !at ? 0 : brush ? this.#brush.radius_m : 0.5;
    this.#stage.brush(at ?? { x: 0, y: 0 }, from ?? at ?? { x: 0, y: 0 }, radius_m);
  }
}
