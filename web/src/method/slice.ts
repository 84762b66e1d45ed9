/** One azimuth unrolled: what came back, what the process makes of it, and where it says that the ground ends. */

import { wrap } from '../base/format.ts';
import { css } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';

/** What a slice is cut through. */
export interface Surfaces {
  readonly occupancy: Float32Array;
  readonly variance: Float32Array;
  readonly profile: Float32Array;
  /** Column and row of each inducing input, and whether it is left out. */
  readonly inducing: readonly InducingInput[];
}

export interface InducingInput {
  readonly column: number;
  readonly row: number;
  readonly out: boolean;
}

const DEGREE = Math.PI / 180;
/** The limits of the unfolded image. */
const TOP_DEG = 15;
const MARGIN = { left: 34, right: 8, top: 18, bottom: 30 };
/** Between occupancy and variance. */
const GAP = 14;
/** Occupancies shown. */
const OCCUPANCY_M = [-2, 8] as const;
/** Inducing inputs are shown from so many columns on either side, fainter the farther. */
const NEAR_COLUMNS = 8;
const FONT = '11px system-ui, sans-serif';

export function columnOf(azimuth_rad: number, columns: number): number {
  const step = (2 * Math.PI) / columns;
  return ((Math.round((wrap(azimuth_rad) + Math.PI) / step) % columns) + columns) % columns;
}

export function azimuthOf(column: number, columns: number): number {
  return -Math.PI + (column * 2 * Math.PI) / columns;
}

