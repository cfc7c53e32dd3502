/**
 * Keeps the page's files, so that the studio works without a network once it has been loaded. A version is kept whole or not
 * at all: every file is compared with the hash recorded by the build, and a page gets all its files from one version,
 * as those in assets/ are named by their content. A new version waits until the page asks for it or every tab is closed.
 */
const worker = self as unknown as ServiceWorkerGlobalScope;

/** Written by the build (plugins/offline.mjs): path to SHA-256. `lazy` ones are kept when they are first used. */
const manifest = JSON.parse('"KNEAD FILES"') as { version: string; files: Record<string, string>; lazy: string[] };

const prefix = 'knead files ';
const own = prefix + manifest.version;
const base = new URL('./', worker.location.href).href;

async function sha256(response: Response): Promise<string> {
  const digest = await crypto.subtle.digest('SHA-256', await response.arrayBuffer());
  return [...new Uint8Array(digest)].map((b) => b.toString(16).padStart(2, '0')).join('');
}

/** A file of the network, if it is that of this version. */
async function fetched(path: string): Promise<Response> {
  // Files not named by their content must not come from the browser's own cache.
  const response = await fetch(base + path, { cache: path.startsWith('assets/') ? 'default' : 'no-cache' });
  if (!response.ok || (await sha256(response.clone())) !== manifest.files[path]) throw new Error(`${path} is not of version ${manifest.version}`);
  return response;
}

const keep = async (cache: Cache, path: string): Promise<void> => cache.put(base + path, await fetched(path));

worker.addEventListener('install', (event) => {
  event.waitUntil((async () => {
    const cache = await caches.open(own);
    try {
      await Promise.all(Object.keys(manifest.files).filter((path) => !manifest.lazy.includes(path)).map((path) => keep(cache, path)));
    } catch (error) {
      await caches.delete(own);
      throw error;
    }
  })());
});

worker.addEventListener('activate', (event) => {
  event.waitUntil((async () => {
    // The previous version may still be open in another tab, which loads parts of it later.
    const old = (await caches.keys()).filter((name) => name.startsWith(prefix) && name !== own);
    await Promise.all(old.slice(0, -1).map((name) => caches.delete(name)));
    await worker.clients.claim();
  })());
});

worker.addEventListener('message', (event) => {
  if (event.data === 'take over') void worker.skipWaiting();
});

async function answer(request: Request, path: string): Promise<Response> {
  const cache = await caches.open(own);
  const found = (await cache.match(base + path)) ?? (path.startsWith('assets/') ? await caches.match(base + path) : undefined);
  if (found) return found;
  if (!manifest.lazy.includes(path)) return fetch(request);
  const response = await fetched(path);
  await cache.put(base + path, response.clone()).catch(() => undefined); // where storage is full it comes from the network again
  return response;
}

worker.addEventListener('fetch', (event) => {
  const { request } = event;
  const url = request.url.split(/[?#]/)[0]!;
  if (request.method !== 'GET' || !url.startsWith(base)) return;
  const path = url === base || request.mode === 'navigate' ? 'index.html' : url.slice(base.length);
  event.respondWith(answer(request, path));
});

export {};
