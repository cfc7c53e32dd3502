import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { directoryOfFile, draws, openFile, scene, screen, settled, studioOfFile } from './page';

/** A section: what lies before its plane is neither seen nor touched, and a line shows where it cuts. */

const studio = studioOfFile({ width: 1100, height: 700 });
const directory = directoryOfFile();

interface App {
  viewer: {
    origin: number[];
    main: { projectAll(points: number[]): Float32Array };
    pick(view: object, at: { clientX: number; clientY: number }): { point: { toArray(): number[] } } | null;
    section: { on: boolean; cut: { geometry: { attributes: { instanceStart?: { data: { array: Float32Array } } } } } };
  };
}
/** Where a place of the file is on the page, and what a pointer there meets: in the file's coordinates. */
const at = (place: number[]) => studio.page.evaluate((p) => {
  const { viewer } = (window as never as { studio: App }).studio;
  const [x, y] = viewer.main.projectAll(p.map((c, d) => c - viewer.origin[d]!));
  const hit = viewer.pick(viewer.main, { clientX: x!, clientY: y! });
  return { x: x!, y: y!, hit: hit && hit.point.toArray().map((c, d) => c + viewer.origin[d]!) };
}, place);
/** All places on the cut lines. */
const cut = () => studio.page.evaluate(() => {
  const { section, origin } = (window as never as { studio: App }).studio.viewer;
  return [...(section.cut.geometry.attributes.instanceStart?.data.array ?? [])].map((x, k) => x + origin[k % 3]!);
});
const on = () => studio.page.evaluate(() => (window as never as { studio: App }).studio.viewer.section.on);
/** The colour that is drawn at a place of the page. */
const drawn = async ({ x, y }: { x: number; y: number }) => (await screen(studio.page)).evaluate(({ data, width }, [px, py]) => {
  const box = document.querySelector<HTMLCanvasElement>('.viewer-canvas')!.getBoundingClientRect();
  const scale = width / box.width;
  const at = 4 * (Math.round((py! - box.top) * scale) * width + Math.round((px! - box.left) * scale));
  return [...data.subarray(at, at + 3)];
}, [x, y]);
const handle = () => studio.page.locator('.section-handle');
const value = async () => Number(await handle().getAttribute('aria-valuenow'));

