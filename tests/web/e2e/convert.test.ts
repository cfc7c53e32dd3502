import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { commands, directoryOfFile, openFile, root, settled, studioOfFile } from './page';

/** An edge beside a face that is no spline surface: why it cannot follow is said, and one click converts that face. */

const studio = studioOfFile({ width: 1100, height: 700 });
const directory = directoryOfFile();

interface Edges {
  viewer: { context: { triangles: number }; main: { projectAll(points: ArrayLike<number>): Float32Array }; trims: unknown[] };
  hand: { edges: { points(edge: string): Float32Array | null } };
}
const edge = '#43'; // between the skin #285 and the flange #534

const triangles = () => studio.page.evaluate(() => (window as never as { studio: Edges }).studio.viewer.context.triangles);
const trims = () => studio.page.evaluate(() => (window as never as { studio: Edges }).studio.viewer.trims.length);
/** Where its middle is on the page. */
const middle = () => studio.page.evaluate((id) => {
  const { viewer, hand } = (window as never as { studio: Edges }).studio;
  const points = hand.edges.points(id);
  if (!points) return null;
  const k = 3 * Math.floor(points.length / 6);
  return [...viewer.main.projectAll(points.slice(k, k + 3))] as [number, number];
}, edge);

it('offers to convert the face beside it, and lets the edge follow', async () => {
  const { page } = studio;
  await openFile(page, join(root, 'samples/bonnet.step'));
  await expect.poll(triangles).toBeGreaterThan(0);
  const before = await triangles();
  const shown = await trims();
  await page.evaluate(() => (window as never as { studio: { select(k: number): Promise<void> } }).studio.select(0));
  await page.keyboard.press('f');
  await page.keyboard.press('d');
  await expect.poll(middle).not.toBeNull();
  await settled(page);
  await page.mouse.click(...(await middle())!);
  await page.locator('.popover button', { hasText: 'Follow' }).click();
  const notice = page.locator('.notice.error');
  await expect.poll(() => notice.textContent()).toContain('its face #454 lies on a surface of linear extrusion');
  expect(await notice.textContent()).not.toMatch(/[{}]/);
  await notice.locator('button', { hasText: 'Convert and follow' }).click();
  await expect.poll(async () => (await commands(page)).at(-1)).toMatchObject({ do: 'edge', edge, hold: 'follow' });
  await settled(page);
  // The flange is a surface of the session now, and no longer of its surroundings.
  await expect.poll(triangles).toBeLessThan(before);
  await expect.poll(trims).toBe(shown + 1);
  await page.keyboard.press('Control+z');
  await expect.poll(triangles).toBe(before);
  await expect.poll(trims).toBe(shown);
});

it.each([false, true])('makes a grey face that is clicked a spline surface, held and ready to be pressed; alone: %s', async (alone) => {
  const { page } = studio;
  const path = join(directory, 'grey.step');
  writeFileSync(path, facesStep(alone));
  await openFile(page, path);
  await expect.poll(triangles).toBe(2);
  if (alone) await expect.poll(() => page.locator('.notice').allTextContents().then((all) => all.join(' '))).toContain('click one to make it one');
  await page.evaluate(() => (window as never as { studio: { hand: { choose(mode: string): void } } }).studio.hand.choose('push'));
  const corner = () => page.evaluate(() => [...(window as never as { studio: Edges }).studio.viewer.main.projectAll([8, 8, 0])] as [number, number]);
  const origin = () => page.evaluate(() => (window as never as { studio: { viewer: { origin: number[] } } }).studio.viewer.origin);
  await expect.poll(origin).toEqual([0, 0, alone ? -4 : 0]);
  await page.keyboard.press('Shift+F');
  await settled(page);
  await page.mouse.click(...(await corner()));
  const notice = page.locator('.notice', { hasText: 'lies on a plane' });
  await notice.locator('button', { hasText: 'Make it a spline surface' }).click();
  await expect.poll(triangles).toBe(0);
  await expect.poll(async () => (await commands(page)).slice(-3).map((c) => c.do)).toEqual(['select', 'material', 'evolve']);
  await expect.poll(() => page.locator('.held-badge').textContent()).toContain('4 edges held');
  await expect.poll(() => page.evaluate(() => (window as never as { studio: { documents: { waiting: boolean } } }).studio.documents.waiting)).toBe(false);
  await settled(page);
  const before = await page.evaluate(() => (window as never as { studio: { state: { surfaces: { moved: number }[] } } }).studio.state.surfaces.at(-1)!.moved);
  expect(before).toBe(0);
  const [x, y] = await corner();
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y, { steps: 4 });
  await page.mouse.up();
  await expect.poll(() => page.evaluate(() => (window as never as { studio: { state: { surfaces: { moved: number }[] } } }).studio.state.surfaces.at(-1)!.moved)).toBeGreaterThan(0);
});
