/** A small picture of a terrain: its colours by height, lit from the north-west. */

import { ramp } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Solid, TerrainPreview } from '../protocol/simulationProtocol.ts';

/** Exaggerates slopes, which are gentle from above. */
const STEEPER = 2.2;

/** Objects are drawn no smaller than so many samples. */
const LEAST_SIZE = 1.4;

export function drawRelief(canvas: HTMLCanvasElement, { ground, solids }: TerrainPreview, theme: Theme): void {
  const { columns, rows, cell_m, heights_m } = ground;
  canvas.width = columns;
  canvas.height = rows;
  const context = canvas.getContext('2d');
  if (!context) return;
  const image = context.createImageData(columns, rows);
  let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
  for (const height of heights_m) {
    low = Math.min(low, height);
    high = Math.max(high, height);
  }
  const height = (column: number, row: number) =>
    heights_m[Math.min(Math.max(row, 0), rows - 1) * columns + Math.min(Math.max(column, 0), columns - 1)] ?? 0;
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const east = (STEEPER * (height(column + 1, row) - height(column - 1, row))) / (2 * cell_m);
      const north = (STEEPER * (height(column, row + 1) - height(column, row - 1))) / (2 * cell_m);
      // The sun stands in the north-west, 45° high: its direction is (-½, ½, 1/√2).
      const facing = (0.5 * east - 0.5 * north + Math.SQRT1_2) / Math.hypot(east, north, 1);
      const light = 0.45 + 0.75 * Math.max(facing, 0);
      const colour = ramp(theme.relief, (height(column, row) - low) / Math.max(high - low, 1));
      const at = 4 * ((rows - 1 - row) * columns + column);
      for (let channel = 0; channel < 3; channel += 1) image.data[at + channel] = light * (colour[channel] ?? 0);
      image.data[at + 3] = 255;
    }
  }
  context.putImageData(image, 0, 0);
  context.fillStyle = `rgb(${theme.object.join(' ')})`;
  for (const solid of solids) drawSolid(context, solid, rows, cell_m);
}

/** An object as seen from above. */
function drawSolid(context: CanvasRenderingContext2D, solid: Solid, rows: number, cell_m: number): void {
  const { shape, centre_m, size_m, sin_cos_yaw } = solid;
  const [sin, cos] = sin_cos_yaw;
  const drawn = (size: number) => Math.max(size / cell_m, LEAST_SIZE);
  const [length, width] = [drawn(size_m[0]), drawn(size_m[1])];
  context.save();
  context.translate(centre_m[0] / cell_m + 0.5, rows - 0.5 - centre_m[1] / cell_m);
  context.transform(cos, -sin, sin, cos, 0, 0);
  context.beginPath();
  if (shape === 'box') context.rect(-length / 2, -width / 2, length, width);
  else context.arc(0, 0, length / 2, 0, 2 * Math.PI);
  context.fill();
  context.restore();
}