describe('a section across x', () => {
  it('is off at first', async () => {
    await scene(studio.page, 'Clay sheet');
    expect(await on()).toBe(false);
    expect(await handle().isVisible()).toBe(false);
  });

  it('hides what is on the side of the eye, and the pointer meets only the rest', async () => {
    const { page } = studio;
    const [near, far] = [[150, 100, 0], [50, 100, 0]];
    await draws(page, true);
    await settled(page);
    const before = [await drawn(await at(near)), await drawn(await at(far))];
    await page.keyboard.press('x');
    await settled(page);
    expect(await on()).toBe(true);
    const hidden = await at(near), kept = await at(far);
    expect(hidden.hit).toBeNull();
    expect(Math.hypot(...kept.hit!.map((c, d) => c - far[d]!))).toBeLessThan(0.01);
    expect(await drawn(hidden)).not.toEqual(before[0]);
    expect(await drawn(kept)).toEqual(before[1]);
    // A stroke there does nothing: it turns the view.
    await page.keyboard.press('b');
    const position = (await at(far)).x;
    await page.mouse.move(hidden.x, hidden.y);
    await page.mouse.down();
    await page.mouse.move(hidden.x + 30, hidden.y, { steps: 3 });
    await page.mouse.up();
    await settled(page);
    expect(Math.abs((await at(far)).x - position)).toBeGreaterThan(1);
    await page.keyboard.press('0');
  });

  it('draws a line where it cuts', async () => {
    const { page } = studio;
    await settled(page);
    const places = await cut();
    expect(places.length).toBeGreaterThan(60);
    expect(Math.max(...places.filter((_, k) => k % 3 === 0).map((x) => Math.abs(x - 100)))).toBeLessThan(1e-3);
    const ys = places.filter((_, k) => k % 3 === 1);
    expect(Math.min(...ys)).toBeLessThan(1e-3);
    expect(Math.max(...ys)).toBeGreaterThan(199.9);
    const red = await drawn(await at([100, 60, 0]));
    expect(red[0]!).toBeGreaterThan(red[2]! + 60);
    await draws(page, false);
  });

  it('moves by its handle, by keys, by its slider and by numbers', async () => {
    const { page } = studio;
    expect(await value()).toBeCloseTo(100, 6);
    const box = (await handle().boundingBox())!;
    const [a, b] = [await at([100, 100, 0]), await at([140, 100, 0])];
    await page.mouse.move(box.x + 13, box.y + 13);
    await page.mouse.down();
    await page.mouse.move(box.x + 13 + (b.x - a.x), box.y + 13 + (b.y - a.y), { steps: 8 });
    await page.mouse.up();
    await settled(page);
    expect(Math.abs((await value()) - 140)).toBeLessThan(12); // perspective: the handle is not at that place
    expect((await at([120, 100, 0])).hit).not.toBeNull();
    await handle().focus();
    const before = await value();
    await page.keyboard.press('ArrowDown');
    await expect.poll(value).toBeCloseTo(before - 2, 6);
    const panel = page.locator('.panel[data-panel=Views]');
    await panel.locator('summary').click();
    await panel.locator('input[aria-label="Position of the section in numbers"]').fill('3 cm');
    await page.keyboard.press('Enter');
    await settled(page);
    expect(await value()).toBeCloseTo(30, 6);
    expect((await at([50, 100, 0])).hit).toBeNull();
    expect((await at([20, 100, 0])).hit).not.toBeNull();
    await panel.locator('button:text-is("Flip")').click();
    await settled(page);
    expect((await at([50, 100, 0])).hit).not.toBeNull();
    expect((await at([20, 100, 0])).hit).toBeNull();
  });

  it('ends with Esc, and with its button', async () => {
    const { page } = studio;
    await page.locator('.view-perspective').focus();
    await page.keyboard.press('Escape');
    await settled(page);
    expect(await on()).toBe(false);
    expect(await handle().isVisible()).toBe(false);
    expect((await at([20, 100, 0])).hit).not.toBeNull();
    const button = page.locator('.view-cube button[aria-label^=Section]');
    await button.click();
    expect(await on()).toBe(true);
    expect(await button.getAttribute('aria-pressed')).toBe('true');
    await button.click();
    expect(await on()).toBe(false);
  });
});

describe('a section of a file', () => {
  it('cuts what the trims leave, and the grey faces', async () => {
    const { page } = studio;
    const path = join(directory, 'faces.step');
    writeFileSync(path, facesStep());
    await openFile(page, path);
    await page.waitForFunction(() => (window as never as { studio: { viewer: { context: { triangles: number } } } }).studio.viewer.context.triangles > 0);
    await page.keyboard.press('Shift+F');
    const panel = page.locator('.panel[data-panel=Views]');
    await panel.locator('button:text-is("X")').click();
    await settled(page);
    const places = await cut();
    const of = (z: number) => places.filter((_, k) => k % 3 === 1 && Math.abs(places[k + 1]! - z) < 1e-3);
    // The disc of radius 4 on the patch of 10, and the square of 40 below it.
    expect(Math.max(...of(0).map(Math.abs))).toBeGreaterThan(3.5);
    expect(Math.max(...of(0).map(Math.abs))).toBeLessThan(4.01);
    expect(Math.max(...of(-4).map(Math.abs))).toBeCloseTo(20, 3);
    // The other axes and the direction of the view.
    for (const axis of ['Y', 'Z', 'View']) {
      await panel.locator(`button:text-is("${axis}")`).click();
      expect(await panel.locator(`button:text-is("${axis}")`).getAttribute('aria-pressed')).toBe('true');
    }
    await scene(page, 'Hull');
    expect(await on()).toBe(false);
  });
});
