import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { assemblyStep, nestedStep } from '../assembly_step';
import { collected } from '../collection';
import { commands, directoryOfFile, openFile, positions, settled, studioOfFile } from './page';

const studio = studioOfFile();
const directory = directoryOfFile();

interface Vector { x: number; y: number; z: number; set(...x: number[]): Vector; clone(): Vector; project(camera: unknown): Vector; applyMatrix4(m: unknown): Vector; toArray(): number[] }
interface App {
  viewer: {
    origin: number[]; main: { camera: unknown; element: HTMLElement; target: Vector }; workplace: { place: number; matrix: unknown }; frame: { state: { body: number | null } };
    pick(view: unknown, at: { clientX: number; clientY: number }): { surface: number; standing: { place: number; matrix: unknown }; point: Vector } | null;
    tools: { get(name: string): { object: { matrixWorld: { elements: number[] } } } | undefined };
    section: { begin(...x: unknown[]): void; on: boolean };
  };
  hand: { measure: { readings: { points: { point: number[] }[] }[] } };
}

/** Where a place of the model is on the page. */
const onPage = (x: number, y: number, z: number): Promise<[number, number]> =>
  studio.page.evaluate(([a, b, c]) => {
    const { viewer } = (window as never as { studio: App }).studio;
    const box = viewer.main.element.getBoundingClientRect();
    const p = viewer.main.target.clone().set(a! - viewer.origin[0]!, b! - viewer.origin[1]!, c! - viewer.origin[2]!).project(viewer.main.camera);
    return [box.left + ((p.x + 1) / 2) * box.width, box.top + ((1 - p.y) / 2) * box.height] as [number, number];
  }, [x, y, z]);

/** What the pointer meets there, by its place and in the model. */
const picked = (at: [number, number]) =>
  studio.page.evaluate(([clientX, clientY]) => {
    const { viewer } = (window as never as { studio: App }).studio;
    const hit = viewer.pick(viewer.main, { clientX: clientX!, clientY: clientY! });
    return hit && { place: hit.standing.place, model: hit.point.clone().applyMatrix4(hit.standing.matrix).toArray().map((x, d) => x + viewer.origin[d]!) };
  }, at);
const click = async (x: number, y: number, z: number) => {
  await studio.page.mouse.click(...(await onPage(x, y, z)));
  await settled(studio.page);
};
const workplace = () => studio.page.evaluate(() => (window as never as { studio: App }).studio.viewer.workplace.place);
const notices = () => studio.page.locator('.notice').allTextContents();

it('shows every part where the assembly puts it', async () => {
  const path = join(directory, 'table.step');
  writeFileSync(path, assemblyStep());
  await openFile(studio.page, path);
  for (const [place, model] of [[0, [20, 1, 2]], [1, [-2, 31, 0]], [2, [1, -28, 5]]] as const) {
    const hit = (await picked(await onPage(...(model as [number, number, number]))))!;
    expect(hit.place).toBe(place);
    hit.model.forEach((x, d) => expect(x).toBeCloseTo(model[d]!, 3));
  }
  expect(await picked(await onPage(0, 0, 0))).toBeNull();
});

it('lists the products, and goes to one place after the other', async () => {
  const { page } = studio;
  const tree = page.locator('.panel[data-panel=Assembly]');
  expect(await tree.locator('.item span').allTextContents()).toEqual(['plate × 3', 'foot', 'rail × 2']);
  expect(await tree.locator('.note').first().textContent()).toContain('3 parts in 6 places');
  await page.keyboard.press('Shift+F');
});

it('sculpts the part in the place that is pressed, and says that it changes in all', async () => {
  const { page } = studio;
  await page.keyboard.press('v');
  await click(0, -30, 5);
  expect(await notices()).toContainEqual(expect.stringContaining('“plate” stands in 3 places'));
  expect(await workplace()).toBe(2);
  await page.locator('.notice button[aria-label=Dismiss]').first().click();
  const flat = await positions(page);
  await page.keyboard.press('b');
  await page.locator('input[aria-label="Brush radius in units"]').fill('2');
  await page.keyboard.press('Enter');
  // In its middle the stroke goes down, where the lying plate has it.
  await page.mouse.move(...(await onPage(-1, -30, 5)));
  await page.mouse.down();
  await page.mouse.move(...(await onPage(1, -30, 5)), { steps: 4 });
  await settled(page);
  await page.mouse.up();
  await settled(page);
  const list = await commands(page);
  const path = list.filter((c) => c.do === 'stroke').flatMap((c) => ('path' in c ? (c.path as number[][]) : []));
  expect(path.length).toBeGreaterThan(1);
  for (const [x, y] of path) {
    expect(Math.abs(x!)).toBeLessThan(1.2); // of the part
    expect(Math.abs(y!)).toBeLessThan(0.2);
  }
  const pressed = await positions(page);
  const deepest = Math.min(...pressed.filter((_, k) => k % 3 === 2));
  expect(deepest).toBeLessThan(-0.3);
  expect(Math.max(...flat.filter((_, k) => k % 3 === 2))).toBe(0);
  // Upright, z of the part is along x: pressed the same.
  const hit = (await picked(await onPage(20 + deepest, 0, 0)))!;
  expect(hit.place).toBe(0);
  expect(hit.model[0]).toBeLessThan(20 - 0.2);
});

