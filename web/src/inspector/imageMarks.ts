/** What is drawn over the unfolded image: skyline, segments with their widths, subgoals, the goal, and what is pointed at. */

import { fixed, wrap } from '../base/format.ts';
import { costColours } from '../colours/costColours.ts';
import { css } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Frame, Segment, Subgoal } from '../protocol/simulationProtocol.ts';
import type { Target } from '../scene/selection.ts';
import { HALF_TURN, LABEL_FONT, type Mark, type Plot, visitRuns } from './imagePlot.ts';

type Context = CanvasRenderingContext2D;

/** Unknown columns are hatched; walls carry a solid band along the top. */
export function drawColumns(
  context: Context,
  plot: Plot,
  kinds: Uint8Array,
  theme: Theme,
  hatch: CanvasPattern | null,
): void {
  visitRuns(kinds, (kind, from, to) => {
    const left = plot.x(to);
    const width = plot.x(from) - left;
    if (kind === 'unknown') {
      context.fillStyle = css(theme.surface);
      context.globalAlpha = 0.55;
      context.fillRect(left, plot.top, width, plot.height);
      context.globalAlpha = 1;
      context.fillStyle = hatch ?? css(theme.muted);
      context.fillRect(left, plot.top, width, plot.height);
    } else if (kind === 'wall') {
      context.fillStyle = css(theme.danger);
      context.globalAlpha = 0.28;
      context.fillRect(left, plot.top, width, plot.height);
      context.globalAlpha = 1;
      context.fillRect(left, plot.top, width, 5);
    }
  });
}

/** How a skyline is drawn: that which holds, the one before somebody changed something, and the true one. */
export type SkylineKind = 'present' | 'former' | 'true';

const DASHES: Record<SkylineKind, number[]> = { present: [], former: [6, 4], true: [1.5, 3] };

export function drawProfile(
  context: Context,
  plot: Plot,
  profile: Float32Array,
  theme: Theme,
  kind: SkylineKind = 'present',
): void {
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
  context.strokeStyle = theme.dark ? 'rgb(0 0 0 / 0.5)' : 'rgb(255 255 255 / 0.6)';
  context.lineWidth = 3.5;
  if (kind === 'present') context.stroke(line);
  context.strokeStyle = css(kind === 'true' ? theme.ink : theme.goal);
  context.lineWidth = kind === 'present' ? 1.5 : 2;
  context.setLineDash(DASHES[kind]);
  context.stroke(line);
  context.setLineDash([]);
}

/** The level of each segment, with an arrow where it lies beyond the image; where the plot is large enough, also where it begins and ends, and how wide it is. */
export function drawSegments(context: Context, plot: Plot, segments: readonly Segment[], theme: Theme): void {
  for (const segment of segments) {
    const { elevation_rad } = segment;
    if (elevation_rad === undefined) continue;
    const valid = segment.verdict === 'valid';
    context.strokeStyle = valid ? css(theme.ink) : css(theme.danger);
    context.lineWidth = valid ? 2.5 : 2;
    const dashes = valid ? [] : segment.verdict === 'too_narrow' ? [2, 2] : [7, 3];
    visitPlaces(plot, segment, (left, right) => {
      const { y, beyond } = plot.mark(elevation_rad, 2);
      context.setLineDash(dashes);
      stroke(context, left + 1, y, right - 1, y);
      context.setLineDash([]);
      for (const end of beyond === 0 ? [] : [left + 7, right - 7]) {
        context.fillStyle = context.strokeStyle;
        arrow(context, end, y + 6 * beyond, 6, beyond);
        context.fill();
      }
      if (!plot.detailed) return;
      for (const end of [left + 1, right - 1]) stroke(context, end, y - 5, end, y + 5);
      drawWidth(
        context,
        plot,
        segment,
        { y, beyond },
        (Math.max(left, plot.left) + Math.min(right, plot.left + plot.width)) / 2,
        theme,
      );
    });
  }
}

function drawWidth(context: Context, plot: Plot, segment: Segment, mark: Mark, x: number, theme: Theme): void {
  const text = `${fixed(segment.width_m, 1)} m`;
  context.font = LABEL_FONT;
  const width = context.measureText(text).width + 8;
  if (plot.x(segment.begin_rad) - plot.x(segment.end_rad) < width + 4) return;
  const y = mark.beyond === 1 ? mark.y + 24 : Math.max(mark.y - 24, plot.top + 9);
  context.fillStyle = css(theme.surface);
  context.globalAlpha = 0.8;
  context.beginPath();
  context.roundRect(x - width / 2, y - 8, width, 16, 4);
  context.fill();
  context.globalAlpha = 1;
  context.fillStyle = segment.verdict === 'valid' ? css(theme.ink) : css(theme.danger);
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(text, x, y + 0.5);
}

