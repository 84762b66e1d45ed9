/** The frame of the unfolded image: scales, axes, and the marks for columns without a skyline. */

import { radians } from '../base/format.ts';
import { css, type Rgb } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import { COLUMN_KINDS, type ColumnKind } from '../protocol/simulationProtocol.ts';
import { TOP_RAD } from './lattice.ts';

export const HALF_TURN = Math.PI;
/** What lies there is in the image, rounded as it may be. */
const EDGE_RAD = TOP_RAD + 1e-6;
const MARGIN = { left: 34, right: 10, top: 16, bottom: 20 };
/** Room for the scale beside a large plot. */
const SCALE_MARGIN = 86;
/** From this size on the plot has room for widths, finer axes and a scale. */
const DETAILED = { width: 620, height: 260 };

/** Where an elevation is drawn, and whether it lies beyond the image, above or below. */
export interface Mark {
  readonly y: number;
  readonly beyond: -1 | 0 | 1;
}

/** Where azimuth and elevation lie on the canvas, in CSS pixels. */
export interface Plot {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
  readonly detailed: boolean;
  azimuth_rad(x: number): number;
  x(azimuth_rad: number): number;
  y(elevation_rad: number): number;
  /** The same, but no nearer to an edge than `margin`, and whether it lies beyond the upper (1) or the lower one (-1). */
  mark(elevation_rad: number, margin: number): Mark;
}

/** Elevations along the left edge of a plot, in the colour and font that its other labels go on with. */
export function drawElevations(
  context: CanvasRenderingContext2D,
  { left, top, height, detailed, y }: Pick<Plot, 'left' | 'top' | 'height' | 'detailed' | 'y'>,
  theme: Theme,
): void {
  context.font = LABEL_FONT;
  context.fillStyle = css(theme.muted);
  context.strokeStyle = css(theme.muted);
  context.lineWidth = 1;
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  for (const elevation_deg of detailed ? [-15, -10, -5, 0, 5, 10, 15] : [-15, 0, 15]) {
    const label = elevation_deg > 0 ? `+${elevation_deg}°` : elevation_deg < 0 ? `\u2212${-elevation_deg}°` : '0°';
    const inside = Math.min(Math.max(y(radians(elevation_deg)), top + 5), top + height - 5);
    context.fillText(label, left - 6, inside);
  }
}

