/**
 * The unfolded variance image, the paper's way to see what the robot sees: azimuth across with the robot's left on the
 * left, elevation up, dark where ground was observed and light where space is free, with the skyline, its segments and
 * the subgoals upon them. Pointing at it, or stepping through it with the arrow keys, names what is there.
 */

import { wrap } from '../base/format.ts';
import { ramp } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import { type Finder, segmentAt, subgoalTarget, type Target } from '../scene/selection.ts';
import {
  drawColumns,
  drawGoal,
  drawMarkedSegment,
  drawMarkedSubgoal,
  drawProfile,
  drawSegments,
  drawSubgoals,
} from './imageMarks.ts';
import { drawAxes, drawScale, hatching, layout, type Plot } from './imagePlot.ts';
import { rowOf, TOP_RAD } from './lattice.ts';

/** What somebody looks at in place of what the planner sees. */
export interface ImageInstead {
  /** From 0, dark, to 1, light, as `FrameBuffers.variance`. */
  readonly values: Float32Array;
  /** The skyline that belongs to it, if one does. */
  readonly profile: Float32Array | undefined;
}

/** Draws over the image. */
export type DrawOver = (context: CanvasRenderingContext2D, plot: Plot, theme: Theme) => void;

/** The variance is kept with this many steps, enough to draw it anew in other colours. */
const STEPS = 256;

export class VarianceImage {
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D;
  readonly #pixels = document.createElement('canvas');
  #image: ImageData | undefined;
  #steps = new Uint8Array();
  #theme: Theme;
  #info: SessionInfo | undefined;
  #frame: Frame | undefined;
  #target: Target | undefined;
  #hatch: CanvasPattern | null = null;
  #instead: ImageInstead | undefined;
  #over: DrawOver | undefined;
  #drawn: (plot: Plot) => void = () => undefined;
  #waiting = false;

