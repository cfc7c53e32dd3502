import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { directoryOfFile, picture, settled, studioOfFile } from './page';

const studio = studioOfFile();
const directory = directoryOfFile();

beforeAll(async () => {
  const path = join(directory, 'faces.step');
  writeFileSync(path, facesStep());
  await studio.page.locator('input[type=file]').first().setInputFiles(path);
});

/** How far the corners of the square are from the middle of the view: 1 at its sides. */
const farthest = () => studio.page.evaluate(() => {
  const { viewer } = (window as never as { studio: { viewer: {
    origin: number[]; main: { camera: { matrixWorldInverse: { elements: number[] }; projectionMatrix: { elements: number[] } } };
  } } }).studio;
  const times = (m: number[], v: number[]) => [0, 1, 2, 3].map((r) => [0, 1, 2, 3].reduce((sum, c) => sum + m[4 * c + r]! * v[c]!, 0));
  const { camera } = viewer.main;
  return Math.max(...[[-20, -20], [20, -20], [20, 20], [-20, 20]].map(([x, y]) => {
    const place = [x! - viewer.origin[0]!, y! - viewer.origin[1]!, -4 - viewer.origin[2]!, 1];
    const [a, b, , w] = times(camera.projectionMatrix.elements, times(camera.matrixWorldInverse.elements, place)) as [number, number, number, number];
    return w > 0 ? Math.max(Math.abs(a / w), Math.abs(b / w)) : Infinity;
  }));
});

it('is within the first view, and within that of Shift+F and 0', async () => {
  const { page } = studio;
  await expect.poll(triangles).toBeGreaterThan(0);
  await expect.poll(farthest).toBeLessThan(1);
  expect(await farthest()).toBeGreaterThan(0.5);
  for (const key of ['Shift+F', '0']) {
    await page.mouse.move(400, 300);
    for (let k = 0; k < 6; ++k) await page.mouse.wheel(0, -400);
    await expect.poll(farthest).toBeGreaterThan(1);
    await page.keyboard.press(key);
    await expect.poll(farthest, { message: key }).toBeLessThan(1);
  }
});

const triangles = () =>
  studio.page.evaluate(() => (window as never as { studio: { viewer: { context: { triangles: number } } } }).studio.viewer.context.triangles);

const show = async (change: Record<string, boolean>) => {
  await studio.page.evaluate((c) => (window as never as { studio: { setDisplay(c: object): void } }).studio.setDisplay(c), change);
  await settled(studio.page);
};

/** Colour of the scene at a place of the file, seen from the top. */
const colourAt = async (x: number, y: number, z: number) =>
  (await picture(studio.page)).evaluate((image, [px, py, pz]) => {
    const { viewer } = (window as never as { studio: { viewer: {
      origin: number[]; main: { camera: { matrixWorldInverse: { elements: number[] }; projectionMatrix: { elements: number[] } } };
    } } }).studio;
    const times = (m: number[], v: number[]) => [0, 1, 2, 3].map((r) => [0, 1, 2, 3].reduce((sum, c) => sum + m[4 * c + r]! * v[c]!, 0));
    const { camera } = viewer.main;
    const place = [px! - viewer.origin[0]!, py! - viewer.origin[1]!, pz! - viewer.origin[2]!, 1];
    const clip = times(camera.projectionMatrix.elements, times(camera.matrixWorldInverse.elements, place));
    const column = Math.round(((clip[0]! / clip[3]! + 1) / 2) * image.width);
    const row = Math.round(((1 - clip[1]! / clip[3]!) / 2) * image.height);
    const at = 4 * (row * image.width + column);
    return [...image.data.subarray(at, at + 3)];
  }, [x, y, z]);

/** Colours of the scene on a grid of places. */
const pixels = async (): Promise<number[][]> =>
  (await picture(studio.page)).evaluate(({ data, width, height }) => {
    const colours: number[][] = [];
    for (let y = 0; y < height; y += 8) {
      for (let x = 0; x < width; x += 8) colours.push([...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)]);
    }
    return colours;
  });

const same = (a: number[], b: number[]) => Math.max(...a.map((c, k) => Math.abs(c - b[k]!))) <= 2;

describe('faces round the surfaces', () => {
  it('come after the file has been opened', async () => {
    await expect.poll(triangles, { timeout: 10_000 }).toBe(2);
    await settled(studio.page);
  });

  it('are grey, and can be put away', async () => {
    await show({ grid: false, isocurves: false, context: true, trimmed: true });
    const grey = await pixels();
    await show({ context: false });
    const empty = await pixels();
    const changed = grey.filter((c, k) => !same(c, empty[k]!));
    expect(changed.length).toBeGreaterThan(0.05 * grey.length);
    for (const c of changed) expect(Math.max(...c) - Math.min(...c)).toBeLessThan(40); // hardly coloured
    await show({ context: true });
    expect((await pixels()).every((c, k) => same(c, grey[k]!))).toBe(true);
  });

  it('leave only what the file shows of a surface, unless all is wanted', async () => {
    // A corner of the patch, outside of the disc.
    await show({ context: false, trimmed: true });
    const cut = await colourAt(4.5, 4.5, 0);
    const kept = await colourAt(0.3, 0.4, 0);
    await show({ trimmed: false });
    expect(same(await colourAt(4.5, 4.5, 0), cut)).toBe(false);
    expect(same(await colourAt(0.3, 0.4, 0), kept)).toBe(true);
  });

  it('are met by the pointer where they are shown', async () => {
    const met = (x: number, y: number) => studio.page.evaluate(([px, py]) => {
      const { viewer } = (window as never as { studio: { viewer: {
        origin: number[]; main: { projectAll(points: number[]): Float32Array };
        pick(viewport: object, place: { clientX: number; clientY: number }): { surface: number } | null;
      } } }).studio;
      const [clientX, clientY] = viewer.main.projectAll([px!, py!, 0].map((c, d) => c - viewer.origin[d]!));
      return viewer.pick(viewer.main, { clientX: clientX!, clientY: clientY! })?.surface;
    }, [x, y]);
    await show({ context: false, trimmed: true });
    expect(await met(4.5, 4.5)).toBeUndefined();
    expect(await met(0.3, 0.4)).toBe(0);
    await show({ trimmed: false });
    expect(await met(4.5, 4.5)).toBe(0);
  });

  it('go with the file they came from', async () => {
    await studio.page.locator('summary[aria-label^=Gallery]').click();
    await studio.page.locator('details[open] .menu-item').first().click();
    await expect.poll(triangles).toBe(0);
  });
});