/** Azimuth and elevation ticks, and the horizon. */
export function drawAxes(context: CanvasRenderingContext2D, plot: Plot, theme: Theme): void {
  drawElevations(context, plot, theme);
  if (plot.detailed) {
    context.save();
    context.translate(9, plot.top + plot.height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = 'center';
    context.fillText('elevation', 0, 0);
    context.restore();
  }
  context.globalAlpha = 0.5;
  context.setLineDash([2, 5]);
  context.beginPath();
  context.moveTo(plot.left, plot.y(0));
  context.lineTo(plot.left + plot.width, plot.y(0));
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
  context.textBaseline = 'top';
  const step_deg = plot.detailed && plot.width > 860 ? 30 : plot.width < 760 ? 90 : 45;
  for (let azimuth_deg = 180; azimuth_deg >= -180; azimuth_deg -= step_deg) {
    const x = plot.x((azimuth_deg * Math.PI) / 180);
    const bottom = plot.top + plot.height;
    context.beginPath();
    context.moveTo(x, bottom);
    context.lineTo(x, bottom + 4);
    context.stroke();
    context.textAlign = azimuth_deg === 180 ? 'left' : azimuth_deg === -180 ? 'right' : 'center';
    context.fillText(azimuthLabel(azimuth_deg, plot.detailed), x, bottom + 6);
  }
}

export const LABEL_FONT = '11px system-ui, sans-serif';

function azimuthLabel(azimuth_deg: number, detailed: boolean): string {
  const names: Record<number, string> = { 0: 'ahead', 90: 'left', [-90]: 'right', 180: 'behind', [-180]: 'behind' };
  const name = names[azimuth_deg];
  const angle = `${azimuth_deg < 0 ? '\u2212' : ''}${Math.abs(azimuth_deg)}°`;
  if (detailed) return name ? `${name} ${angle}` : angle;
  return name ?? `${Math.abs(azimuth_deg)}°`;
}

/** The colours of the variance beside the plot, with the threshold between observed and free. */
export function drawScale(context: CanvasRenderingContext2D, plot: Plot, threshold: number, theme: Theme): void {
  const left = plot.left + plot.width + 12;
  const y = (variance: number) => plot.top + plot.height * (1 - variance);
  const gradient = context.createLinearGradient(0, y(0), 0, y(1));
  theme.variance.forEach((colour, index, all) => {
    gradient.addColorStop(index / (all.length - 1), css(colour));
  });
  context.fillStyle = gradient;
  context.fillRect(left, plot.top, 10, plot.height);
  context.strokeStyle = css(theme.muted);
  context.lineWidth = 1;
  context.strokeRect(left + 0.5, plot.top + 0.5, 9, plot.height - 1);
  context.font = LABEL_FONT;
  context.textAlign = 'left';
  context.textBaseline = 'middle';
  context.fillStyle = css(theme.muted);
  context.fillText('1 free', left + 14, y(1) + 5);
  context.fillText('0 seen', left + 14, y(0) - 5);
  context.fillStyle = css(theme.goal);
  context.fillRect(left - 3, y(threshold) - 1, 16, 2);
  context.fillText(`V_th ${threshold.toFixed(2)}`, left + 19, Math.min(y(threshold), y(0) - 19));
}

/** The plot within a canvas of this size. */
export function layout(width: number, height: number): Plot {
  const detailed = width >= DETAILED.width && height >= DETAILED.height;
  const left = MARGIN.left + (detailed ? 14 : 0);
  const top = MARGIN.top;
  const right = detailed ? SCALE_MARGIN : MARGIN.right;
  const inner = { width: width - left - right, height: height - top - MARGIN.bottom };
  const y = (elevation_rad: number) => top + (inner.height * (TOP_RAD - elevation_rad)) / (2 * TOP_RAD);
  return {
    left,
    top,
    ...inner,
    detailed,
    azimuth_rad: (x) => HALF_TURN - ((x - left) / inner.width) * 2 * HALF_TURN,
    x: (azimuth_rad) => left + (inner.width * (HALF_TURN - azimuth_rad)) / (2 * HALF_TURN),
    y,
    mark(elevation_rad, margin) {
      const inside = Math.min(Math.max(y(elevation_rad), top + margin), top + inner.height - margin);
      return { y: inside, beyond: elevation_rad > EDGE_RAD ? 1 : elevation_rad < -EDGE_RAD ? -1 : 0 };
    },
  };
}

/** Calls back with each run of columns of one kind and the azimuths between which it lies. */
export function visitRuns(
  kinds: Uint8Array,
  visit: (kind: ColumnKind, from_rad: number, to_rad: number) => void,
): void {
  const step = (2 * HALF_TURN) / kinds.length;
  for (let begin = 0; begin < kinds.length; ) {
    let end = begin + 1;
    while (end < kinds.length && kinds[end] === kinds[begin]) end += 1;
    visit(
      COLUMN_KINDS[kinds[begin] ?? 0] ?? 'unknown',
      -HALF_TURN + (begin - 0.5) * step,
      -HALF_TURN + (end - 0.5) * step,
    );
    begin = end;
  }
}

/** A small tile of diagonal lines. */
export function hatching(colour: Rgb): HTMLCanvasElement {
  const tile = document.createElement('canvas');
  tile.width = 8;
  tile.height = 8;
  const context = tile.getContext('2d');
  if (!context) return tile;
  context.strokeStyle = css(colour);
  context.globalAlpha = 0.75;
  context.lineWidth = 1.2;
  for (const offset of [-8, 0, 8]) {
    context.beginPath();
    context.moveTo(offset, 8);
    context.lineTo(offset + 8, 0);
    context.stroke();
  }
  return tile;
}
