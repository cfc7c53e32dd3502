import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { loadRhino } from '@studio/document/rhino/module';
import type { Page } from 'playwright-core';

import { collected } from '../collection';
import { boxes } from '../rhino_boxes';
import { commands, contextOf, distance, draws, execute, question, openFile as open, positions, ready, root, scene, screen, settled, stroke, studioOfFile, directoryOfFile, saveAs } from './page';

const studio = studioOfFile();
const directory = directoryOfFile();

const save = (page: Page, entry: string) => saveAs(page, directory, entry);

const kept = async (page: Page) => {
  const count = (await commands(page)).length;
  await page.waitForSelector(`html[data-kept="${count}"]`, { state: 'attached' });
};
const recover = (page: Page) => page.locator('.notice button', { hasText: 'Recover' }).click();

describe('Rhino files', () => {
  it('are saved, opened, sculpted and saved again', async () => {
    const { page } = studio;
    // The grids of pictures follow the shape as opened; control points are what files hold.
    const nets = (p: typeof page) => p.evaluate(() => {
      const { pictures, origin } = (window as never as { studio: { frame: { pictures: { net: Float32Array }[]; origin: number[] } } }).studio.frame;
      return pictures.flatMap((picture) => [...picture.net].map((x, k) => x + origin[k % 3]!));
    });
    await scene(page, 'Clay sheet');
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [30, 0]);
    const shape = await nets(page);
    const saved = await save(page, 'Rhino file');
    expect(saved).toMatch(/\.3dm$/);
    await scene(page, 'Clay sheet');
    await open(page, saved);
    expect(distance(await nets(page), shape)).toBeLessThan(1e-3); // in single precision here
    await stroke(page, [-30, 0]); // selects
    await stroke(page, [-30, 0], [-10, 0]);
    const again = await nets(page);
    expect(distance(again, shape)).toBeGreaterThan(1);
    const [byKeys] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('Control+s')]);
    expect(byKeys.suggestedFilename()).toMatch(/-sculpted\.3dm$/);
    expect(await save(page, 'STEP file')).toMatch(/\.step$/);
    const sculpted = await save(page, 'CAD file');
    expect(sculpted).toMatch(/-sculpted\.3dm$/);
    await open(page, sculpted);
    expect(distance(await nets(page), again)).toBeLessThan(1e-3);
  });

  it('of polysurfaces open too', async () => {
    const { page } = studio;
    const rhino = await loadRhino(new Uint8Array(readFileSync(join(root, 'web/node_modules/rhino3dm/rhino3dm.wasm'))));
    const path = join(directory, 'boxes.3dm');
    writeFileSync(path, boxes(rhino, ['large', [0, 0, 0], [7, 2, 3]], ['small', [10, 0, 0], [11, 5, 4]]));
    await open(page, path);
    expect(await page.locator('.panel[data-panel=Surfaces] .item').count()).toBe(12);
    await expect.poll(() => page.locator('.document-name').textContent()).toContain('boxes.3dm');
  });

  it('say what is lost in them before they are written, and are not where that is not wanted', async () => {
    const { page } = studio;
    await page.locator('.panel[data-panel=Surfaces] .item').first().click();
    await settled(page);
    const id = await page.evaluate(() => (window as never as { studio: { state: { surfaces: { id: string }[] } } }).studio.state.surfaces[0]!.id);
    await execute(page, { do: 'select', surface: id }, { do: 'refine', region: [[0, 1], [0, 1]] }, { do: 'hold', mode: 'open', rows: 0 } as never);
    await execute(page, { do: 'points', which: [4], by: [0, 0, 0.1] });
    let downloads = 0;
    page.on('download', () => ++downloads);
    await page.keyboard.press('Control+s');
    await expect.poll(() => question(page).textContent()).toContain('the polysurface keeps its old face');
    await question(page).getByRole('button', { name: 'Cancel' }).click();
    await settled(page);
    expect(downloads).toBe(0);
    await page.keyboard.press('Control+s');
    const [download] = await Promise.all([page.waitForEvent('download'), question(page).getByRole('button', { name: 'Save the Rhino file' }).click()]);
    expect(download.suggestedFilename()).toBe('boxes-sculpted.3dm');
  });

  const head = collected('v2_HumanHead2.3dm');
  it.skipIf(!head)('of polysurfaces of Rhino itself open too', async () => {
    const { page } = studio;
    await open(page, head!);
    expect(await page.locator('.panel[data-panel=Surfaces] .item').count()).toBe(10);
    await expect.poll(() => page.locator('.document-name').textContent()).toContain('v2_HumanHead2.3dm');
  });

  it('that are none are refused with a reason', async () => {
    const path = join(directory, 'bad.3dm');
    writeFileSync(path, '3D Geometry File Format, but not really');
    await open(studio.page, path);
    await expect.poll(() => studio.page.locator('.notice.error').textContent()).toContain('no Rhino file');
    await studio.page.locator('.notice.error button[aria-label=Dismiss]').click();
  });
});

