import { createHash } from 'node:crypto';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import type { Page } from 'playwright-core';

import { distance, openStudio, positions, ready, root, scene, serve, stroke } from './page';

const offlineReady = (page: Page) => page.waitForSelector('html[data-offline=ready]', { state: 'attached', timeout: 30_000 });
const workerOf = (directory: string) => join(directory, 'service-worker.js');

/** Changes the page as a new build would, and the worker's hashes with it; `hash` only for one that does not fit. */
function rebuild(directory: string, title: string, hash?: string): void {
  const index = join(directory, 'index.html');
  writeFileSync(index, readFileSync(index, 'utf8').replace(/<title>.*<\/title>/, `<title>${title}</title>`).replace(/<div id="studio"[^>]*>/, `<div id="studio" data-build="${title}">`));
  const right = createHash('sha256').update(readFileSync(index)).digest('hex');
  const code = readFileSync(workerOf(directory), 'utf8');
  const changed = code.replace(/(\\"index\.html\\":\\")[0-9a-f]{64}/, `$1${hash ?? right}`).replace(/(\\"version\\":\\")[0-9a-f]+/, `$1${right.slice(0, 16)}`);
  expect(changed).not.toBe(code);
  writeFileSync(workerOf(directory), changed);
}

const build = (page: Page) => page.locator('#studio').getAttribute('data-build');

it('works without the server once it was loaded', async () => {
  const server = await serve(join(root, 'web/dist'));
  const studio = await openStudio({ server });
  const { page } = studio;
  await offlineReady(page);
  await server.close();
  await page.reload();
  await ready(page);
  const flat = await positions(page);
  await page.keyboard.press('b');
  await stroke(page, [0, 0], [30, 0]);
  expect(distance(await positions(page), flat)).toBeGreaterThan(1);
  // The scene that is a file of its own is there as well.
  await scene(page, 'Bonnet');
  await expect.poll(() => page.locator('.document-name').textContent()).toContain('bonnet.step');
  expect(studio.problems).toEqual([]);
  expect(studio.foreign).toEqual([]);
  await studio.close();
});

it('stays the version that it is until a whole new one is there and asked for', async () => {
  const directory = mkdtempSync(join(tmpdir(), 'knead-dist-'));
  cpSync(join(root, 'web/dist'), directory, { recursive: true });
  const server = await serve(directory);
  const studio = await openStudio({ server });
  const { page } = studio;
  await offlineReady(page);
  const versions = () => page.evaluate(() => caches.keys());
  const first = await versions();
  expect(first.length).toBe(1);
  // A deployment under way: a file is not the one that the new version asks for.
  rebuild(directory, 'half', '0'.repeat(64));
  await page.reload();
  await ready(page);
  expect(await page.evaluate(async () => {
    const registration = (await navigator.serviceWorker.getRegistration())!;
    await registration.update().catch(() => {});
    while (registration.installing) await new Promise((done) => registration.installing!.addEventListener('statechange', done, { once: true }));
    return registration.waiting === null;
  })).toBe(true);
  expect(await build(page)).toBeNull();
  expect(await versions()).toEqual(first);
  // And whole.
  rebuild(directory, 'whole');
  await page.reload();
  await ready(page);
  expect(await build(page)).toBeNull();
  await page.locator('.notice', { hasText: 'newer version' }).locator('button', { hasText: 'Reload' }).click();
  await expect.poll(() => build(page).catch(() => ''), { timeout: 20_000 }).toBe('whole');
  await ready(page);
  expect(studio.problems).toEqual([]);
  await studio.close();
  await server.close();
  rmSync(directory, { recursive: true });
});
