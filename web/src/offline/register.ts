/** Keeps the page for offline use, and offers a new version when there is one. */

/** The first seconds belong to the simulation. */
const DELAY_MS = 4000;

/** `offer` shows that a new version is ready; its argument starts it. */
export function keepOffline(offer: (start: () => void) => void): void {
  // The development server changes under way, and old browsers go without.
  if (!import.meta.env.PROD || !('serviceWorker' in navigator)) return;
  setTimeout(async () => {
    try {
      const registration = await navigator.serviceWorker.register('./sw.js');
      const watch = (worker: ServiceWorker | null) => {
        const ready = () => {
          // Without a controller this is the first visit, and nothing is replaced.
          if (worker?.state !== 'installed' || !navigator.serviceWorker.controller) return;
          offer(() => {
            navigator.serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
            worker.postMessage('activate');
          });
        };
        ready();
        worker?.addEventListener('statechange', ready);
      };
      watch(registration.waiting);
      registration.addEventListener('updatefound', () => watch(registration.installing));
    } catch {
      // Private windows and full disks: the page works as before, only not offline.
    }
  }, DELAY_MS);
}
