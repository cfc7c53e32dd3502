import { commands, distance, positions, settled, studioOfFile } from './page';

/** Curves, volumes and lattices under the pointer. */

const studio = studioOfFile({ width: 900, height: 620 });

interface Page {
  studio: {
    documents: { saved(): void; openScene(name: string, commands: object[]): Promise<boolean> };
    execute(commands: object[]): Promise<unknown>;
    viewer: {
      main: { projectAll(points: ArrayLike<number>): Float32Array };
      bodies: { hovered: number | null; bodies: { lines: Float32Array; points: Float32Array }[]; lattice: { points: Float32Array; lines: Float32Array } | null };
    };
    state: { body: number | null; selection: number[]; bodies: { sides: string[]; moved: number; displacement: number; upper: number[] }[]; steps: number };
  };
}

const open = async (list: object[]) => {
  await studio.page.evaluate((c) => {
    const { documents } = (window as never as Page).studio;
    documents.saved(); // nothing is asked
    return documents.openScene('bodies', c);
  }, list);
  await settled(studio.page);
};
const state = () => studio.page.evaluate(() => (window as never as Page).studio.state);

/** Where the k-th point of what is named is on the page. */
const place = (of: 'lines' | 'points' | 'lattice', k: number, body = 0): Promise<[number, number]> => studio.page.evaluate(([what, at, b]) => {
  const { main, bodies } = (window as never as Page).studio.viewer;
  const all = what === 'lattice' ? bodies.lattice!.points : bodies.bodies[b as number]![what as 'lines' | 'points'];
  const [x, y] = main.projectAll(all.slice(3 * (at as number), 3 * (at as number) + 3));
  return [x!, y!] as [number, number];
}, [of, k, body] as const);

async function dragFrom([x, y]: [number, number], dx: number, dy: number): Promise<void> {
  const { mouse } = studio.page;
  await mouse.move(x, y);
  await mouse.down();
  await mouse.move(x + dx, y + dy, { steps: 4 });
  await settled(studio.page);
  await mouse.up();
  await settled(studio.page);
}

it('a curve is lit under the pointer, selected by a click, and a point of it is dragged', async () => {
  const { page } = studio;
  await open([{ do: 'new', shape: 'curve', form: 'line', size: [200], net: [12] }, { do: 'new', shape: 'curve', form: 'circle', radius: 60 }]);
  expect((await state()).body).toBe(1);
  const at = await place('lines', 20);
  await page.mouse.move(...at);
  await expect.poll(() => page.evaluate(() => (window as never as Page).studio.viewer.bodies.hovered)).toBe(0);
  await page.keyboard.press('v');
  await page.mouse.click(...at);
  await expect.poll(async () => (await state()).body).toBe(0);
  await page.keyboard.press('e');
  await settled(page);
  await dragFrom(await place('points', 5), 0, -60);
  expect((await state()).bodies[0]!.moved).toBe(1);
  expect((await commands(page)).at(-1)).toMatchObject({ do: 'points', which: [5] });
  await page.keyboard.press('Control+z');
  await expect.poll(async () => (await state()).bodies[0]!.moved).toBe(0);
});

it('its ends are held by a click, and a spring of the hand draws it, which is one entry of the history', async () => {
  const { page } = studio;
  await page.keyboard.press('d');
  await page.mouse.click(...(await place('lines', 2)));
  await expect.poll(async () => (await state()).bodies[0]!.sides).toEqual(['u0']);
  await page.mouse.click(...(await place('lines', 2)));
  await expect.poll(async () => (await state()).bodies[0]!.sides).toEqual([]);
  await page.evaluate(() => (window as never as Page).studio.execute([{ do: 'edge' }]));
  await settled(page);
  const before = (await commands(page)).length;
  const start = await place('lines', 0);
  await page.keyboard.press('g');
  const lines = await page.evaluate(() => (window as never as Page).studio.viewer.bodies.bodies[0]!.lines.length / 3);
  const middle = await place('lines', 2 * Math.floor(lines / 4));
  await dragFrom(middle, 0, -70);
  const { bodies, steps } = await state();
  expect(steps).toBeGreaterThan(0);
  expect(bodies[0]!.displacement).toBeGreaterThan(5);
  // Its ends are where they were.
  expect((await place('lines', 0)).every((x, d) => Math.abs(x - start[d]!) < 0.5)).toBe(true);
  expect((await commands(page)).length).toBeGreaterThan(before);
  await page.keyboard.press('Control+z');
  await expect.poll(async () => (await state()).bodies[0]!.displacement).toBeLessThan(1e-9);
});

