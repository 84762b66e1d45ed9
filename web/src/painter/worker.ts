/** The worker that draws the 3D view, so that no drawing ever blocks the page. */

import { Painter } from './painter.ts';
import type { FromPainter, ToPainter } from './protocol.ts';

let painter: Painter | undefined;

function post(message: FromPainter, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

self.onmessage = ({ data }: MessageEvent<ToPainter>) => {
  if (data.type !== 'begin') {
    painter?.obey(data);
    return;
  }
  try {
    painter = new Painter(data.canvas, data.theme, data.devicePixelRatio, post);
  } catch {
    post({ type: 'unavailable' });
  }
};
