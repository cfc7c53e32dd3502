import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { commands, distance, openFile, positions, scene, settled, stroke, studioOfFile, directoryOfFile, saveAs } from './page';

/** What the first click on an opened file does, and how a face is brought before the eye. */

const studio = studioOfFile();
const directory = directoryOfFile();

interface Surface {
  id: string;
  hold: number;
  preset: string | null;
  constraints: { do: string; mode?: string }[];
}
const surfaces = () => studio.page.evaluate(() =>
  (window as never as { studio: { state: { surfaces: Surface[]; selection: number[] } } }).studio.state);

/** Where places of the file are in the perspective view, as shares of its width and height. */
const seen = (places: [number, number, number][]) => studio.page.evaluate((all) => {
  const { viewer } = (window as never as { studio: { viewer: {
    origin: number[]; viewports: { projectAll(points: number[]): Float32Array; element: HTMLElement }[];
  } } }).studio;
  const view = viewer.viewports[0]!;
  const box = view.element.getBoundingClientRect();
  const at = [...view.projectAll(all.flatMap((p) => p.map((x, d) => x - viewer.origin[d]!)))];
  return all.map((_, k) => [(at[2 * k]! - box.left) / box.width, (at[2 * k + 1]! - box.top) / box.height]);
}, places);
const within = (shares: number[][]) => shares.every(([x, y]) => x! > 0 && x! < 1 && y! > 0 && y! < 1);
const size = (shares: number[][]) => Math.max(...[0, 1].map((d) => Math.max(...shares.map((s) => s[d]!)) - Math.min(...shares.map((s) => s[d]!))));

describe('a file of one surface', () => {
  it('is not dented by the first press', async () => {
    const { page } = studio;
    const path = join(directory, 'faces.step');
    writeFileSync(path, facesStep());
    await openFile(page, path);
    const [before, shape] = [await commands(page), await positions(page)];
    expect((await surfaces()).surfaces[0]).toMatchObject({ preset: 'clay' });
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [12, 0]);
    expect(distance(await positions(page), shape)).toBe(0);
    expect(await commands(page)).toEqual(before);
    await stroke(page, [0, 0], [12, 0]);
    expect(distance(await positions(page), shape)).toBeGreaterThan(0.01);
    // And after all is taken back it is chosen still, and held.
    for (let k = 0; k < 4; ++k) await page.keyboard.press('Control+z');
    await settled(page);
    expect(await commands(page)).toEqual(before);
    expect((await surfaces()).surfaces[0]!.constraints.length + (await surfaces()).surfaces[0]!.hold).toBeGreaterThan(0);
  });

  it('is shown by F, and all that is grey by Shift+F', async () => {
    const { page } = studio;
    const disc: [number, number, number][] = [[4, 0, 0], [-4, 0, 0], [0, 4, 0], [0, -4, 0]];
    const corners: [number, number, number][] = [[-20, -20, -4], [20, -20, -4], [20, 20, -4], [-20, 20, -4]];
    await expect.poll(() => page.evaluate(() => (window as never as { studio: { viewer: { context: { triangles: number } } } }).studio.viewer.context.triangles)).toBe(2);
    await page.keyboard.press('Shift+F');
    const all = await seen(corners);
    expect(within(all)).toBe(true);
    expect(size(all)).toBeGreaterThan(0.5);
    expect(size(await seen(disc))).toBeLessThan(0.3);
    await page.keyboard.press('f');
    const face = await seen(disc);
    expect(within(face)).toBe(true);
    expect(size(face)).toBeGreaterThan(0.5); // of the face, not of the surface below it
    expect(within(await seen(corners))).toBe(false);
  });
});

describe('a Rhino file', () => {
  it('begins with nothing chosen, and what is clicked is held', async () => {
    const { page } = studio;
    await scene(page, 'Two patches');
    const path = await saveAs(page, directory, 'Rhino file');
    await openFile(page, path);
    const shape = await positions(page);
    await page.keyboard.press('b');
    for (const place of [[50, 0], [-50, 0]] as [number, number][]) {
      await stroke(page, place);
      expect(distance(await positions(page), shape)).toBe(0);
      const state = await surfaces();
      expect(state.selection.length).toBe(1);
      expect(state.surfaces[state.selection[0]!]).toMatchObject({ preset: 'clay', hold: 2 });
    }
    // Chosen in the list it is held as well.
    await openFile(page, path);
    await page.locator('.panel[data-panel=Surfaces] .item').last().click();
    await settled(page);
    const state = await surfaces();
    expect(state.surfaces[state.selection[0]!]).toMatchObject({ preset: 'clay', hold: 2 });
  });
});
