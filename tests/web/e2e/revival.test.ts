import { commands, distance, draws, positions, scene, settled, stroke, studioOfFile } from './page';

/** The engine stops, or the graphics are taken away: the page goes on. */

const studio = studioOfFile();

/** The next command of the user meets what a trap in the module throws. */
const trap = async () => {
  const worker = studio.page.workers().find((w) => /assets\/worker/.test(w.url()))!;
  await worker.evaluate(() => {
    const { encode } = TextEncoder.prototype;
    TextEncoder.prototype.encode = function (text) {
      if (text?.startsWith('{"knead"')) return encode.call(this, text); // a rehearsal, which may come by itself
      throw new WebAssembly.RuntimeError('unreachable');
    };
  });
};
const revived = async () => {
  const { page } = studio;
  await expect.poll(() => page.locator('.notice').allTextContents().then((all) => all.filter((t) => t.includes('started again')).length)).toBe(1);
  expect(await page.locator('.notice').count()).toBe(1);
  await page.locator('.notice button[aria-label=Dismiss]').click();
  await settled(page);
};
const camera = () => studio.page.evaluate(() =>
  (window as never as { studio: { viewer: { main: { camera: { position: { toArray(): number[] } } } } } }).studio.viewer.main.camera.position.toArray());

describe('an engine that stops', () => {
  it('begins again with the document as it was opened', async () => {
    const { page } = studio;
    const [before, flat] = [await commands(page), await positions(page)];
    await trap();
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [20, 0]);
    await revived();
    expect(await commands(page)).toEqual(before);
    expect(distance(await positions(page), flat)).toBe(0);
    await stroke(page, [0, 0], [20, 0]);
    expect(distance(await positions(page), flat)).toBeGreaterThan(1);
  });

  it('begins again from the last copy, with its history and the same view', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const flat = await positions(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [20, 0]);
    const [shape, list] = [await positions(page), await commands(page)];
    await page.waitForSelector(`html[data-kept="${list.length}"]`, { state: 'attached' });
    await page.mouse.wheel(0, -300);
    await settled(page);
    const view = await camera();
    await trap();
    await page.keyboard.press('.');
    await revived();
    expect(distance(await positions(page), shape)).toBe(0);
    expect(await commands(page)).toEqual(list);
    expect(await camera()).toEqual(view);
    await page.keyboard.press('Control+z');
    await settled(page);
    expect(distance(await positions(page), flat)).toBe(0);
    // And is kept again.
    await stroke(page, [0, 20], [20, 20]);
    await page.waitForSelector(`html[data-kept="${(await commands(page)).length}"]`, { state: 'attached' });
  });

  it('in the middle of a stroke ends the stroke where it was kept, and loses nothing before it', async () => {
    const { page } = studio;
    const [list, shape] = [await commands(page), await positions(page)];
    const box = (await page.locator('.view-perspective').boundingBox())!;
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2 - 30];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 10, y, { steps: 3 });
    await settled(page);
    await trap();
    await page.mouse.move(x + 30, y, { steps: 3 });
    await page.mouse.up();
    await revived();
    const after = await commands(page);
    expect(after.slice(0, list.length)).toEqual(list);
    expect(await page.evaluate(() => (window as never as { studio: { state: { tools: unknown[] } } }).studio.state.tools)).toEqual([]);
    // Its beginning may have been kept: that is one entry.
    if (after.length > list.length) await page.keyboard.press('Control+z');
    await settled(page);
    expect(await commands(page)).toEqual(list);
    expect(distance(await positions(page), shape)).toBe(0);
  });
});

it('draws again at once when the graphics come back', async () => {
  const { page } = studio;
  await draws(page, true);
  await page.mouse.move(5, 300);
  await settled(page);
  const picture = () => page.locator('.viewer-canvas').screenshot();
  const before = await picture();
  await page.evaluate(() => {
    const context = document.querySelector<HTMLCanvasElement>('.viewer-canvas')!.getContext('webgl2')!;
    Object.assign(window, { lost: context.getExtension('WEBGL_lose_context') });
    (window as never as { lost: WEBGL_lose_context }).lost.loseContext();
  });
  await expect.poll(async () => Buffer.compare(before, await picture()) !== 0).toBe(true);
  await page.evaluate(() => (window as never as { lost: WEBGL_lose_context }).lost.restoreContext());
  await expect.poll(async () => Buffer.compare(before, await picture()) === 0).toBe(true);
});
