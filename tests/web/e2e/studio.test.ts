import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';

import { commands, distance, draws, native, openFile as open, positions, ready, root, scene, settled, spot, stroke, studioOfFile, directoryOfFile, saveAs } from './page';

const studio = studioOfFile();
const directory = directoryOfFile();

const openFile = (path: string, choice?: string) => open(studio.page, path, choice);

const errors = () => studio.page.locator('.notice.error');

const save = (entry: string) => saveAs(studio.page, directory, entry);

const picture = async () => studio.page.locator('.stage').screenshot();

/** Where a tool is on the page; its handle along z is above. */
const toolOnPage = (page: Page, name: string): Promise<number[]> => page.evaluate((tool) => {
  const { viewer } = (window as never as { studio: { viewer: {
    viewports: { gizmo: { getHelper(): { updateMatrixWorld(force: boolean): void } }; camera: unknown; element: HTMLElement }[];
    tools: Map<string, { object: { position: { clone(): { project(camera: unknown): { x: number; y: number } } } } }> } } }).studio;
  const viewport = viewer.viewports[0]!;
  const place = viewer.tools.get(tool)!.object.position.clone().project(viewport.camera);
  const box = viewport.element.getBoundingClientRect();
  return [box.left + ((place.x + 1) / 2) * box.width, box.top + ((1 - place.y) / 2) * box.height];
}, name);

