/** One azimuth unrolled: what came back, what the process makes of it, and where it says that the ground ends. */

import { metres as metresWords } from '../base/format.ts';
import { css } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import { drawElevations } from '../inspector/imagePlot.ts';
import { columnsApart, elevationOf, TOP_RAD } from '../inspector/lattice.ts';
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

const MARGIN = { left: 34, right: 8, top: 18, bottom: 30 };
/** Between occupancy and variance. */
const GAP = 14;
/** Occupancies are shown from this far below none to as far beyond the most that there is. */
const BEYOND_M = { below: 2, above: 1 };
/** Inducing inputs are shown from so many columns on either side, fainter the farther. */
const NEAR_COLUMNS = 8;

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
  const y = (elevation_rad: number) =>
    inner.top + ((TOP_RAD - elevation_rad) / (2 * TOP_RAD)) * (inner.bottom - inner.top);
  const yOf = (row: number) => y(elevationOf(row, rows));
  const radius_m = info.occupancy_radius_m;
  const metres = (value: number) =>
    MARGIN.left + ((value + BEYOND_M.below) / (BEYOND_M.below + radius_m + BEYOND_M.above)) * (split - MARGIN.left);
  const share = (value: number) => split + GAP + value * (width - MARGIN.right - split - GAP);

  // Axes.
  const height_px = inner.bottom - inner.top;
  drawElevations(context, { left: MARGIN.left, top: inner.top, height: height_px, detailed: true, y }, theme);
  context.globalAlpha = 0.5;
  context.strokeRect(MARGIN.left, inner.top, split - MARGIN.left, inner.bottom - inner.top);
  context.strokeRect(split + GAP, inner.top, width - MARGIN.right - split - GAP, inner.bottom - inner.top);
  line(context, metres(0), inner.top, metres(0), inner.bottom, [2, 4]);
  context.globalAlpha = 1;
  context.textAlign = 'center';
  context.textBaseline = 'top';
  for (const value of [0, radius_m]) context.fillText(metresWords(value), metres(value), inner.bottom + 3);
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
  for (let row = 0; row < rows; row += 1) context.lineTo(metres((means[row] ?? 0) + deviation(row)), yOf(row));
  for (let row = rows - 1; row >= 0; row -= 1) context.lineTo(metres((means[row] ?? 0) - deviation(row)), yOf(row));
  context.closePath();
  context.fillStyle = css(theme.accent);
  context.globalAlpha = 0.2;
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = css(theme.accent);
  context.lineWidth = 2;
  context.beginPath();
  for (let row = 0; row < rows; row += 1) context.lineTo(metres(means[row] ?? 0), yOf(row));
  context.stroke();
  context.restore();

  // What came back.
  const observed = frame.buffers.observed.subarray(column * rings, (column + 1) * rings);
  context.fillStyle = css(theme.ink);
  observed.forEach((occupancy_m, ring) => {
    if (Number.isNaN(occupancy_m)) return;
    context.beginPath();
    context.arc(metres(occupancy_m), yOf((ring * (rows - 1)) / Math.max(rings - 1, 1)), 3.2, 0, 2 * Math.PI);
    context.fill();
  });

  // Inducing inputs, as ticks at the edge.
  for (const input of surfaces.inducing) {
    const apart = columnsApart(input.column, column, info.image.columns);
    if (apart > NEAR_COLUMNS || input.row >= rows) continue;
    context.globalAlpha = 1 - (0.8 * apart) / NEAR_COLUMNS;
    context.strokeStyle = css(input.out ? theme.danger : theme.ink);
    context.lineWidth = 2.5;
    line(context, MARGIN.left + 1, yOf(input.row), MARGIN.left + 9, yOf(input.row), input.out ? [2, 2] : []);
  }
  context.globalAlpha = 1;

  // Variance, the threshold, and the edge where they cross.
  context.strokeStyle = css(theme.ink);
  context.lineWidth = 2;
  context.beginPath();
  for (let row = 0; row < rows; row += 1) context.lineTo(share(Math.min(variances[row] ?? 1, 1)), yOf(row));
  context.stroke();
  context.strokeStyle = css(theme.goal);
  line(context, share(frame.threshold), inner.top, share(frame.threshold), inner.bottom, [5, 3]);
  context.fillStyle = css(theme.goal);
  context.textAlign = 'center';
  context.fillText('V_th', Math.min(share(frame.threshold), width - 16), 3);
  const skyline = surfaces.profile[column] ?? Number.NaN;
  if (Number.isNaN(skyline)) return;
  const edge = y(skyline);
  context.lineWidth = 1.5;
  line(context, MARGIN.left, edge, width - MARGIN.right, edge, []);
  const truth = frame.buffers.truth[column] ?? Number.NaN;
  if (Number.isNaN(truth)) return;
  context.strokeStyle = css(theme.ink);
  line(context, MARGIN.left, y(truth), width - MARGIN.right, y(truth), [1.5, 3]);
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
