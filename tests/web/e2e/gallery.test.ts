import { figureScenes } from '@studio/document/figures';

import { distance, positions, scene, settled, studioOfFile } from './page';

/** The thesis' figures of the gallery are played by the page, as a visitor does. */

const studio = studioOfFile({ width: 700, height: 480 });

interface Page {
  studio: { state: { steps: number; surfaces: unknown[]; selection: number[] } };
}
const state = () => studio.page.evaluate(() => {
  const { steps, surfaces, selection } = (window as never as Page).studio.state;
  return { steps, surfaces: surfaces.length, selected: selection.length };
});

it('has all of Figs. 6.9 to 6.15', () => {
  const numbers = new Set(figureScenes.map(({ name }) => /^Fig\. (6\.\d+)/.exec(name)![1]));
  expect([...numbers]).toEqual(['6.9', '6.10', '6.11', '6.12', '6.13', '6.14', '6.15']);
});

it.each(figureScenes.map(({ name }) => name))('%s plays', async (name) => {
  const { page } = studio;
  await scene(page, name);
  const { surfaces, selected } = await state();
  if (name.startsWith('Fig. 6.11')) expect(selected).toBeGreaterThan(1); // its patches
  expect(selected).toBe(surfaces);
  const before = await positions(page);
  await page.keyboard.press('Space');
  await expect.poll(async () => (await state()).steps).toBeGreaterThanOrEqual(3);
  await page.keyboard.press('Space');
  await settled(page);
  expect(distance(await positions(page), before)).toBeGreaterThan(1e-4);
});
