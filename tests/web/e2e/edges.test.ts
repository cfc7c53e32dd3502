import { join } from 'node:path';

import { openFile, root, settled, studioOfFile } from './page';

/** The table of edges: how the faces meet, the worst first, and the way to each edge. */

const studio = studioOfFile({ width: 1100, height: 700 });

const panel = () => studio.page.locator('.panel[data-panel=Edges]');
const rows = () => panel().locator('tbody tr').evaluateAll((all) => all.map((tr) => ({
  id: (tr as HTMLElement).dataset.edge!, cells: [...tr.querySelectorAll('td')].map((td) => td.textContent!), wrong: [...tr.querySelectorAll('td')].map((td) => td.classList.contains('wrong')),
})));
const execute = (list: object[]) => studio.page.evaluate((c) => (window as never as { studio: { execute(c: object[]): Promise<unknown> } }).studio.execute(c), list);
/** Whether an edge is marked, and its extent as shares of the view. */
const mark = () => studio.page.evaluate(() => {
  const { viewer } = (window as never as { studio: { viewer: {
    marks: { children: { type: string; visible: boolean; name: string; geometry: { attributes: { instanceStart?: { data: { array: Float32Array } } } } }[] };
    main: { projectAll(p: ArrayLike<number>): Float32Array; element: HTMLElement };
  } } }).studio;
  const line = viewer.marks.children.find((c) => c.name === 'marked edge')!;
  if (!line.visible) return null;
  const places = viewer.main.projectAll(line.geometry.attributes.instanceStart!.data.array);
  const box = viewer.main.element.getBoundingClientRect();
  const xs = [...places].filter((_, k) => k % 2 === 0).map((x) => (x - box.left) / box.width), ys = [...places].filter((_, k) => k % 2 === 1).map((y) => (y - box.top) / box.height);
  return { x: [Math.min(...xs), Math.max(...xs)], y: [Math.min(...ys), Math.max(...ys)] };
});

it('says that all edges of an opened solid are closed', async () => {
  const { page } = studio;
  await openFile(page, join(root, 'samples/bonnet.step'));
  await page.locator('.view-perspective').click();
  await settled(page);
  await panel().locator('summary').click();
  await expect.poll(() => panel().locator('tbody tr').count()).toBe(4);
  expect(await panel().locator('p.note').textContent()).toBe('All edges closed to 0.001 mm.');
  for (const { cells, wrong } of await rows()) {
    expect(cells.slice(2)).toEqual(['–', 'Position']); // no curvature is compared at a crease
    expect(parseFloat(cells[1]!)).toBeGreaterThan(30); // the sides of the bonnet stand on it
    expect(wrong).toEqual([false, false, false, false]);
  }
});

it('leads to an edge, and marks it', async () => {
  const { page } = studio;
  expect(await mark()).toBeNull();
  const first = panel().locator('tbody button').first();
  expect(await first.getAttribute('aria-label')).toMatch(/^Edge #\d+ between #\d+, #\d+$/);
  await first.click();
  await expect.poll(mark).not.toBeNull();
  await settled(page);
  const { x, y } = (await mark())!;
  expect([x[0]! > 0, x[1]! < 1, y[0]! > 0, y[1]! < 1]).toEqual([true, true, true, true]);
  expect(Math.max(x[1]! - x[0]!, y[1]! - y[0]!)).toBeGreaterThan(0.4);
  expect(await first.getAttribute('aria-pressed')).toBe('true');
  await first.click();
  await expect.poll(mark).toBeNull();
});

it('puts a gap first, and undo closes it', async () => {
  const { page } = studio;
  await execute([{ do: 'release' }, { do: 'points', rows_u: [0, 1, 2, 3, 4, 5, 6], by: [0, 0, 5] }]);
  await expect.poll(async () => (await rows())[0]!.cells[0]).toBe('5');
  const [worst, ...others] = await rows();
  expect(worst!.wrong[0]).toBe(true);
  expect(worst!.cells[3]).toBe('Free');
  expect(others.map((r) => parseFloat(r.cells[0]!)).every((gap, k, all) => gap <= 5.001 && (k === 0 || gap <= all[k - 1]!))).toBe(true);
  expect(await panel().locator('p.note').textContent()).toMatch(/^\d edges? (is|are) open by more than 0.001 mm, the widest by 5 mm\./);
  await panel().locator('thead button:text-is("Angle")').click();
  const angles = (await rows()).map((r) => parseFloat(r.cells[1]!));
  expect(angles).toEqual([...angles].sort((a, b) => b - a));
  expect(await panel().locator('th[aria-sort=descending]').textContent()).toBe('Angle');
  await page.keyboard.press('Control+z');
  await expect.poll(() => panel().locator('p.note').textContent()).toBe('All edges closed to 0.001 mm.');
});
