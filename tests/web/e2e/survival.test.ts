import { commands, distance, positions, ready, scene, settled, stroke, studioOfFile } from './page';

/** What a user has done is not lost: not with a worker that is ended, a command that is stopped, full storage, or another tab. */

const studio = studioOfFile();

interface Page {
  client: { worker: Worker; stops: number };
  documents: { name: string; keeper: { id: string; failed: number; touch(): void }; recover(kept: unknown): Promise<void> };
  execute(commands: object[]): Promise<unknown>;
}

it('loses nothing when the browser ends the engine without a word', async () => {
  const { page } = studio;
  await scene(page, 'Clay sheet');
  await page.keyboard.press('b');
  await stroke(page, [0, 0], [20, 0]);
  const [list, shape] = [await commands(page), await positions(page)];
  await page.evaluate(() => (window as never as { studio: Page }).studio.client.worker.terminate());
  await expect.poll(() => page.locator('.notice').allTextContents().then((all) => all.join())).toContain('started again with everything that was done before');
  await page.locator('.notice button[aria-label=Dismiss]').click();
  await settled(page);
  expect(await commands(page)).toEqual(list);
  expect(distance(await positions(page), shape)).toBe(0);
});

it('stops a command that takes long, says how far it is, and has everything as it was before', async () => {
  const { page } = studio;
  const [list, shape] = [await commands(page), await positions(page)];
  const done = page.evaluate(() => (window as never as { studio: Page }).studio.execute([{ do: 'step', count: 100000 }]));
  const busy = page.locator('.busy');
  await expect.poll(() => busy.textContent()).toMatch(/Step [\d,]+ of 100,000/);
  await busy.locator('button', { hasText: 'Stop' }).click();
  expect(await done).toBeNull();
  await expect.poll(() => page.locator('.notice').allTextContents().then((all) => all.join())).toContain('Stopped: the document is as it was before.');
  await page.locator('.notice button[aria-label=Dismiss]').click();
  await settled(page);
  expect(await commands(page)).toEqual(list);
  expect(distance(await positions(page), shape)).toBe(0);
  await expect.poll(() => busy.isHidden()).toBe(true);
});

it('says that storage is full, goes on, and keeps copies again when it is not', async () => {
  const { page } = studio;
  await page.evaluate(() => {
    const { put } = IDBObjectStore.prototype;
    Object.assign(window, { put });
    IDBObjectStore.prototype.put = () => {
      throw new DOMException('full', 'QuotaExceededError');
    };
  });
  const before = await positions(page);
  await stroke(page, [20, 30], [40, 30]);
  const notice = page.locator('.notice.error');
  await expect.poll(() => notice.allTextContents().then((all) => all.join())).toContain('storage is full');
  await notice.locator('button[aria-label=Dismiss]').click();
  expect(distance(await positions(page), before)).toBeGreaterThan(0.5);
  await page.evaluate(() => {
    IDBObjectStore.prototype.put = (window as never as { put: IDBObjectStore['put'] }).put;
    const { keeper } = (window as never as { studio: Page }).studio.documents;
    keeper.failed = -1e9; // long ago
    keeper.touch();
  });
  await page.waitForSelector(`html[data-kept="${(await commands(page)).length}"]`, { state: 'attached' });
});

it('is not overwritten by another tab that goes on with the same session', async () => {
  const { page } = studio;
  const list = await commands(page);
  const other = await page.context().newPage();
  await other.goto(studio.url);
  await ready(other);
  const id = await page.evaluate(() => (window as never as { studio: Page }).studio.documents.keeper.id);
  await other.evaluate(async (kept) => {
    const db = await new Promise<IDBDatabase>((resolve) => {
      const request = indexedDB.open('knead');
      request.onsuccess = () => resolve(request.result);
    });
    const session = await new Promise((resolve) => {
      const request = db.transaction('sessions').objectStore('sessions').get(kept);
      request.onsuccess = () => resolve(request.result);
    });
    db.close();
    await (window as never as { studio: Page }).studio.documents.recover(session);
  }, id);
  await expect.poll(() => other.locator('.notice').allTextContents().then((all) => all.join())).toContain('is open in another tab: this is a copy');
  expect(await commands(other)).toEqual(list);
  await other.waitForSelector(`html[data-kept="${list.length}"]`, { state: 'attached' });
  expect(await other.evaluate(() => (window as never as { studio: Page }).studio.documents.keeper.id)).not.toBe(id);
  await other.close();
});
