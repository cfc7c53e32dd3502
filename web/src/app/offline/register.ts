import type { App } from '../../panels/app';

/** Keeps the page for use without a network, and reports when a newer version is available. */
export async function workOffline(app: App): Promise<void> {
  if (!import.meta.env.PROD || !('serviceWorker' in navigator)) return;
  try {
    const registration = await navigator.serviceWorker.register('./service-worker.js', { scope: './' });
    const offer = (worker: ServiceWorker) =>
      app.notify({
        kind: 'info',
        ofPage: true,
        text: 'A newer version of the studio is here.',
        actions: [{ label: 'Reload', act: () => void takeOver(app, worker) }],
      });
    const watch = (worker: ServiceWorker) =>
      worker.addEventListener('statechange', () => {
        // Without a controller this is the first version: there is nothing to report.
        if (worker.state === 'installed' && navigator.serviceWorker.controller) offer(worker);
      });
    if (registration.waiting && navigator.serviceWorker.controller) offer(registration.waiting);
    if (registration.installing) watch(registration.installing);
    registration.addEventListener('updatefound', () => registration.installing && watch(registration.installing));
    await navigator.serviceWorker.ready;
    document.documentElement.dataset.offline = 'ready';
    // Now, and when the user returns to a tab that has been open for long. Without a network there is nothing newer.
    const look = () => void registration.update().catch(() => {});
    document.addEventListener('visibilitychange', () => document.visibilityState === 'visible' && look());
    look();
  } catch {
    // Private windows and some hosts have none: the studio works, online.
  }
}

/** What is open is saved first, and offered again by the new page. */
async function takeOver(app: App, worker: ServiceWorker): Promise<void> {
  await app.documents.keeper.keep();
  navigator.serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
  worker.postMessage('take over');
}
