/**
 * The unfolded variance image, the paper's way to see what the robot sees: azimuth across with the robot's left on the
 * left, elevation up, dark where ground was observed and light where space is free, with the skyline, its segments and
 * the subgoals upon them.
 */

import type { Frame, SessionInfo, Subgoal } from '../core/protocol.ts';
import { costColours } from '../ui/costColours.ts';
import { wrap } from '../ui/format.ts';
import { css, ramp } from '../ui/scale.ts';
import type { Theme } from '../ui/theme.ts';
import { drawAxes, HALF_TURN, hatching, LABEL_FONT, layout, type Plot, visitRuns } from './imagePlot.ts';

export class VarianceImage {
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D;
  readonly #pixels = document.createElement('canvas');
  #image: ImageData | undefined;
  #theme: Theme;
  #info: SessionInfo | undefined;
  #frame: Frame | undefined;
  #hatch: CanvasPattern | null = null;

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
    this.#draw();
  }

  session(info: SessionInfo): void {
    this.#info = info;
    const { columns, rows } = info.image;
    this.#pixels.width = columns;
    this.#pixels.height = rows;
    this.#image = new ImageData(columns, rows);
  }

  /** The frame's buffers stay readable until the next call. */
  show(frame: Frame): void {
    this.#frame = frame;
    this.#paintPixels();
    this.#draw();
  }

  #paintPixels(): void {
    const image = this.#image;
    if (!image || !this.#frame) return;
    const { variance } = this.#frame.buffers;
    const { width: columns, height: rows } = image;
    for (let column = 0; column < columns; column += 1) {
      for (let row = 0; row < rows; row += 1) {
        const value = variance[column * rows + row] ?? 0;
        const [red, green, blue] = ramp(this.#theme.variance, value);
        // Column 0 looks backwards on the right; row 0 is the lowest beam.
        const at = 4 * ((rows - 1 - row) * columns + (columns - 1 - column));
        image.data.set([red, green, blue, 255], at);
      }
    }
    this.#pixels.getContext('2d')?.putImageData(image, 0, 0);
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
    const frame = this.#frame;
    if (!frame || !this.#info) return;
    const plot = layout(width, height);
    context.save();
    context.beginPath();
    context.rect(plot.left, plot.top, plot.width, plot.height);
    context.clip();
    context.imageSmoothingEnabled = true;
    context.imageSmoothingQuality = 'high';
    this.#drawPixels(plot);
    this.#drawColumns(plot, frame.buffers.kinds);
    this.#drawProfile(plot, frame.buffers.profile);
    this.#drawSegments(plot, frame);
    context.restore();
    drawAxes(context, plot, this.#theme);
    this.#drawGoal(plot, frame);
    this.#drawSubgoals(plot, frame.subgoals);
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

  /** Unknown columns are hatched; walls carry a solid band along the top. */
  #drawColumns(plot: Plot, kinds: Uint8Array): void {
    const context = this.#context;
    visitRuns(kinds, (kind, from, to) => {
      const left = plot.x(to);
      const width = plot.x(from) - left;
      if (kind === 'unknown') {
        context.fillStyle = css(this.#theme.surface);
        context.globalAlpha = 0.55;
        context.fillRect(left, plot.top, width, plot.height);
        context.globalAlpha = 1;
        context.fillStyle = this.#hatch ?? css(this.#theme.muted);
        context.fillRect(left, plot.top, width, plot.height);
      } else if (kind === 'wall') {
        context.fillStyle = css(this.#theme.danger);
        context.globalAlpha = 0.28;
        context.fillRect(left, plot.top, width, plot.height);
        context.globalAlpha = 1;
        context.fillRect(left, plot.top, width, 5);
      }
    });
  }

  #drawProfile(plot: Plot, profile: Float32Array): void {
    const context = this.#context;
    const step = (2 * HALF_TURN) / profile.length;
    const line = new Path2D();
    let drawing = false;
    profile.forEach((elevation_rad, column) => {
      const ground = !Number.isNaN(elevation_rad);
      const [x, y] = [plot.x(-HALF_TURN + column * step), plot.y(elevation_rad)];
      if (ground && drawing) line.lineTo(x, y);
      else if (ground) line.moveTo(x, y);
      drawing = ground;
    });
    context.lineJoin = 'round';
    context.strokeStyle = this.#theme.dark ? 'rgb(0 0 0 / 0.5)' : 'rgb(255 255 255 / 0.6)';
    context.lineWidth = 3.5;
    context.stroke(line);
    context.strokeStyle = css(this.#theme.goal);
    context.lineWidth = 1.5;
    context.stroke(line);
  }

  #drawSegments(plot: Plot, frame: Frame): void {
    const context = this.#context;
    for (const segment of frame.segments) {
      if (Number.isNaN(segment.elevation_rad)) continue;
      const valid = segment.verdict === 'valid';
      context.strokeStyle = valid ? css(this.#theme.ink) : css(this.#theme.danger);
      context.lineWidth = valid ? 2.5 : 2;
      context.setLineDash(valid ? [] : segment.verdict === 'too_narrow' ? [2, 2] : [7, 3]);
      // A segment across the azimuth behind the robot shows at both ends.
      for (const turn of [0, -2 * HALF_TURN]) {
        const [left, right] = [plot.x(segment.end_rad + turn), plot.x(segment.begin_rad + turn)];
        if (right < plot.left || left > plot.left + plot.width) continue;
        const y = plot.y(segment.elevation_rad);
        context.beginPath();
        context.moveTo(left + 1, y);
        context.lineTo(right - 1, y);
        context.stroke();
      }
    }
    context.setLineDash([]);
  }

  #drawSubgoals(plot: Plot, subgoals: readonly Subgoal[]): void {
    const context = this.#context;
    const colourOf = costColours(subgoals);
    const ordered = [...subgoals].sort((a, b) => Number(a.chosen) - Number(b.chosen));
    for (const one of ordered) {
      const [x, y] = [plot.x(wrap(one.azimuth_rad)), plot.y(one.elevation_rad)];
      const scale = plot.width < 460 ? 0.8 : 1;
      const radius = scale * (one.chosen ? 7 : colourOf(one) ? 5 : 3.2);
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.fillStyle = css(colourOf(one) ?? this.#theme.muted);
      context.fill();
      context.lineWidth = 1.5;
      context.strokeStyle = '#0d1014';
      context.stroke();
      if (!one.chosen) continue;
      context.beginPath();
      context.arc(x, y, radius + 3.5, 0, 2 * Math.PI);
      context.lineWidth = 2;
      context.strokeStyle = css(this.#theme.ink);
      context.stroke();
    }
  }

  #drawGoal(plot: Plot, { pose }: Frame): void {
    const goal = this.#info?.goal;
    if (!goal) return;
    const context = this.#context;
    const x = plot.x(wrap(Math.atan2(goal.y - pose.y, goal.x - pose.x) - pose.yaw));
    context.strokeStyle = css(this.#theme.goal);
    context.lineWidth = 1.5;
    context.setLineDash([1, 4]);
    context.lineCap = 'round';
    context.beginPath();
    context.moveTo(x, plot.top);
    context.lineTo(x, plot.top + plot.height);
    context.stroke();
    context.setLineDash([]);
    context.lineCap = 'butt';
    context.fillStyle = css(this.#theme.goal);
    context.beginPath();
    context.moveTo(x, plot.top + 2);
    context.lineTo(x - 5, plot.top - 7);
    context.lineTo(x + 5, plot.top - 7);
    context.fill();
    context.font = LABEL_FONT;
    context.textBaseline = 'bottom';
    const room = x < plot.left + plot.width - 40;
    context.textAlign = room ? 'left' : 'right';
    context.fillText('goal', room ? x + 8 : x - 8, plot.top - 2);
  }
}
