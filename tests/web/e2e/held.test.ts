import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { commands, openFile, scene, settled, spot, stroke, studioOfFile, directoryOfFile } from './page';

/** What is held of a surface: told beside it, and changed by a click on an edge. */

const studio = studioOfFile();
const directory = directoryOfFile();

const badge = () => studio.page.locator('.held-badge');
const last = async () => (await commands(studio.page)).at(-1)!;
/** Where a place of the file is on the page. */
const placeOf = async (place: [number, number, number]): Promise<[number, number]> => studio.page.evaluate((p) => {
  const { viewer } = (window as never as { studio: { viewer: { origin: number[]; viewports: { projectAll(points: number[]): Float32Array }[] } } }).studio;
  const [x, y] = viewer.viewports[0]!.projectAll(p.map((c, d) => c - viewer.origin[d]!));
  return [x!, y!] as [number, number];
}, place);

describe('a sheet', () => {
  it('says what of it is held, and goes on saying it as that changes', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await expect.poll(() => badge().textContent()).toBe('2 outer rows held');
    const [x, y] = await spot(page);
    const box = (await badge().boundingBox())!;
    expect(Math.hypot(box.x + box.width / 2 - x, box.y - y)).toBeLessThan(320); // near the sheet
    await badge().click();
    expect(await page.locator('.rail-button.on').getAttribute('aria-label')).toContain('Edges');
    await page.mouse.click(...(await placeOf([200, 100, 0])));
    await page.locator('.popover button', { hasText: 'Tangent' }).click();
    await expect.poll(() => badge().textContent()).toBe('2 outer rows and 1 edge held');
    for (let k = 0; k < 2; ++k) await page.evaluate(() => (window as never as { studio: { execute(c: object[]): Promise<unknown> } }).studio.execute([{ do: 'release' }]));
    await expect.poll(() => badge().textContent()).toBe('Nothing held');
    expect(await page.locator('.panel[data-panel=Constraints]').textContent()).not.toMatch(/[{}"[\]]/);
  });
});

describe('a face of a file', () => {
  it('is held along its edges, each of which can be asked for something else', async () => {
    const { page } = studio;
    const path = join(directory, 'faces.step');
    writeFileSync(path, facesStep());
    await openFile(page, path);
    await page.keyboard.press('b');
    await stroke(page, [0, 0]); // selects
    await page.keyboard.press('f');
    await expect.poll(() => badge().textContent()).toBe('1 edge held');
    await page.keyboard.press('d');
    const edge = () => placeOf([Math.SQRT1_2 * 4, Math.SQRT1_2 * 4, 0]);
    const popover = page.locator('.popover');
    await page.mouse.click(...(await edge()));
    await expect.poll(() => popover.locator('b').textContent()).toMatch(/^Edge #\d+$/);
    const id = (await popover.locator('b').textContent())!.slice(5);
    expect(await popover.locator('button[aria-pressed=true]').textContent()).toBe('Position');
    expect(await popover.locator('.note').textContent()).toBe('No other face meets it: nothing opens where it moves.');
    expect(await popover.locator('.chip').allTextContents()).toEqual(['Free', 'Follow', 'Position', 'Tangent', 'Curvature']);
    await popover.locator('button', { hasText: 'Tangent' }).click();
    await settled(page);
    expect(await last()).toMatchObject({ do: 'edge', edge: id, hold: 'tangent' });
    await expect.poll(() => badge().textContent()).toBe('1 edge held');
    await page.mouse.click(...(await edge()));
    expect(await popover.locator('button[aria-pressed=true]').textContent()).toBe('Tangent');
    await popover.locator('button', { hasText: 'Free' }).click();
    await expect.poll(() => badge().textContent()).toBe('0 of 1 edges held');
    await page.keyboard.press('Control+z');
    await expect.poll(() => badge().textContent()).toBe('1 edge held');
    // The sides of the surface, which the face does not show, are no edges of it.
    await page.mouse.click(...(await placeOf([5, 0, 0])));
    expect(await popover.count()).toBe(0);
  });
});