  constructor(canvas: HTMLCanvasElement, theme: Theme) {
    const context = canvas.getContext('2d');
    if (!context) throw new Error('This browser cannot draw on a canvas.');
    this.#canvas = canvas;
    this.#context = context;
    this.#theme = theme;
    this.theme(theme);
    new ResizeObserver(() => this.#draw()).observe(canvas);
  }

  theme(theme: Theme): void {
    this.#theme = theme;
    this.#hatch = this.#context.createPattern(hatching(theme.muted), 'repeat');
    this.#paintPixels();
    this.#invalidate();
  }

  session(info: SessionInfo): void {
    this.#info = info;
    const { columns, rows } = info.image;
    if (this.#steps.length === columns * rows) return;
    this.#pixels.width = columns;
    this.#pixels.height = rows;
    this.#image = new ImageData(columns, rows);
    this.#steps = new Uint8Array(columns * rows).fill(STEPS - 1);
  }

  show(frame: Frame): void {
    this.#frame = frame;
    if (frame.surfaces && !this.#instead) this.#take(frame.buffers.variance);
    this.#invalidate();
  }

  /** Shows something else in place of the planner's variance, or that again. */
  showInstead(instead: ImageInstead | undefined): void {
    if (!instead && !this.#instead) return;
    this.#instead = instead;
    const values = instead?.values ?? this.#frame?.buffers.variance;
    if (values) this.#take(values);
    this.#invalidate();
  }

  /** Draws this over the image from now on. */
  drawOver(over: DrawOver | undefined): void {
    this.#over = over;
    this.#invalidate();
  }

  /** Is told where things are whenever the image is drawn. */
  onDrawn(drawn: (plot: Plot) => void): void {
    this.#drawn = drawn;
    this.#invalidate();
  }

  /** Draws again: what is drawn over it has changed. */
  again(): void {
    this.#invalidate();
  }

  #take(values: Float32Array): void {
    values.forEach((value, index) => {
      this.#steps[index] = Math.min(Math.max(value, 0), 1) * (STEPS - 1);
    });
    this.#paintPixels();
  }

  /** Marks what somebody points at. */
  mark(target: Target | undefined): void {
    if (target === this.#target) return;
    this.#target = target;
    this.#invalidate();
  }

  /** How to find the subgoal, or else the segment, under a place of the window; a subgoal within so many pixels. */
  pointedAt(clientX: number, clientY: number, within_px: number): Finder | undefined {
    const box = this.#canvas.getBoundingClientRect();
    const plot = layout(this.#canvas.clientWidth, this.#canvas.clientHeight);
    const [x, y] = [clientX - box.left, clientY - box.top];
    if (x < plot.left || x > plot.left + plot.width || y < 0 || y > this.#canvas.clientHeight) return undefined;
    return (frame) => {
      let [best, nearest_px] = [-1, within_px];
      frame.subgoals.forEach((one, index) => {
        const px = Math.hypot(plot.x(wrap(one.azimuth_rad)) - x, plot.mark(one.elevation_rad, 6).y - y);
        if (px < nearest_px) [best, nearest_px] = [index, px];
      });
      return subgoalTarget(frame, best) ?? { subgoal: undefined, segment: segmentAt(frame, plot.azimuth_rad(x)) };
    };
  }

  /** The direction under a place of the canvas: its azimuth, and its row of the image. */
  directionAt(x: number, y: number): { azimuth_rad: number; row: number } | undefined {
    const plot = layout(this.#canvas.clientWidth, this.#canvas.clientHeight);
    if (x < plot.left || x > plot.left + plot.width || y < plot.top || y > plot.top + plot.height) return undefined;
    const elevation_rad = TOP_RAD * (1 - (2 * (y - plot.top)) / plot.height);
    return { azimuth_rad: plot.azimuth_rad(x), row: rowOf(elevation_rad, this.#pixels.height) };
  }

  #paintPixels(): void {
    const image = this.#image;
    if (!image) return;
    const { width: columns, height: rows } = image;
    const colours = Array.from({ length: STEPS }, (_, step) => ramp(this.#theme.variance, step / (STEPS - 1)));
    const palette = new Uint32Array(
      colours.map(([red, green, blue]) => (255 << 24) | (blue << 16) | (green << 8) | red),
    );
    const pixels = new Uint32Array(image.data.buffer);
    for (let column = 0; column < columns; column += 1) {
      for (let row = 0; row < rows; row += 1) {
        // Column 0 looks backwards on the right; row 0 is the lowest beam.
        const at = (rows - 1 - row) * columns + (columns - 1 - column);
        pixels[at] = palette[this.#steps[column * rows + row] ?? 0] ?? 0;
      }
    }
    this.#pixels.getContext('2d')?.putImageData(image, 0, 0);
  }

  /** Draws with the next picture, once however much changes until then. */
  #invalidate(): void {
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame(() => {
      this.#waiting = false;
      this.#draw();
    });
  }

  #draw(): void {
    const ratio = window.devicePixelRatio;
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (width === 0 || height === 0) return;
    if (this.#canvas.width !== Math.round(width * ratio)) this.#canvas.width = Math.round(width * ratio);
    if (this.#canvas.height !== Math.round(height * ratio)) this.#canvas.height = Math.round(height * ratio);
    const context = this.#context;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const [frame, info, theme] = [this.#frame, this.#info, this.#theme];
    if (!frame || !info) return;
    const plot = layout(width, height);
    context.save();
    context.beginPath();
    context.rect(plot.left, plot.top, plot.width, plot.height);
    context.clip();
    context.imageSmoothingEnabled = true;
    context.imageSmoothingQuality = 'high';
    this.#drawPixels(plot);
    drawColumns(context, plot, frame.buffers.kinds, theme, this.#hatch);
    const { profile, former, truth } = frame.buffers;
    drawProfile(context, plot, truth, theme, 'true');
    drawProfile(context, plot, this.#instead?.profile ? profile : former, theme, 'former');
    drawProfile(context, plot, this.#instead?.profile ?? profile, theme);
    drawSegments(context, plot, frame.segments, theme);
    if (this.#target) drawMarkedSegment(context, plot, frame, this.#target, theme);
    context.restore();
    drawAxes(context, plot, theme);
    if (plot.detailed) drawScale(context, plot, frame.threshold, theme);
    const { goal } = info;
    const { pose } = frame;
    drawGoal(context, plot, Math.atan2(goal.y - pose.y, goal.x - pose.x) - pose.yaw, theme);
    drawSubgoals(context, plot, frame.subgoals, theme);
    if (this.#target) drawMarkedSubgoal(context, plot, frame, this.#target, theme);
    this.#over?.(context, plot, theme);
    this.#drawn(plot);
  }

  /** Rows and columns are centred on their angles: half of each outermost one lies beyond the plot, or on its other side. */
  #drawPixels(plot: Plot): void {
    const { width: columns, height: rows } = this.#pixels;
    const column = plot.width / columns;
    const row = plot.height / (rows - 1);
    for (const left of [plot.left + column / 2, plot.left + column / 2 - plot.width]) {
      this.#context.drawImage(this.#pixels, left, plot.top - row / 2, plot.width, plot.height + row);
    }
  }
}

/** The subgoal or the segment beside another one, from the robot's left to its right; after none, the chosen or the first. */
export function neighbour(frame: Frame, from: Target | undefined, by: 1 | -1, segments: boolean): Target | undefined {
  const azimuths_rad = segments
    ? frame.segments.map(({ begin_rad, end_rad }) => wrap((begin_rad + end_rad) / 2))
    : frame.subgoals.map(({ azimuth_rad }) => wrap(azimuth_rad));
  const order = azimuths_rad.map((_, index) => index);
  order.sort((a, b) => (azimuths_rad[b] ?? 0) - (azimuths_rad[a] ?? 0));
  const current = segments ? from?.segment : from?.subgoal;
  const chosen = segments ? 0 : order.findIndex((index) => frame.subgoals[index]?.chosen);
  const place = current === undefined ? Math.max(chosen, 0) : order.indexOf(current) + by;
  const index = order[(place + order.length) % order.length];
  if (index === undefined) return undefined;
  return segments ? { subgoal: undefined, segment: index } : subgoalTarget(frame, index);
}
