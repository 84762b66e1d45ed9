/** What pointer and keyboard do to the ground: drop a goal, drop a start, sculpt. */

import type { Brush, BrushKind, Heading, Place } from '../core/protocol.ts';
import type { Stage } from './stage.ts';

export const TOOLS = ['look', 'goal', 'start', 'raise', 'lower', 'smooth'] as const;
export type Tool = (typeof TOOLS)[number];

export interface ToolActions {
  /** `added`: after the present goal, which is driven to first. */
  setGoal(goal: Place, added: boolean): void;
  setStart(start: Heading): void;
  sculpt(brush: Brush): void;
}

/** Height moved per dab, as a part of the brush's radius. */
const STRENGTH = 0.035;
const SMOOTHING_M = 0.12;
const DAB_INTERVAL_MS = 40;
const CURSOR_STEP_M = 0.5;
/** A start dragged less than this keeps the direction of view as its heading. */
const HEADING_DRAG_M = 0.6;
const LOOK_STEP_RAD = 0.12;

function isBrush(tool: Tool): tool is BrushKind {
  return tool === 'raise' || tool === 'lower' || tool === 'smooth';
}

export class GroundTools {
  readonly #canvas: HTMLCanvasElement;
  readonly #stage: Stage;
  readonly #actions: ToolActions;
  #tool: Tool = 'look';
  #radius_m = 2;
  #adding = false;
  #pointer: number | undefined;
  #touches = 0;
  #pressed: Place | undefined;
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
    this.#cursor = undefined;
    this.#stage.toolInHand(tool !== 'look');
    this.#canvas.dataset.tool = tool;
    this.#ring();
  }

  /** Whether goals are added to the route without the Shift key. */
  adding(adding: boolean): void {
    this.#adding = adding;
  }

  radius(radius_m: number): void {
    this.#radius_m = radius_m;
    this.#ring();
  }

  #down(event: PointerEvent): void {
    this.#canvas.focus({ preventScroll: true });
    if (event.pointerType === 'touch') this.#touches += 1;
    if (this.#touches > 1) {
      // A second finger moves the view instead.
      this.#stop();
      return;
    }
    if (this.#tool === 'look' || event.button !== 0) return;
    const at = this.#stage.pick(event.clientX, event.clientY);
    if (!at) return;
    this.#pointer = event.pointerId;
    this.#canvas.setPointerCapture(event.pointerId);
    this.#pressed = at;
    this.#cursor = at;
    this.#ring();
    if (!isBrush(this.#tool)) return;
    this.#dab();
    // A still pointer keeps on working, like a spray can.
    this.#dabbing = setInterval(() => this.#dab(), DAB_INTERVAL_MS);
  }

  #move(event: PointerEvent): void {
    if (this.#tool === 'look') return;
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
    if (this.#tool === 'goal') {
      this.#actions.setGoal({ x: cursor.x, y: cursor.y }, this.#adding || event.shiftKey);
    }
    if (this.#tool === 'start') {
      const [east, north] = [cursor.x - pressed.x, cursor.y - pressed.y];
      const dragged = Math.hypot(east, north) > HEADING_DRAG_M;
      const heading_rad = dragged ? Math.atan2(north, east) : this.#stage.viewHeading_rad;
      this.#actions.setStart({ x: pressed.x, y: pressed.y, heading_rad });
    }
    if (event.pointerType === 'touch') this.#hideCursor();
  }

  #key(event: KeyboardEvent): void {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (this.#tool === 'look') {
      if (step) this.#stage.nudge(-(step[0] ?? 0) * LOOK_STEP_RAD, (step[1] ?? 0) * LOOK_STEP_RAD, 1);
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
    const heading = this.#stage.viewHeading_rad;
    const length_m = CURSOR_STEP_M * steps;
    const x = from.x + length_m * (ahead * Math.cos(heading) + right * Math.sin(heading));
    const y = from.y + length_m * (ahead * Math.sin(heading) - right * Math.cos(heading));
    if (field.contains(x, y)) this.#cursor = { x, y };
    this.#ring();
  }

  #apply(shifted: boolean): void {
    const at = this.#cursor ?? this.#stage.robot;
    if (!at) return;
    if (this.#tool === 'goal') this.#actions.setGoal({ x: at.x, y: at.y }, this.#adding || shifted);
    else if (this.#tool === 'start') {
      this.#actions.setStart({ x: at.x, y: at.y, heading_rad: this.#stage.viewHeading_rad });
    } else {
      this.#cursor = at;
      this.#dab();
    }
  }

  #dab(): void {
    if (!this.#cursor || !isBrush(this.#tool)) return;
    this.#lastDab_ms = performance.now();
    const strength_m = this.#tool === 'smooth' ? SMOOTHING_M : STRENGTH * this.#radius_m;
    const { x, y } = this.#cursor;
    this.#actions.sculpt({ x, y, radius_m: this.#radius_m, strength_m, kind: this.#tool });
  }

  #stop(): void {
    clearInterval(this.#dabbing);
    this.#dabbing = undefined;
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
    const radius_m = this.#tool === 'look' || !at ? 0 : isBrush(this.#tool) ? this.#radius_m : 0.5;
    this.#stage.brush(at?.x ?? 0, at?.y ?? 0, radius_m);
  }
}