/** Draws the slice through `column`. */
export function drawSlice(
  canvas: HTMLCanvasElement,
  info: SessionInfo,
  frame: Frame,
  surfaces: Surfaces,
  column: number,
  sigma_m: number,
  theme: Theme,
): void {
  const ratio = window.devicePixelRatio;
  const { clientWidth: width, clientHeight: height } = canvas;
  const context = canvas.getContext('2d');
  if (!context || width === 0 || height === 0) return;
  if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
  if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const { rows, rings } = info.image;
  const inner = { top: MARGIN.top, bottom: height - MARGIN.bottom };
  const room = width - MARGIN.left - MARGIN.right - GAP;
  const split = MARGIN.left + Math.round(room * 0.62);
  const y = (elevation_deg: number) =>
    inner.top + ((TOP_DEG - elevation_deg) / (2 * TOP_DEG)) * (inner.bottom - inner.top);
  const rowDeg = (row: number) => -TOP_DEG + (row / (rows - 1)) * 2 * TOP_DEG;
  const metres = (value: number) =>
    MARGIN.left + ((value - OCCUPANCY_M[0]) / (OCCUPANCY_M[1] - OCCUPANCY_M[0])) * (split - MARGIN.left);
  const share = (value: number) => split + GAP + value * (width - MARGIN.right - split - GAP);

  // Axes.
  context.font = FONT;
  context.fillStyle = css(theme.muted);
  context.strokeStyle = css(theme.muted);
  context.lineWidth = 1;
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  for (const deg of [-15, -10, -5, 0, 5, 10, 15]) {
    const label = deg > 0 ? `+${deg}°` : deg < 0 ? `\u2212${-deg}°` : '0°';
    context.fillText(label, MARGIN.left - 5, Math.min(Math.max(y(deg), inner.top + 5), inner.bottom - 5));
  }
  context.globalAlpha = 0.5;
  context.strokeRect(MARGIN.left, inner.top, split - MARGIN.left, inner.bottom - inner.top);
  context.strokeRect(split + GAP, inner.top, width - MARGIN.right - split - GAP, inner.bottom - inner.top);
  line(context, metres(0), inner.top, metres(0), inner.bottom, [2, 4]);
  context.globalAlpha = 1;
  context.textAlign = 'center';
  context.textBaseline = 'top';
  for (const value of [0, 7]) context.fillText(`${value} m`, metres(value), inner.bottom + 3);
  for (const value of [0, 1]) context.fillText(String(value), share(value), inner.bottom + 3);
  context.fillText('occupancy', (MARGIN.left + split) / 2, inner.bottom + 16);
  context.fillText('variance', (split + GAP + width - MARGIN.right) / 2, inner.bottom + 16);
  context.textAlign = 'left';
  context.fillText('mean ± σ', MARGIN.left, 3);

  // Mean and deviation.
  const means = surfaces.occupancy.subarray(column * rows, (column + 1) * rows);
  const variances = surfaces.variance.subarray(column * rows, (column + 1) * rows);
  context.save();
  context.beginPath();
  context.rect(MARGIN.left, inner.top, split - MARGIN.left, inner.bottom - inner.top);
  context.clip();
  context.beginPath();
  const deviation = (row: number) => sigma_m * Math.sqrt(Math.max(variances[row] ?? 0, 0));
  for (let row = 0; row < rows; row += 1) context.lineTo(metres((means[row] ?? 0) + deviation(row)), y(rowDeg(row)));
  for (let row = rows - 1; row >= 0; row -= 1)
    context.lineTo(metres((means[row] ?? 0) - deviation(row)), y(rowDeg(row)));
  context.closePath();
  context.fillStyle = css(theme.accent);
  context.globalAlpha = 0.2;
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = css(theme.accent);
  context.lineWidth = 2;
  context.beginPath();
  for (let row = 0; row < rows; row += 1) context.lineTo(metres(means[row] ?? 0), y(rowDeg(row)));
  context.stroke();
  context.restore();

  // What came back.
  const observed = frame.buffers.observed.subarray(column * rings, (column + 1) * rings);
  context.fillStyle = css(theme.ink);
  observed.forEach((occupancy_m, ring) => {
    if (Number.isNaN(occupancy_m)) return;
    context.beginPath();
    context.arc(metres(occupancy_m), y(rowDeg((ring * (rows - 1)) / Math.max(rings - 1, 1))), 3.2, 0, 2 * Math.PI);
    context.fill();
  });

  // Inducing inputs, as ticks at the edge.
  for (const input of surfaces.inducing) {
    const around = Math.abs(input.column - column);
    const apart = Math.min(around, info.image.columns - around);
    if (apart > NEAR_COLUMNS || input.row >= rows) continue;
    context.globalAlpha = 1 - (0.8 * apart) / NEAR_COLUMNS;
    context.strokeStyle = css(input.out ? theme.danger : theme.ink);
    context.lineWidth = 2.5;
    line(
      context,
      MARGIN.left + 1,
      y(rowDeg(input.row)),
      MARGIN.left + 9,
      y(rowDeg(input.row)),
      input.out ? [2, 2] : [],
    );
  }
  context.globalAlpha = 1;

  // Variance, the threshold, and the edge where they cross.
  context.strokeStyle = css(theme.ink);
  context.lineWidth = 2;
  context.beginPath();
  for (let row = 0; row < rows; row += 1) context.lineTo(share(Math.min(variances[row] ?? 1, 1)), y(rowDeg(row)));
  context.stroke();
  context.strokeStyle = css(theme.goal);
  line(context, share(frame.threshold), inner.top, share(frame.threshold), inner.bottom, [5, 3]);
  context.fillStyle = css(theme.goal);
  context.textAlign = 'center';
  context.fillText('V_th', Math.min(share(frame.threshold), width - 16), 3);
  const skyline = surfaces.profile[column] ?? Number.NaN;
  if (Number.isNaN(skyline)) return;
  const edge = y(skyline / DEGREE);
  context.lineWidth = 1.5;
  line(context, MARGIN.left, edge, width - MARGIN.right, edge, []);
  const truth = frame.buffers.truth[column] ?? Number.NaN;
  if (Number.isNaN(truth)) return;
  context.strokeStyle = css(theme.ink);
  line(context, MARGIN.left, y(truth / DEGREE), width - MARGIN.right, y(truth / DEGREE), [1.5, 3]);
}

function line(
  context: CanvasRenderingContext2D,
  x1: number,
  y1: number,
  x2: number,
  y2: number,
  dashes: number[],
): void {
  context.setLineDash(dashes);
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
  context.setLineDash([]);
}
