/** The frame of the unfolded image: scales, axes, and the marks for columns without a skyline. */

import { kindOf } from '../core/decode.ts';
import type { ColumnKind } from '../core/protocol.ts';
import { css, type Rgb } from '../ui/scale.ts';
import type { Theme } from '../ui/theme.ts';

/** The occupancy surface's limits. */
export const HALF_TURN = Math.PI;
const TOP_RAD = (15 * Math.PI) / 180;
const MARGIN = { left: 34, right: 10, top: 16, bottom: 20 };

/** Where azimuth and elevation lie on the canvas, in CSS pixels. */
export interface Plot {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
  x(azimuth_rad: number): number;
  y(elevation_rad: number): number;
}

/** Azimuth and elevation ticks, and the horizon. */
export function drawAxes(context: CanvasRenderingContext2D, plot: Plot, theme: Theme): void {
  context.font = LABEL_FONT;
  context.fillStyle = css(theme.muted);
  context.strokeStyle = css(theme.muted);
  context.lineWidth = 1;
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  for (const elevation_deg of [-15, 0, 15]) {
    const y = plot.y((elevation_deg * Math.PI) / 180);
    const label = elevation_deg > 0 ? `+${elevation_deg}°` : elevation_deg < 0 ? `\u2212${-elevation_deg}°` : '0°';
    const inside = Math.min(Math.max(y, plot.top + 5), plot.top + plot.height - 5);
    context.fillText(label, plot.left - 6, inside);
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
  const narrow = plot.width < 460;
  for (const azimuth_deg of narrow ? [180, 90, 0, -90, -180] : [180, 135, 90, 45, 0, -45, -90, -135, -180]) {
    const x = plot.x((azimuth_deg * Math.PI) / 180);
    const bottom = plot.top + plot.height;
    context.beginPath();
    context.moveTo(x, bottom);
    context.lineTo(x, bottom + 4);
    context.stroke();
    context.textAlign = azimuth_deg === 180 ? 'left' : azimuth_deg === -180 ? 'right' : 'center';
    context.fillText(azimuthLabel(azimuth_deg), x, bottom + 6);
  }
}

export const LABEL_FONT = '11px system-ui, sans-serif';

function azimuthLabel(azimuth_deg: number): string {
  if (azimuth_deg === 0) return 'ahead';
  if (azimuth_deg === 90) return 'left';
  if (azimuth_deg === -90) return 'right';
  if (Math.abs(azimuth_deg) === 180) return 'behind';
  return `${Math.abs(azimuth_deg)}°`;
}

/** The plot within a canvas of this size. */
export function layout(width: number, height: number): Plot {
  const left = MARGIN.left;
  const top = MARGIN.top;
  const inner = { width: width - left - MARGIN.right, height: height - top - MARGIN.bottom };
  return {
    left,
    top,
    ...inner,
    x: (azimuth_rad) => left + (inner.width * (HALF_TURN - azimuth_rad)) / (2 * HALF_TURN),
    y: (elevation_rad) => top + (inner.height * (TOP_RAD - elevation_rad)) / (2 * TOP_RAD),
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
    visit(kindOf(kinds[begin]), -HALF_TURN + (begin - 0.5) * step, -HALF_TURN + (end - 0.5) * step);
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