/** Subgoals as dots; those beyond the image as arrows at its edge. */
export function drawSubgoals(context: Context, plot: Plot, subgoals: readonly Subgoal[], theme: Theme): void {
  const colourOf = costColours(subgoals);
  const ordered = [...subgoals].sort((a, b) => Number(a.chosen) - Number(b.chosen));
  const scale = plot.width < 460 ? 0.8 : plot.detailed ? 1.2 : 1;
  for (const one of ordered) {
    const radius = scale * (one.chosen ? 7 : colourOf(one) ? 5 : 3.2);
    const x = plot.x(wrap(one.azimuth_rad));
    const { y, beyond } = plot.mark(one.elevation_rad, radius + (one.chosen ? 5 : 1));
    context.fillStyle = css(colourOf(one) ?? theme.muted);
    context.lineWidth = 1.5;
    context.strokeStyle = '#0d1014';
    if (beyond === 0) circle(context, x, y, radius);
    else arrow(context, x, y, 1.2 * radius, beyond);
    context.fill();
    context.stroke();
    if (!one.chosen) continue;
    context.lineWidth = 2;
    context.strokeStyle = css(theme.ink);
    circle(context, x, y, radius + 3.5);
    context.stroke();
  }
}

/** A bright band over the segment that somebody points at. */
export function drawMarkedSegment(context: Context, plot: Plot, frame: Frame, target: Target, theme: Theme): void {
  const segment = target.segment === undefined ? undefined : frame.segments[target.segment];
  context.strokeStyle = css(theme.accent);
  context.fillStyle = css(theme.accent);
  context.lineWidth = 2;
  if (!segment) return;
  visitPlaces(plot, segment, (from, to) => {
    const left = Math.max(from, plot.left);
    const width = Math.min(to, plot.left + plot.width) - left;
    context.globalAlpha = 0.16;
    context.fillRect(left, plot.top, width, plot.height);
    context.globalAlpha = 1;
    context.strokeRect(left + 1, plot.top + 1, width - 2, plot.height - 2);
  });
}

/** A ring around the subgoal that somebody points at. */
export function drawMarkedSubgoal(context: Context, plot: Plot, frame: Frame, target: Target, theme: Theme): void {
  const subgoal = target.subgoal === undefined ? undefined : frame.subgoals[target.subgoal];
  if (!subgoal) return;
  context.strokeStyle = css(theme.accent);
  context.lineWidth = 3;
  circle(context, plot.x(wrap(subgoal.azimuth_rad)), plot.mark(subgoal.elevation_rad, 6).y, plot.detailed ? 14 : 12);
  context.stroke();
}

/** A flag at the goal's azimuth. */
export function drawGoal(context: Context, plot: Plot, azimuth_rad: number, theme: Theme): void {
  const x = plot.x(wrap(azimuth_rad));
  context.strokeStyle = css(theme.goal);
  context.lineWidth = 1.5;
  context.setLineDash([1, 4]);
  context.lineCap = 'round';
  stroke(context, x, plot.top, x, plot.top + plot.height);
  context.setLineDash([]);
  context.lineCap = 'butt';
  context.fillStyle = css(theme.goal);
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

/** A segment across the azimuth behind the robot shows at both ends. */
function visitPlaces(plot: Plot, { begin_rad, end_rad }: Segment, visit: (left: number, right: number) => void): void {
  for (const turn of [0, -2 * HALF_TURN]) {
    const [left, right] = [plot.x(end_rad + turn), plot.x(begin_rad + turn)];
    if (right > plot.left && left < plot.left + plot.width) visit(left, right);
  }
}

function stroke(context: Context, x1: number, y1: number, x2: number, y2: number): void {
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}

function circle(context: Context, x: number, y: number, radius: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

/** An arrow head around a place, up (1) or down (-1). */
function arrow(context: Context, x: number, y: number, size: number, up: number): void {
  context.beginPath();
  context.moveTo(x, y - up * size);
  context.lineTo(x - size, y + 0.8 * up * size);
  context.lineTo(x + size, y + 0.8 * up * size);
  context.closePath();
}
