/** Starts a job in a worker of its own. */

import type { FromTrials, Job, ToTrials } from './trialsProtocol.ts';

export interface RunningJob {
  send(message: ToTrials): void;
  /** Ends it; nothing is heard of it any more. */
  stop(): void;
}

export function startJob(job: Job, hear: (message: FromTrials) => void): RunningJob {
  const worker = new Worker(new URL('./trialsWorker.ts', import.meta.url), { type: 'module', name: 'mapless trials' });
  worker.onmessage = ({ data }: MessageEvent<FromTrials>) => hear(data);
  worker.onerror = (event) => {
    event.preventDefault();
    const message = event.message || 'The other planners could not be loaded.';
    hear({ type: 'failed', message, panicked: false });
  };
  worker.postMessage(job, job.type === 'own' ? [job.port] : []);
  return {
    send: (message) => worker.postMessage(message, message.type === 'drive' && message.port ? [message.port] : []),
    stop() {
      worker.onmessage = null;
      worker.onerror = null;
      worker.terminate();
    },
  };
}