it('a point of a lattice is dragged, and the surface follows', async () => {
  const { page } = studio;
  await open([{ do: 'new', shape: 'plane', size: [200, 200], net: [8, 8] }]);
  await page.keyboard.press('e');
  await settled(page);
  await page.locator('.panel[data-panel="Control points"] button', { hasText: 'Lattice' }).click();
  await expect.poll(() => page.evaluate(() => (window as never as Page).studio.viewer.bodies.lattice?.points.length ?? 0)).toBe(3 * 64);
  await settled(page);
  const before = await positions(page);
  // An inner point on the upper side: i = j = 1, k = 3.
  await dragFrom(await place('lattice', (1 * 4 + 1) * 4 + 3), 0, -80);
  const command = (await commands(page)).at(-1) as { do: string; which: number[]; by: number[] };
  expect(command).toMatchObject({ do: 'lattice', net: [4, 4, 4], which: [23] });
  const after = await positions(page);
  const moved = after.map((x, k) => x - before[k]!);
  const most = distance(after, before);
  const length = Math.max(...command.by.map(Math.abs));
  expect(most).toBeGreaterThan(0.01 * length);
  expect(most).toBeLessThan(length);
  // Every point goes along the drag: its move is parallel to that of the lattice's point.
  const norm = command.by.reduce((sum, x) => sum + x * x, 0);
  let beside = 0;
  for (let k = 0; k < moved.length; k += 3) {
    const share = command.by.reduce((sum, x, d) => sum + moved[k + d]! * x, 0) / norm;
    command.by.forEach((x, d) => (beside = Math.max(beside, Math.abs(moved[k + d]! - share * x))));
  }
  expect(beside).toBeLessThan(1e-4 * length);
  await page.keyboard.press('Control+z');
  await expect.poll(async () => distance(await positions(page), before)).toBe(0);
});

it('the lattice stays as it is pulled, further drags go on, and it is put round the new shape when that is asked for', async () => {
  const { page } = studio;
  const block = () => page.evaluate(() => [...(window as never as Page).studio.viewer.bodies.lattice!.points]);
  const start = await block(), flat = await positions(page);
  const changed = (a: number[], b: number[]) => new Set(a.flatMap((x, k) => (Math.abs(x - b[k]!) > 1e-3 ? [Math.floor(k / 3)] : [])));
  await dragFrom(await place('lattice', 23), 0, -80);
  expect(changed(await block(), start)).toEqual(new Set([23]));
  await dragFrom(await place('lattice', 39), 0, -60);
  expect(changed(await block(), start)).toEqual(new Set([23, 39]));
  const [first, second] = (await commands(page)).slice(-2) as { do: string; which: number[]; by: number[]; again?: boolean }[];
  expect(first).toMatchObject({ do: 'lattice', which: [23] });
  expect(first!.again).not.toBe(true);
  expect(second).toMatchObject({ do: 'lattice', which: [39], again: true });
  const both = await positions(page);
  await page.keyboard.press('Control+z');
  await expect.poll(async () => changed(await block(), start)).toEqual(new Set([23]));
  await page.keyboard.press('Control+Shift+z');
  await expect.poll(async () => distance(await positions(page), both)).toBe(0);
  // The same point back to where it was, by what the journal says: the sheet is flat again but for the other's part.
  await page.evaluate((by) => (window as never as Page).studio.execute([{ do: 'lattice', net: [4, 4, 4], margin: 0.1, which: [23], by, again: true }]), first!.by.map((x) => -x));
  await page.evaluate((by) => (window as never as Page).studio.execute([{ do: 'lattice', net: [4, 4, 4], margin: 0.1, which: [39], by, again: true }]), second!.by.map((x) => -x));
  await settled(page);
  expect(distance(await positions(page), flat)).toBeLessThan(1e-4);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await expect.poll(async () => distance(await positions(page), both)).toBe(0);
  const fit = page.locator('.panel[data-panel="Control points"] button', { hasText: 'Fit anew' });
  await fit.click();
  await expect.poll(async () => changed(await block(), start).size).toBeGreaterThan(10);
  expect(await fit.count()).toBe(0);
  expect(distance(await positions(page), both)).toBe(0);
  const anew = await block();
  await dragFrom(await place('lattice', 24), -60, 0);
  expect(((await commands(page)).at(-1) as { again?: boolean }).again).not.toBe(true);
  expect(changed(await block(), anew)).toEqual(new Set([24]));
  await page.locator('.panel[data-panel="Control points"] button', { hasText: 'Lattice' }).click();
  await expect.poll(() => page.evaluate(() => (window as never as Page).studio.viewer.bodies.lattice)).toBeNull();
});
