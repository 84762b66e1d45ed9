/** The worker that draws the 3D view, so that no drawing ever blocks the page. */

import { drawsInSoftware, Pacer } from './pacer.ts';
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
  const software = drawsInSoftware();
  if (software === undefined) post({ type: 'unavailable' });
  else painter = new Painter(data.canvas, data.theme, new Pacer(software, data.devicePixelRatio), post);
};