describe('the studio', () => {
  it('begins with a sheet of clay, ready to press', async () => {
    const { page } = studio;
    expect(await page.title()).toContain('Knead studio');
    const flat = await positions(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [30, 0], [60, 0]);
    const pressed = await positions(page);
    expect(distance(flat, pressed)).toBeGreaterThan(1);
    // A stroke is one entry of the history, and clay: no tool is left and the shape stays.
    expect((await commands(page)).at(-1)!.do).toBe('remove');
    await page.keyboard.press('Control+z');
    await settled(page);
    expect(distance(await positions(page), flat)).toBe(0);
    await page.keyboard.press('Control+Shift+z');
    await settled(page);
    expect(distance(await positions(page), pressed)).toBe(0);
  });

  it('takes a stroke back on Esc', async () => {
    const { page } = studio;
    const before = await positions(page);
    await page.mouse.move(...(await spot(page, -40, 20)));
    await page.mouse.down();
    await page.mouse.move(...(await spot(page, -20, 20)), { steps: 4 });
    await page.waitForTimeout(100);
    await page.keyboard.press('Escape');
    await page.mouse.up();
    await settled(page);
    expect(distance(await positions(page), before)).toBe(0);
  });

  it('opens a STEP file, presses a ball into it and saves what the native program reads', async () => {
    const { page } = studio;
    const bonnet = join(root, 'samples/bonnet.step');
    await openFile(bonnet);
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('bonnet.step');
    const before = await positions(page);
    await draws(page, true);
    await settled(page);
    const seen = await picture();
    await page.keyboard.press('b');
    await page.mouse.move(...(await spot(page)));
    // The first press on a surface selects it.
    await stroke(page, [0, 0], [20, 5]);
    expect(distance(before, await positions(page))).toBe(0);
    await stroke(page, [0, 0], [20, 5], [40, 10]);
    const after = await positions(page);
    expect(distance(before, after)).toBeGreaterThan(1);
    expect(after.every(Number.isFinite)).toBe(true);
    expect(Buffer.compare(seen, await picture())).not.toBe(0);
    await draws(page, false);
    const saved = await save('CAD file');
    // What is pressed goes on meeting its neighbours.
    await expect.poll(async () => (await page.locator('.notice').allTextContents()).join(' ')).toContain('All edges closed to 0.001 mm');
    const info = (file: string) => execFileSync(native, ['info', file], { encoding: 'utf8' }).replaceAll(file, '');
    // The same surfaces, degrees and nets, in a file that differs.
    expect(info(saved).match(/#\d+/g)).toEqual(info(bonnet).match(/#\d+/g));
    expect(readFileSync(saved, 'utf8')).not.toBe(readFileSync(bonnet, 'utf8'));
    await openFile(saved);
    expect(distance(await positions(page), after)).toBeLessThan(1e-3); // drawn in single precision
  });

  it('saves a Knead document that opens to the same shape with its history', async () => {
    const { page } = studio;
    await openFile(join(root, 'samples/bonnet.step'));
    await page.keyboard.press('b');
    await stroke(page, [-20, 0]); // selects
    await stroke(page, [-20, 0], [10, 0]);
    const shape = await positions(page);
    const saved = await save('Knead document');
    await openFile(join(root, 'samples/bonnet.step'));
    expect(distance(await positions(page), shape)).toBeGreaterThan(0);
    await openFile(saved);
    expect(distance(await positions(page), shape)).toBe(0);
    await expect.poll(() => page.locator('button[aria-label^="Undo"]').isEnabled()).toBe(true);
  });

  it('says what is wrong with a bad file and goes on', async () => {
    const { page } = studio;
    const before = await positions(page);
    const files: [string, string][] = [
      ['broken.step', 'this is not STEP'], ['model.dwg', 'AC1032'], ['notes.knead', '{"knead": 7}'], ['old.knead', '{"knead": 2, "name": "old", "commands": []}'], ['empty.step', ''],
      ['cut.step', readFileSync(join(root, 'samples/bonnet.step'), 'utf8').slice(0, 20_000)],
      ['wrong.knead', '{"knead": 2, "commands": [{"do": "melt"}]}'],
    ];
    for (const [name, text] of files) {
      const path = join(directory, name);
      writeFileSync(path, text);
      await openFile(path, 'New document');
      await expect.poll(() => errors().count(), { message: name }).toBe(1);
      expect((await errors().textContent())!.length).toBeGreaterThan(20);
      await errors().locator('button[aria-label=Dismiss]').click();
      expect(distance(await positions(page), before), name).toBe(0);
    }
  });

  it('moves, and takes away, a tool that was placed', async () => {
    const { page } = studio;
    await scene(page, 'Ball on a membrane');
    const before = await positions(page);
    await page.keyboard.press('.');
    await settled(page);
    expect(distance(before, await positions(page))).toBeGreaterThan(0.1);
    await page.locator('.panel[data-panel=Tools] .item').click();
    await page.locator('select[aria-label=Shape]').selectOption('box');
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'edit_tool', tool: 'ball', shape: 'box' });
    await page.locator('.panel[data-panel=Tools] button[aria-label="Take ball away"]').click();
    await settled(page);
    expect((await commands(page)).at(-1)!.do).toBe('remove');
  });

  it('drags a tool by its gizmo, and the surface follows', async () => {
    const { page } = studio;
    await scene(page, 'Ball on a membrane');
    await page.keyboard.press('v');
    await page.locator('.panel[data-panel=Tools] .item').click();
    const before = await positions(page);
    const handle = await toolOnPage(page, 'ball');
    await page.mouse.move(handle[0]!, handle[1]! - 40);
    await page.waitForTimeout(100);
    await page.mouse.down();
    await page.mouse.move(handle[0]!, handle[1]! - 10, { steps: 6 });
    await page.waitForTimeout(200);
    await page.mouse.up();
    await settled(page);
    expect((await commands(page)).map((c) => c.do)).toContain('move');
    expect(distance(before, await positions(page))).toBeGreaterThan(0.1);
    await page.keyboard.press('Control+z');
    await settled(page);
    expect(distance(before, await positions(page))).toBe(0);
  });

  it('takes the surface along when a tool is sent to a typed place', async () => {
    const { page } = studio;
    await scene(page, 'Ball on a membrane');
    await page.keyboard.press('v');
    await page.locator('.panel[data-panel=Tools] .item').click();
    const before = await positions(page);
    const lowest = (all: number[]) => Math.min(...all.filter((_, k) => k % 3 === 2));
    const count = (await commands(page)).length;
    const field = page.locator('input[aria-label="Position 3"]');
    const tool = () => page.evaluate(() => (window as never as { studio: { state: { tools: { position: number[]; size: number }[] } } }).studio.state.tools[0]!);
    const { size } = await tool();
    await field.fill(String(-size));
    await field.press('Enter');
    await expect.poll(async () => (await tool()).position[2]).toBe(-size);
    await settled(page);
    expect(lowest(await positions(page))).toBeLessThan(-1.6 * size); // in one jump it stayed above the middle of the ball
    expect((await commands(page)).slice(count).map((c) => c.do)).toContain('step');
    await page.locator('.top [aria-label^=Undo]').click();
    await settled(page);
    expect((await commands(page)).length).toBe(count); // one entry
    expect(distance(before, await positions(page))).toBe(0);
  });

  it('takes the surface along when a tool jumps', async () => {
    const { page } = studio;
    await scene(page, 'Ball on a membrane');
    await page.keyboard.press('v');
    await page.locator('.panel[data-panel=Tools] .item').click();
    const handle = await toolOnPage(page, 'ball');
    await page.mouse.move(handle[0]!, handle[1]! - 40);
    await page.waitForTimeout(100);
    await page.mouse.down();
    await page.mouse.move(handle[0]!, handle[1]! + 40); // one event
    await page.mouse.up();
    await settled(page);
    const ball = await page.evaluate(() => {
      const { state } = (window as never as { studio: { state: { tools: { position: number[]; size: number }[] } } }).studio;
      return state.tools[0]!.position[2]! - state.tools[0]!.size;
    });
    const heights = (await positions(page)).filter((_, k) => k % 3 === 2);
    expect(ball).toBeLessThan(-40);
    expect(Math.min(...heights)).toBeLessThan(0.9 * ball);
  });

  it('plays, pauses and shows four views', async () => {
    const { page } = studio;
    await scene(page, 'Trampoline');
    await page.locator('button[aria-label^="Play"]').click();
    await expect.poll(async () => (await commands(page)).find((c) => c.do === 'step')?.count ?? 0).toBeGreaterThan(3);
    await page.locator('button[aria-label^="Play"]').click();
    await settled(page);
    const steps = (await commands(page)).filter((c) => c.do === 'step');
    expect(steps.length).toBe(1); // one entry, one command
    expect(steps[0]!.count).toBeGreaterThan(3);
    await page.keyboard.press('4');
    for (const name of ['perspective', 'top', 'front', 'right']) {
      expect((await page.locator(`.view-${name}`).boundingBox())!.width).toBeGreaterThan(100);
    }
    await page.keyboard.press('4');
  });

  it('has the session again after a reload', async () => {
    const { page } = studio;
    await openFile(join(root, 'samples/bonnet.step'));
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [30, 0]);
    const shape = await positions(page);
    const count = (await commands(page)).length;
    await page.waitForSelector(`html[data-kept="${count}"]`, { state: 'attached' });
    await page.reload();
    await ready(page);
    await page.locator('.notice button', { hasText: 'Recover' }).click();
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('bonnet.step');
    await settled(page);
    expect(distance(await positions(page), shape)).toBe(0);
  });

  it('shows the shape as it was opened while a key is held', async () => {
    const { page } = studio;
    await openFile(join(root, 'samples/bonnet.step'));
    const original = await positions(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0]); // selects
    // Rows that are held leave the net as it is, so that the pictures have the same points.
    await page.evaluate(() => (window as never as { studio: { execute(c: object[]): Promise<void> } }).studio.execute([{ do: 'hold', rows: 2 }]));
    await stroke(page, [0, 0], [30, 0]);
    const shape = await positions(page);
    expect(distance(shape, original)).toBeGreaterThan(1);
    await page.keyboard.down('c');
    await settled(page);
    expect(distance(await positions(page), original)).toBe(0);
    await page.keyboard.up('c');
    await settled(page);
    expect(distance(await positions(page), shape)).toBe(0);
  });

  it('has a name for every control', async () => {
    const nameless = await studio.page.evaluate(() =>
      [...document.querySelectorAll('button, input, select, summary')]
        .filter((e) => !e.getAttribute('aria-label') && !e.textContent?.trim() && !e.closest('label'))
        .map((e) => e.outerHTML));
    expect(nameless).toEqual([]);
  });
});
