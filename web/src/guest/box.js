/*
 * The script of the frame in which somebody's own planner is kept: without origin, so that it has no storage of the page,
 * and without network. It starts the worker that runs the code; the code answers through the port alone.
 */
self.onmessage = ({ data: { script, code, port } }) => {
  const address = URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
  const worker = new Worker(address, { type: 'module' });
  worker.onerror = ({ message }) => port.postMessage({ fault: message || 'The worker of the planner did not start.' });
  worker.postMessage({ code, port }, [port]);
};
