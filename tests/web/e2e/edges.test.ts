import { join } from 'node:path';

import type { EdgeCheck } from '@knead/generated';
import { format } from '@studio/document/units';
import type { Command } from '@studio/engine/session_types';
import { downloaded, engineOf, execute, openFile, root, scene, settled, studioOfFile } from './page';

/** The table of edges: how the faces of the whole file meet, judged, coloured in the view, and the way to each edge. */

const studio = studioOfFile({ width: 1100, height: 700 });
const bonnet = join(root, 'samples/bonnet.step');

const panel = () => studio.page.locator('.panel[data-panel=Edges]');
const verdict = () => panel().locator('.verdict').textContent();
const choose = (name: string, value: string) => panel().locator(`select[aria-label="${name}"]`).selectOption(value);
const legend = () => studio.page.locator('.edge-legend');
const labels = () => studio.page.locator('.edge-labels .reading-label').allTextContents();
const limit = async (name: string, value: string) => {
  const field = panel().locator(`input[aria-label="Limit of ${name}"]`);
  await field.fill(value);
  await field.blur();
};
const rows = () => panel().locator('tbody tr').evaluateAll((all) => all.map((tr) => ({
  id: (tr as HTMLElement).dataset.edge!, cells: [...tr.querySelectorAll('td')].map((td) => td.textContent!), wrong: [...tr.querySelectorAll('td')].map((td) => td.classList.contains('wrong')),
})));

interface Marks {
  viewer: {
    marks: { children: { visible: boolean; name: string; geometry: { attributes: { instanceStart?: { data: { array: Float32Array; count: number } }; instanceColorStart?: { data: { array: Float32Array } } } } }[] };
    main: { projectAll(p: ArrayLike<number>): Float32Array; element: HTMLElement };
  };
}
/** Whether an edge is marked, and its extent as shares of the view. */
const mark = () => studio.page.evaluate(() => {
  const { viewer } = (window as never as { studio: Marks }).studio;
  const line = viewer.marks.children.find((c) => c.name === 'marked edge')!;
  if (!line.visible) return null;
  const places = viewer.main.projectAll(line.geometry.attributes.instanceStart!.data.array);
  const box = viewer.main.element.getBoundingClientRect();
  const xs = [...places].filter((_, k) => k % 2 === 0).map((x) => (x - box.left) / box.width), ys = [...places].filter((_, k) => k % 2 === 1).map((y) => (y - box.top) / box.height);
  return { x: [Math.min(...xs), Math.max(...xs)], y: [Math.min(...ys), Math.max(...ys)] };
});
/** How many pieces of edges are drawn, by name, and in how many colours. */
const drawn = (name: string) => studio.page.evaluate((n) => {
  const lines = (window as never as { studio: Marks }).studio.viewer.marks.children.find((c) => c.name === n)!;
  if (!lines.visible) return { pieces: 0, colours: 0 };
  const { instanceStart, instanceColorStart } = lines.geometry.attributes;
  const { array } = instanceColorStart!.data;
  const colours = new Set(Array.from({ length: array.length / 3 }, (_, k) => [...array.slice(3 * k, 3 * k + 3)].join()));
  return { pieces: instanceStart!.data.count, colours: colours.size };
}, name);

it('judges all edges of the file, with the figures of the program', async () => {
  const { page } = studio;
  await openFile(page, bonnet);
  expect(await drawn('quiet edges')).toEqual({ pieces: 0, colours: 0 }); // the panel is closed
  await panel().locator('summary').click();
  await expect.poll(verdict).toBe('Passed class B, gap 0.02 mm, angle 0.2°: no edge of 16 exceeds it.');
  expect(await panel().locator('select[aria-label="Kind of edges"] option').allTextContents()).toEqual(['All 16', 'open 8', 'sharp 8']);
  const said = (await engineOf(bonnet)).query('check', { class: 'b' });
  expect((await rows()).map(({ id }) => id).sort()).toEqual(said.edges.map(({ id }) => id).sort());
  for (const { id, cells, wrong } of await rows()) {
    const { angle } = said.edges.find((e) => e.id === id)!;
    if (angle) expect(parseFloat(cells[1]!)).toBeCloseTo(angle.value, 1);
    else expect(cells[1]).toBe('–');
    expect(wrong).toEqual([false, false, false]);
  }
  expect((await drawn('quiet edges')).pieces).toBeGreaterThan(16);
  expect((await drawn('coloured edges')).pieces).toBe(0);
  expect(await legend().textContent()).toContain('None above 0.02 mm');
  expect(await labels()).toEqual([]);
  await choose('Kind of edges', 'sharp');
  await expect.poll(async () => (await rows()).length).toBe(8);
  await choose('Kind of edges', 'all');
  const [download] = await Promise.all([page.waitForEvent('download'), panel().locator('button:text-is("Download report")').click()]);
  expect(download.suggestedFilename()).toBe('bonnet-edges.json');
  const report = JSON.parse(await downloaded(download)) as EdgeCheck;
  expect(report.edges.map(({ id, kind }) => [id, kind])).toEqual(said.edges.map(({ id, kind }) => [id, kind]));
});

