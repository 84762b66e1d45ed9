/** The worker that draws the 3D view, so that no drawing ever blocks the page. */

import { drawsInSoftware, Pacer } from './pacer.ts';
import { Painter } from './painter.ts';
import type { FromPainter, ToPainter } from './painterProtocol.ts';

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
  const context = data.canvas.getContext('webgl2', { antialias: !software });
  if (!context) {
    post({ type: 'unavailable' });
    return;
  }
  // Each extension that three.js asks for waits for the graphics process, and nothing here needs one. It warns where it finds no float colour
  // buffers, into which nothing here draws: told that they are there, it asks no more.
  Object.assign(context, { getExtension: (name: string) => (name === 'EXT_color_buffer_float' ? {} : null) });
  painter = new Painter(context, data.canvas, data.theme, new Pacer(software, data.devicePixelRatio), post);
};