it('puts a tool where the part was clicked', async () => {
  const { page } = studio;
  await page.keyboard.press('t');
  await click(-3, 31, 0);
  const tool = (await commands(page)).find((c) => c.do === 'tool' && c.name !== 'brush');
  expect(tool, JSON.stringify(await commands(page))).toBeDefined();
  expect(await workplace()).toBe(1);
  const name = (tool as { name: string }).name;
  const world = await page.evaluate((n) => {
    const { viewer } = (window as never as { studio: App }).studio;
    return viewer.tools.get(n)!.object.matrixWorld.elements.slice(12, 15).map((x, d) => x + viewer.origin[d]!);
  }, name);
  // (x, y) of the part is at (-y, 30 + x): above (1, 3), but for the slope of the dent.
  const { position } = tool as { position: number[] };
  [-position[1]!, 30 + position[0]!, position[2]!].forEach((x, d) => expect(world[d]).toBeCloseTo(x, 4));
  expect(Math.hypot(world[0]! + 3, world[1]! - 31)).toBeLessThan(0.6);
  await page.keyboard.press('Control+z');
  await settled(page);
});

it('selects a curve of a part in the place that is clicked, and draws it there', async () => {
  const { page } = studio;
  await page.keyboard.press('v');
  await click(0, 66, 0);
  const points = () => page.evaluate(() => {
    const { viewer } = (window as never as { studio: App }).studio;
    return { place: viewer.workplace.place, body: viewer.frame.state.body };
  });
  expect(await points()).toMatchObject({ place: 0, body: 0 });
  await page.keyboard.press('g');
  await page.mouse.move(...(await onPage(0, 66, 0)));
  await page.mouse.down();
  await page.mouse.move(...(await onPage(0, 66, 3)), { steps: 4 });
  await settled(page);
  await page.mouse.up();
  await settled(page);
  const spring = (await commands(page)).filter((c) => c.do === 'force').at(-1) as never as { to: number[] };
  // Of the part: up, at its middle.
  expect(Math.abs(spring.to[0]! - 6)).toBeLessThan(1.5);
  expect(spring.to[2]!).toBeGreaterThan(0);
  await page.keyboard.press('Control+z');
  await settled(page);
});

it('measures between places', async () => {
  const { page } = studio;
  await page.keyboard.press('q');
  await click(0, -34, 5);
  await click(4, 30, 0);
  const points = () => page.evaluate(() => (window as never as { studio: App }).studio.hand.measure.readings[0]?.points.map((p) => p.point) ?? []);
  await expect.poll(async () => (await points()).length).toBe(2);
  const [a, b] = await points();
  a!.forEach((x, d) => expect(x).toBeCloseTo([0, -34, 5][d]!, 0));
  b!.forEach((x, d) => expect(x).toBeCloseTo([4, 30, 0][d]!, 0));
  expect(await page.locator('[data-reading] button[disabled]').getAttribute('title')).toContain('several places');
});

it('shows all parts of assemblies within assemblies, and their tree', async () => {
  const { page } = studio;
  const path = join(directory, 'door.step');
  writeFileSync(path, nestedStep());
  await openFile(page, path);
  const tree = page.locator('.panel[data-panel=Assembly]');
  await expect.poll(async () => (await tree.locator('.note').first().textContent()) ?? '').toContain('2 parts in 9 places');
  expect(await tree.locator('.item span').allTextContents()).toEqual(['leaf × 2', 'pin × 6', 'pin']);
  for (const [x, y] of [[0, 0], [20, 0], [60, 20], [0, 40]] as const) {
    const model = (await picked(await onPage(x, y, 0)))!.model;
    expect(Math.hypot(model[0]! - x, model[1]! - y, model[2]!)).toBeLessThan(1e-3);
  }
  expect(await picked(await onPage(20, 40, 0))).toBeNull();
});

const as1 = collected('as1-oc-214.stp');
it.skipIf(!as1)('shows as1 with all its nuts and bolts, and its tree', async () => {
  const { page } = studio;
  await openFile(page, as1!);
  const tree = page.locator('.panel[data-panel=Assembly]');
  await expect.poll(async () => (await tree.locator('.note').first().textContent()) ?? '').toContain('5 parts in 18 places');
  expect(await tree.locator('.item span').allTextContents()).toEqual(expect.arrayContaining(['nut × 2', 'nut × 6', 'bolt × 6', 'rod', 'l-bracket × 2', 'plate']));
});
