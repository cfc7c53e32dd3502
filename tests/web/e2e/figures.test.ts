import { join } from 'node:path';

import { commands, execute, openFile, root, scene, settled, stroke, studioOfFile } from './page';

/** The figures and the plot below are those of the state that is shown. */

const studio = studioOfFile();

const figures = () => studio.page.locator('.numbers > span').evaluateAll((all) =>
  Object.fromEntries(all.map((e) => [e.querySelector('small')!.textContent!, e.lastChild!.textContent!])));
/** Whether anything is drawn in the plot. */
const plotted = () => studio.page.locator('canvas.plot').evaluate((canvas: HTMLCanvasElement) =>
  canvas.toDataURL() !== Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height }).toDataURL());
const ofSteps = ['step', 'energy', 'residual'];

it('are there after a stroke, gone after smoothing, and there again once that is undone', async () => {
  const { page } = studio;
  await scene(page, 'Clay sheet');
  expect(Object.keys(await figures())).not.toContain('energy');
  await page.keyboard.press('b');
  await stroke(page, [-20, 0], [0, 0], [20, 0]);
  const pressed = await figures();
  expect(Object.keys(pressed)).toEqual(expect.arrayContaining(['steps', ...ofSteps]));
  expect(await plotted()).toBe(true);
  await page.keyboard.press('s');
  await stroke(page, [-20, 0], [20, 0]);
  expect((await commands(page)).at(-1)!.do).not.toBe('step');
  const smoothed = await figures();
  expect(smoothed.steps).toBe(pressed.steps);
  for (const name of ofSteps) expect(Object.keys(smoothed)).not.toContain(name);
  expect(await plotted()).toBe(false);
  await page.keyboard.press('Control+z');
  await settled(page);
  expect(await figures()).toMatchObject({ energy: pressed.energy, residual: pressed.residual, step: pressed.step });
  expect(await plotted()).toBe(true);
  await page.keyboard.press('Control+z');
  await settled(page);
  expect(Object.keys(await figures())).not.toContain('steps');
  expect(await plotted()).toBe(false);
});

it('are not those of a surface that was pressed before another was selected, or of another document', async () => {
  const { page } = studio;
  await openFile(page, join(root, 'samples/bonnet.step'));
  const ids = await page.evaluate(() => (window as never as { studio: { state: { surfaces: { id: string }[] } } }).studio.state.surfaces.map((s) => s.id));
  await execute(page, { do: 'select', surface: ids[0]! }, { do: 'step' });
  const pressed = await figures();
  expect(Object.keys(pressed)).toEqual(expect.arrayContaining(ofSteps));
  await execute(page, { do: 'select', surface: ids[1]! });
  for (const name of ofSteps) expect(Object.keys(await figures())).not.toContain(name);
  await execute(page, { do: 'select', surface: ids[0]! });
  expect((await figures()).energy).toBe(pressed.energy);
  await scene(page, 'Clay sheet');
  for (const name of ['steps', ...ofSteps]) expect(Object.keys(await figures())).not.toContain(name);
});