describe('saving', () => {
  it('says so where a tool is still in contact', async () => {
    const { page } = studio;
    await scene(page, 'Ball on a membrane');
    await page.keyboard.press('.');
    await settled(page);
    await save(page, 'CAD file');
    await expect.poll(() => page.locator('.notice.info').last().textContent()).toContain('tool still in contact');
  });

  it('gives meshes', async () => {
    const stl = readFileSync(await save(studio.page, 'Mesh, STL'));
    expect(stl.readUInt32LE(80)).toBeGreaterThan(1000);
    expect(stl.length).toBe(84 + 50 * stl.readUInt32LE(80));
    expect(readFileSync(await save(studio.page, 'Mesh, OBJ'), 'utf8')).toMatch(/^f /m);
    expect(readFileSync(await save(studio.page, 'Mesh, PLY'), 'latin1')).toMatch(/^ply\r?\n/);
  });

  it('gives a picture of the size on the screen, and one twice as large', async () => {
    const { page } = studio;
    const size = (path: string) => {
      const png = readFileSync(path);
      return [png.readUInt32BE(16), png.readUInt32BE(20)];
    };
    await draws(page, true);
    await settled(page);
    const path = await save(page, 'Picture');
    const [width, height] = size(path);
    // What is seen.
    const differing = await (await screen(page)).evaluate(async ({ data, width: columns, height: rows }, file) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(file), (c) => c.charCodeAt(0))], { type: 'image/png' }));
      const context = new OffscreenCanvas(columns, rows).getContext('2d')!;
      context.drawImage(image, 0, 0);
      const saved = context.getImageData(0, 0, columns, rows).data;
      return { colours: new Set(new Uint32Array(data.buffer)).size, share: data.reduce((sum, x, k) => sum + Number(Math.abs(x - saved[k]!) > 2), 0) / data.length };
    }, readFileSync(path).toString('base64'));
    await draws(page, false);
    expect(differing.colours).toBeGreaterThan(100);
    expect(differing.share).toBeLessThan(0.001);
    const stage = (await page.locator('.stage').boundingBox())!;
    expect([width, height]).toEqual([Math.floor(stage.width), Math.floor(stage.height)]);
    expect(size(await save(page, 'Picture, twice as large'))).toEqual([2 * width!, 2 * height!]);
  });
});

describe('what a closed tab leaves behind', () => {
  it('comes back with its history', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const flat = await positions(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [30, 0]);
    const shape = await positions(page);
    await kept(page);
    await page.reload();
    await ready(page);
    await recover(page);
    await settled(page);
    expect(distance(await positions(page), shape)).toBe(0);
    await page.keyboard.press('Control+z');
    await settled(page);
    expect(distance(await positions(page), flat)).toBe(0);
    await page.keyboard.press('Control+Shift+z');
    await settled(page);
    expect(distance(await positions(page), shape)).toBe(0);
  });

  it('is kept while steps run, without a pause', async () => {
    const { page } = studio;
    await scene(page, 'Trampoline');
    await page.keyboard.press('Space');
    const steps = () => page.evaluate(() => (window as never as { studio: { frame: { state: { steps: number } } } }).studio.frame.state.steps);
    await expect.poll(steps, { timeout: 60_000 }).toBeGreaterThan(10);
    const before = await steps();
    await page.evaluate(() => delete document.documentElement.dataset.kept);
    await page.waitForSelector('html[data-kept]', { state: 'attached', timeout: 60_000 });
    // Without a pause in which it could be kept.
    await page.reload();
    await ready(page);
    await recover(page);
    await settled(page);
    const kept = (await commands(page)).filter((c) => c.do === 'step');
    expect(kept.length).toBe(1);
    expect(kept[0]!.count).toBeGreaterThan(0.5 * before);
  });

  it('is each tab its own', async () => {
    const { page, browser, url } = studio;
    const context = await contextOf(browser);
    const tabs = [await context.newPage(), await context.newPage()];
    const shapes: number[][] = [];
    for (const [k, tab] of tabs.entries()) {
      await tab.goto(url);
      await ready(tab);
      expect(await tab.locator('.notice').count()).toBe(0); // what is open in a tab is not offered in another
      await scene(tab, k === 0 ? 'Clay sheet' : 'Trampoline');
      if (k === 1) await tab.keyboard.press('.');
      else {
        await tab.keyboard.press('b');
        await stroke(tab, [0, 0], [30, 0]);
      }
      await settled(tab);
      shapes.push(await positions(tab));
      await kept(tab);
    }
    for (const tab of tabs) await tab.close();
    const later = await context.newPage();
    await later.goto(url);
    await ready(later);
    expect(await later.locator('.notice').textContent()).toContain('trampoline');
    await later.locator('.notice button', { hasText: 'Older (1)' }).click();
    expect(await later.locator('.notice').textContent()).toContain('sheet');
    await recover(later);
    await settled(later);
    expect(distance(await positions(later), shapes[0]!)).toBe(0);
    await context.close();
    await page.bringToFront();
  });
});
