/*
 * The service worker: keeps every file of one build, so that the page opens without a network. A build is served whole or
 * not at all: a new one waits until the page asks for it or until all tabs with the old one are closed.
 * The build fills in version and files (web/build/offline.ts).
 */
const VERSION = '%VERSION%';
const FILES = ['%FILES%'];
const CACHE = `mapless-${VERSION}`;

self.addEventListener('install', (event) => {
  const fetched = FILES.map((file) => new Request(file, { cache: 'no-cache' }));
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(fetched)));
});

self.addEventListener('activate', (event) => {
  event.waitUntil(dropOthers().then(() => self.clients.claim()));
});

async function dropOthers() {
  const names = await caches.keys();
  const old = names.filter((name) => name.startsWith('mapless-') && name !== CACHE);
  await Promise.all(old.map((name) => caches.delete(name)));
}

self.addEventListener('message', ({ data }) => {
  if (data === 'activate') self.skipWaiting();
});

self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method !== 'GET' || !request.url.startsWith(self.registration.scope)) return;
  event.respondWith(answer(request));
});

/** The kept file, or what the network has under an address that is none of them. */
async function answer(request) {
  const path = request.url.slice(self.registration.scope.length).replace(/[?#].*$/, '');
  const cache = await caches.open(CACHE);
  return (await cache.match(path === '' ? 'index.html' : path)) ?? fetch(request);
}