it('leads to an edge, and marks it', async () => {
  const { page } = studio;
  expect(await mark()).toBeNull();
  const first = panel().locator('tbody button').first();
  expect(await first.getAttribute('aria-label')).toMatch(/^Edge #\d+, sharp, between #\d+, #\d+/);
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

it('judges by other limits without measuring again, and colours what is above', async () => {
  const { page } = studio;
  await choose('Limits of edges', 'own');
  await expect.poll(verdict).toBe('Passed gap 0.02 mm, angle 0.2°: no edge of 16 exceeds it.');
  await page.evaluate(() => {
    // No engine hears of it.
    Object.assign(window, { post: Worker.prototype.postMessage });
    Worker.prototype.postMessage = () => undefined;
  });
  try {
    await limit('gap', '0.00005');
    await expect.poll(verdict).toMatch(/^Failed gap 5e-5 mm, angle 0.2°: 4 of 16 edges, 4 by gap\./);
    expect((await rows()).map(({ wrong }) => wrong[0])).toEqual(Array.from({ length: 16 }, (_, k) => k < 4));
    expect((await drawn('coloured edges')).colours).toBeGreaterThan(1);
  } finally {
    await page.evaluate(() => {
      Worker.prototype.postMessage = (window as never as { post: typeof Worker.prototype.postMessage }).post;
    });
  }
  const field = panel().locator('input[aria-label="Limit of gap"]');
  await field.fill('0.00006');
  await page.evaluate(async () => {
    // Something comes meanwhile that the panel shows.
    const { studio: app } = window as never as { studio: { client: { acts: { shapes: number } }; changed(): void } };
    ++app.client.acts.shapes;
    app.changed();
    await new Promise(requestAnimationFrame);
  });
  expect(await field.inputValue()).toBe('0.00006'); // what was typed is not lost
  await field.blur();
  await expect.poll(verdict).toMatch(/^Failed gap 6e-5 mm, angle 0.2°: 1 of 16 edges, 1 by gap\./);
  expect((await drawn('coloured edges')).colours).toBe(1);
  expect(await labels()).toEqual(['8.65e-5 mm']);
  expect(await legend().textContent()).toContain('1 of 16 above the limit');
  // By the new limit it is another kind of edge, once the engine has looked again.
  await expect.poll(() => panel().locator('select[aria-label="Kind of edges"] option').allTextContents()).toEqual(['All 16', 'open 8', 'gap 1', 'sharp 7']);
  await choose('Colour edges by', 'none');
  await expect.poll(() => drawn('coloured edges')).toEqual({ pieces: 0, colours: 0 });
  expect(await legend().isVisible()).toBe(false);
  expect(await labels()).toEqual([]);
  await choose('Colour edges by', 'gap');
  await limit('gap', 'wide');
  expect(await panel().locator('.refusal').textContent()).toContain('not a number');
  await limit('gap', '');
  await expect.poll(verdict).toMatch(/^Passed angle 0.2°/);
  await choose('Limits of edges', 'b');
  await expect.poll(verdict).toMatch(/^Passed class B/);
});

it('measures again what was sculpted, and says what is worse than as opened', async () => {
  const { page } = studio;
  const skin = await page.evaluate(() => (window as never as { studio: { state: { surfaces: { id: string }[]; selection: number[] } } }).studio.state.surfaces[0]!.id);
  const sculpt: Command[] = [{ do: 'select', surface: skin }, { do: 'hold', mode: 'open' }, { do: 'points', rows_u: [0, 1, 2, 3, 4, 5, 6], by: [0, 0, 5] }];
  const engine = await engineOf(bonnet);
  engine.query('act', { commands: sculpt });
  const widest = format(Math.max(...engine.query('check', { class: 'b' }).faults.filter((f) => f.measure === 'gap').map((f) => f.value)));
  expect(Number(widest)).toBeGreaterThan(4); // the walls lean: their nearest points are nearer than 5
  await execute(page, ...sculpt);
  await expect.poll(async () => (await rows())[0]!.cells[0]).toBe(`${widest}▲`);
  const [worst, ...others] = await rows();
  expect(worst!.wrong[0]).toBe(true);
  expect(others.map((r) => parseFloat(r.cells[0]!)).every((gap, k, all) => gap <= Number(widest) && (k === 0 || gap <= all[k - 1]! || Number.isNaN(gap)))).toBe(true);
  await expect.poll(verdict).toMatch(/^Failed class B, .* \d+ by gap\. \d edges? (is|are) worse than as opened\.$/);
  expect((await labels())[0]).toBe(`${widest} mm`);
  expect((await drawn('coloured edges')).pieces).toBeGreaterThan(0);
  await panel().locator('thead button:text-is("Angle")').click();
  const angles = (await rows()).map((r) => parseFloat(r.cells[1]!)).filter((x) => !Number.isNaN(x));
  expect(angles).toEqual([...angles].sort((a, b) => b - a));
  expect(await panel().locator('th[aria-sort=descending]').textContent()).toBe('Angle');
  await page.keyboard.press('Control+z');
  await panel().locator('.stale', { hasText: 'Measured before the last change.' }).waitFor();
  await expect.poll(verdict).toMatch(/^Passed class B/);
  await settled(page);
  expect((await drawn('coloured edges')).pieces).toBe(0);
});

it('says why edges cannot be measured, and measures them once they can', async () => {
  const { page } = studio;
  const skin = await page.evaluate(() => (window as never as { studio: { state: { surfaces: { id: string }[] } } }).studio.state.surfaces[0]!.id);
  await execute(page, { do: 'select', surface: skin }, { do: 'release' }, { do: 'points', rows_u: [0, 1, 2, 3, 4, 5, 6], by: [0, 0, 5] });
  await expect.poll(verdict).toMatch(/^The edges cannot be measured: .*#\d+/);
  expect(await panel().locator('tbody tr').count()).toBe(0);
  await page.keyboard.press('Control+z');
  await expect.poll(verdict).toMatch(/^Passed class B/);
});

it('has names for what is in it, and is worked by keys', async () => {
  const { page } = studio;
  for (const control of await panel().locator('button, select, input').all()) {
    const name = (await control.getAttribute('aria-label')) ?? (await control.textContent());
    expect(name?.trim(), await control.evaluate((e) => e.outerHTML)).toBeTruthy();
  }
  const table = page.getByRole('table', { name: 'Edges of the document' });
  expect(await table.getByRole('columnheader').allTextContents()).toEqual(['Edge', 'Gap', 'Angle', 'Curv.']);
  expect(await table.getByRole('rowheader').count()).toBe(16);
  expect(await panel().getByRole('region', { name: 'Table of edges' }).getAttribute('tabindex')).toBe('0'); // it scrolls
  const second = table.getByRole('rowheader').nth(1).getByRole('button');
  await second.focus();
  await page.keyboard.press('Enter');
  await expect.poll(mark).not.toBeNull();
  expect(await second.getAttribute('aria-pressed')).toBe('true');
  expect(await second.evaluate((e) => e === document.activeElement)).toBe(true); // the panel was drawn anew
  await page.keyboard.press('Enter');
  await expect.poll(mark).toBeNull();
});

it('is of the document that is open, and nothing once it is closed', async () => {
  const { page } = studio;
  await panel().locator('tbody button').first().click();
  await scene(page, 'Clay sheet');
  await expect.poll(verdict).toMatch(/no edge of 4 exceeds it\.$/);
  expect(await mark()).toBeNull();
  expect(await panel().locator('select[aria-label="Kind of edges"] option').allTextContents()).toEqual(['All 4', 'open 4']);
  expect((await drawn('quiet edges')).pieces).toBeGreaterThan(0);
  await panel().locator('summary').click();
  await expect.poll(() => drawn('quiet edges')).toEqual({ pieces: 0, colours: 0 });
  expect(await legend().isVisible()).toBe(false);
});
