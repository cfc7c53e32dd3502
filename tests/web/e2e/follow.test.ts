import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { nestedStep } from '../assembly_step';
import { commands, directoryOfFile, engineOf, execute, handled, native, openFile, question, root, saveAs, scene, settled, studioOfFile } from './page';

/** Data that the faces follow: dropped, aligned, seen as colours, followed, compared with before, checked and saved. */

const studio = studioOfFile({ width: 1100, height: 760 });
const directory = directoryOfFile();
const bonnet = join(root, 'samples/bonnet.step');
const bend = '0; 0; 8*sin(x/400)*cos(y/300)';

const panel = () => studio.page.locator('.panel[data-panel="Follow data"]');
const status = () => panel().locator('.verdict');
const state = () => status().getAttribute('data-state');
const choose = (name: string, value: string) => panel().locator(`select[aria-label="${name}"]`).selectOption(value);
const openMore = () => panel().locator('details.more').evaluateAll((all) => all.forEach((e) => ((e as HTMLDetailsElement).open = true)));
const fill = async (name: string, value: string) => {
  const field = panel().locator(`input[aria-label="${name}"]`);
  await openMore();
  await field.fill(value);
  await field.blur();
};
const slide = (name: string, value: number) => panel().locator(`input[aria-label="${name}"]`).evaluate((input, to) => {
  Object.assign(input, { value: String(to) });
  input.dispatchEvent(new Event('input'));
}, value);
const button = (name: string) => panel().locator(`button:text-is("${name}")`);
/** The rms in the line above the histogram, and its first word. */
const figures = async (): Promise<[string, number]> => {
  const [, word, rms] = /^([\w ]+): rms (\S+) mm/.exec((await panel().locator('.follow-figures .note').first().textContent())!)!;
  return [word!, Number(rms)];
};

/** Drops files on the page. */
const drop = (...files: [name: string, text: string][]) => studio.page.evaluate((all) => {
  const dataTransfer = new DataTransfer();
  for (const [name, text] of all) dataTransfer.items.add(new File([text], name));
  document.dispatchEvent(new DragEvent('drop', { dataTransfer, cancelable: true, bubbles: true }));
}, files);

interface Drawn {
  following: { distances: Float64Array };
  studio: {
    frame: { pictures: { positions: Float32Array }[] };
    viewer: {
      marks: { children: { name: string; visible: boolean; geometry: { attributes: Record<string, { array: Float32Array; count: number } | undefined> } }[] };
      placing: { assembly: { parts: { name: string; places: { matrix: number[] }[] }[] } };
      surfaces: { mesh: { geometry: { attributes: { position: { array: Float32Array } } } } }[];
    };
  };
}
/** How many points of data are drawn, and in how many colours. */
const points = () => studio.page.evaluate(() => {
  const drawn = (window as never as Drawn).studio.viewer.marks.children.find(({ name }) => name === 'data points');
  if (!drawn?.visible) return { count: 0, colours: 0 };
  const { position, color } = drawn.geometry.attributes;
  return { count: position!.count, colours: new Set(Array.from({ length: color!.count }, (_, k) => [...color!.array.slice(3 * k, 3 * k + 3)].join())).size };
});
/** How far the drawn faces are from those of the document: the largest distance, and between which z they lie. */
const faces = () => studio.page.evaluate(() => {
  const { frame, viewer } = (window as never as Drawn).studio;
  let away = 0, least = Infinity, most = -Infinity;
  frame.pictures.forEach(({ positions }, k) => {
    const { array } = viewer.surfaces[k]!.mesh.geometry.attributes.position;
    positions.forEach((x, l) => (away = Math.max(away, Math.abs(x - array[l]!))));
    for (let l = 2; l < array.length; l += 3) [least, most] = [Math.min(least, array[l]!), Math.max(most, array[l]!)];
  });
  return { away, z: [least, most] as const };
});

type Place = [number, number, number];
/** Points all over the faces of a file, about so far from each other. */
async function pointsOn(path: string, spacing: number): Promise<Place[]> {
  const obj = new TextDecoder().decode((await engineOf(path)).query('file', { name: 'mesh.obj', tolerance: 0.5 }).file);
  const corners: Place[] = [], result: Place[] = [];
  for (const line of obj.split('\n')) {
    const [word, ...rest] = line.trim().split(/\s+/);
    if (word === 'v') corners.push(rest.map(Number) as Place);
    if (word !== 'f') continue;
    const [a, b, c] = rest.map((r) => corners[parseInt(r) - 1]!) as [Place, Place, Place];
    const side = (p: Place, q: Place) => Math.hypot(...p.map((x, d) => x - q[d]!));
    const n = Math.ceil(Math.max(side(a, b), side(b, c), side(c, a)) / spacing);
    for (let i = 1 / 3; i < n; ++i) for (let j = 1 / 3; i + j < n; ++j) result.push(a.map((x, d) => x + (i / n) * (b[d]! - x) + (j / n) * (c[d]! - x)) as Place);
  }
  return result;
}
const lines = (rows: number[][]) => rows.map((row) => row.join(' ')).join('\n') + '\n';
/** By 90° about z, and away. */
const moved = ([x, y, z]: Place): Place => [-y + 2000, x - 300, z + 700];

/** The bonnet bent, where the data come from. */
const bent = join(directory, 'bent.step');
let scan: Place[] = [];
beforeAll(async () => {
  writeFileSync(bent, (await engineOf(bonnet)).query('morphed', { space: bend }).file);
  scan = await pointsOn(bent, 60);
});

it('compares a dropped scan with the document, once it is aligned', async () => {
  const { page } = studio;
  await openFile(page, bonnet);
  expect(await points()).toEqual({ count: 0, colours: 0 });
  await drop(['scan.xyz', lines(scan.map(moved))]);
  await expect.poll(state).toBe('failed');
  expect(await status().textContent()).toMatch(/^The data cannot be compared: None of [\d,]+ points .*“Align”/);
  expect(await panel().getAttribute('open')).not.toBeNull();
  expect(await panel().locator('select[aria-label="What the data are"]').inputValue()).toBe('scan');
  await button('Align').click();
  await expect.poll(state, { timeout: 60_000 }).toBe('compared');
  expect(await status().textContent()).toMatch(new RegExp(`^scan\\.xyz: [\\d,]+ of ${scan.length.toLocaleString('en')} points compared.*Aligned by 90.?\\d*° and`));
  const [word, rms] = await figures();
  expect(word).toBe('Distance');
  expect(rms).toBeGreaterThan(1);
  expect((await points()).count).toBe(scan.length);
  expect((await points()).colours).toBeGreaterThan(100);
  expect((await commands(page)).some((c) => c.do === 'morph')).toBe(false); // nothing has moved
});

it('shows limits in colours and in the histogram', async () => {
  const said = () => panel().locator('.follow-bins').getAttribute('aria-label');
  const inside = async () => Number(/: ([\d,]+) within/.exec((await said())!)![1]!.replaceAll(',', ''));
  const all = await studio.page.evaluate(() => [...(window as never as Drawn).following.distances].filter((x) => !Number.isNaN(x)));
  expect((await inside()) / all.length).toBeGreaterThanOrEqual(0.95);
  await fill('Limits of the colours', '2 mm');
  expect(await inside()).toBe(all.filter((x) => Math.abs(x) <= 2).length);
  expect(await said()).toContain(`${all.filter((x) => x < -2).length.toLocaleString('en')} below, ${all.filter((x) => x > 2).length.toLocaleString('en')} above`);
  expect(await studio.page.locator('.deviation-legend').textContent()).toContain('−202');
  expect(await panel().locator('.follow-bins line.limit').count()).toBe(2);
  const counts = await panel().locator('.follow-bins rect').evaluateAll((bars) => bars.map((b) => Number(b.getAttribute('height'))));
  expect(Math.max(...counts)).toBe(64);
  await fill('Limits of the colours', 'wide');
  expect(await panel().locator('.refusal').textContent()).toContain('not a number');
  await fill('Limits of the colours', '');
});

it('is stopped as every command, and keeps its data', async () => {
  const { page } = studio;
  await button('Morph').click();
  await page.locator('.busy button').click();
  await page.locator('.notice', { hasText: 'Stopped: the document is as it was before.' }).waitFor();
  await expect.poll(state, { timeout: 60_000 }).toBe('compared');
  expect(await status().textContent()).toMatch(/^scan\.xyz: .* compared.* Aligned/);
  expect((await commands(page)).some((c) => c.do === 'morph')).toBe(false);
});

it('follows, and slides between before and after', async () => {
  const { page } = studio;
  const before = await faces();
  await fill('Noise', '0.05 mm');
  expect(await state()).toBe('compared'); // that is of no importance here
  await button('Morph').click();
  await expect.poll(state, { timeout: 120_000 }).toBe('followed');
  await expect.poll(async () => (await figures())[0]).toBe('After');
  await expect.poll(async () => (await figures())[1]).toBeLessThan(0.3);
  expect((await commands(page)).at(-1)).toMatchObject({ do: 'morph', align: true, noise: 0.05 });
  const after = await faces();
  expect(after.away).toBe(0);
  await slide('Before to after', 0);
  expect((await figures())[0]).toBe('Before');
  expect((await faces()).away).toBeGreaterThan(4);
  (await faces()).z.forEach((z, k) => expect(z).toBeCloseTo(before.z[k]!, 1)); // on other grids
  await slide('Before to after', 0.5);
  const half = await faces();
  expect(half.away).toBeGreaterThan(2);
  expect((await figures())[0]).toBe('On the way');
  await slide('Before to after', 0);
  expect((await faces()).away).toBeCloseTo(2 * half.away, 2); // linear
  await slide('Before to after', 1);
  expect(await faces()).toEqual(after);
  await slide('Scale of the displacements', -1);
  expect((await faces()).away).toBeCloseTo(4 * half.away, 1);
  await slide('Scale of the displacements', 1);
  expect(await faces()).toEqual(after);
});

it('leads to the check, and saves a file that passes it', async () => {
  const { page } = studio;
  await button('Check edges').click();
  await expect.poll(() => page.locator('.panel[data-panel=Edges] .verdict').textContent(), { timeout: 30_000 }).toMatch(/^Passed class B/);
  const saved = await saveAs(page, directory, 'CAD file');
  // Exit code 1 would be an error here.
  expect(execFileSync(native, ['check', saved, '--against', bonnet, '--class', 'a'], { encoding: 'utf8' })).toContain('passed');
  const left = (await engineOf(saved)).query('deviation', { scan: new TextEncoder().encode(lines(scan.map(moved))), align: true });
  expect(left.deviation.rms).toBeLessThan(0.3);
});

it('compares again what was taken back', async () => {
  const { page } = studio;
  await page.keyboard.press('Escape');
  await page.locator('.viewer').click({ position: { x: 5, y: 300 } });
  await page.keyboard.press('Control+z');
  await settled(page);
  if ((await state()) !== 'compared') await button('Compare again').click();
  await expect.poll(state, { timeout: 60_000 }).toBe('compared');
  await expect.poll(async () => (await figures())[0]).toBe('Distance');
  expect((await figures())[1]).toBeGreaterThan(1);
});

it('takes displacements, and shows where they lead at once', async () => {
  const { page } = studio;
  const rows = (await pointsOn(bonnet, 60)).map(([x, y, z]) => [x, y, z, 0, 0, 8 * Math.sin(x / 400) * Math.cos(y / 300)]);
  await drop(['springback.csv', `x,y,z,dx,dy,dz\n${rows.map((r) => r.join()).join('\n')}\n`]);
  await expect.poll(() => status().textContent(), { timeout: 60_000 }).toMatch(/^springback\.csv: .* compared/);
  expect(await panel().locator('select[aria-label="What the data are"]').inputValue()).toBe('vectors');
  expect(await button('Align').count()).toBe(0);
  const [, rms] = await figures();
  await slide('Scale of the displacements', -2);
  expect(await panel().locator('input[aria-label="Scale, a number"]').inputValue()).toBe('-2');
  expect((await figures())[1]).toBeCloseTo(2 * rms, 2);
  await fill('Scale, a number', '-1');
  await button('Morph').click();
  await expect.poll(state, { timeout: 120_000 }).toBe('followed');
  await expect.poll(async () => (await figures())[1]).toBeLessThan(0.05);
  expect((await commands(page)).at(-1)).toMatchObject({ do: 'morph', scale: -1 });
  await execute(page, { do: 'select', surface: '#285' }); // it is none of the work that would be lost
  await fill('Scale, a number', '0.5');
  await button('Morph again at this scale').click();
  await expect.poll(async () => ((await commands(page)).at(-1) as { scale?: number }).scale, { timeout: 120_000 }).toBe(0.5);
  expect((await commands(page)).filter((c) => c.do === 'morph').length).toBe(1);
  await expect.poll(state).toBe('followed');
});

it('does not take back what was done since', async () => {
  const { page } = studio;
  await execute(page, { do: 'select', surface: '#285' }, { do: 'measure', name: 'middle' });
  await fill('Scale, a number', '1');
  await button('Morph again at this scale').click();
  await page.locator('.notice', { hasText: 'Something was done since the faces have followed.' }).waitFor();
  expect((await commands(page)).map((c) => c.do)).toEqual(['morph', 'select', 'measure']);
});

it('opens a document and its data that are dropped together', async () => {
  const { page } = studio;
  const before = await handled(page);
  await drop(['few.xyz', '600 0 100\n700 0 120\n800 50 150\n'], ['again.step', readFileSync(bonnet, 'utf8')]);
  await question(page).locator('button', { hasText: 'Open without saving' }).click();
  await expect.poll(() => handled(page)).toBe(before + 2);
  expect(await page.locator('.document-name').textContent()).toBe('again.step');
  await expect.poll(() => status().textContent(), { timeout: 60_000 }).toMatch(/few\.xyz|cannot be compared/);
});

it('offers the places of a part, and takes the data for those of one', async () => {
  const { page } = studio;
  const path = join(directory, 'door.step');
  writeFileSync(path, nestedStep());
  await openFile(page, path);
  const about = (x: number, y: number) => lines(Array.from({ length: 81 }, (_, k) => [(k % 9) - 4 + x, Math.floor(k / 9) - 4 + y, 0.1]));
  const places = await page.evaluate(() => (window as never as Drawn).studio.viewer.placing.assembly.parts.find(({ name }) => name === 'pin')!
    .places.map(({ matrix }) => [matrix[3]!, matrix[7]!] as const));
  await drop(['pin.xyz', about(...places[0]!)]); // where the part is sought as long as nobody has said
  await choose('Unit of the data', 'mm');
  await expect.poll(() => status().textContent(), { timeout: 60_000 }).toContain('stands in 7 places');
  expect(await status().textContent()).toContain('“Place”');
  expect(await panel().locator('select[aria-label^="Place of"]').count()).toBe(2);
  const place = panel().locator('select[aria-label="Place of pin"]');
  const names = await place.locator('option').allTextContents();
  expect(names.length).toBe(8);
  await place.selectOption(names[2]!);
  await expect.poll(() => status().textContent(), { timeout: 60_000 }).toContain('None of 81 points');
  await drop(['pin.xyz', about(...places[1]!)]);
  await expect.poll(() => status().textContent(), { timeout: 60_000 }).toContain('81 of 81 points compared');
  expect(await place.inputValue()).toBe(names[2]!);
  expect((await figures())[1]).toBeCloseTo(0.1, 6);
});

it('has further settings, told by the engine', async () => {
  const { page } = studio;
  await openFile(page, bonnet);
  const rows = (await pointsOn(bonnet, 100)).map(([x, y, z]) => [x, y, z, 0, 0, 8 * Math.sin(x / 400) * Math.cos(y / 300)]);
  await drop(['springback.txt', lines(rows)]);
  await expect.poll(state, { timeout: 60_000 }).toBe('compared');
  const tolerance = panel().locator('input[aria-label="Tolerance"]');
  const more = panel().locator('details.more');
  if ((await more.getAttribute('open')) === null) await more.locator('summary').click();
  expect(await panel().locator('.field', { has: page.locator('input[aria-label="Tolerance"]') }).getAttribute('title')).toBe("Largest residual wanted, in the file's unit");
  await fill('Tolerance', '0.02 mm');
  await fill('Refine up to, times', '4');
  expect(await state()).toBe('compared'); // these change nothing of it
  await fill('Refine up to, times', '0.5');
  expect(await panel().locator('.refusal').textContent()).toContain('from 1 to 1000');
  await fill('Refine up to, times', '4');
  await execute(page, { do: 'select', surface: '#285' });
  await panel().locator('button[aria-label="Fixed: those that are selected"]').click();
  await expect.poll(() => panel().locator('[data-faces=keep]').textContent()).not.toBe('None');
  await expect.poll(state, { timeout: 60_000 }).toBe('compared');
  expect(await tolerance.isVisible()).toBe(true);
  expect(await panel().locator('[data-faces=faces]').textContent()).toBe('All faces');
  await button('Morph').click();
  await expect.poll(state, { timeout: 120_000 }).toBe('followed');
  expect((await commands(page)).at(-1)).toMatchObject({ do: 'morph', tolerance: 0.02, refine: 4, keep: ['#285'] });
  await panel().locator('button[aria-label="Fixed: none"]').click();
  await expect.poll(() => panel().locator('[data-faces=keep]').textContent()).toBe('None');
});

it('draws two hundred thousand points at once, and tells the phases of the morph', async () => {
  const { page } = studio;
  await openFile(page, bonnet);
  // About 200,000 random points, as binary PLY.
  const corners = (await pointsOn(bent, 40)).slice(0, 20_000), count = 10 * corners.length;
  const numbers = Float32Array.from({ length: 3 * count }, (_, k) => corners[Math.floor(k / 30)]![k % 3]! + 0.001 * (Math.floor(k / 3) % 10));
  const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${count}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`;
  writeFileSync(join(directory, 'many.ply'), Buffer.concat([Buffer.from(head), Buffer.from(numbers.buffer)]));
  await panel().locator('input[type=file]').setInputFiles(join(directory, 'many.ply'));
  await expect.poll(() => status().textContent(), { timeout: 60_000 }).toMatch(new RegExp(`^many\\.ply: [\\d,]+ of ${count.toLocaleString('en')} points compared`));
  expect(await points()).toMatchObject({ count });
  const drawn = await page.evaluate(() => (window as never as Drawn).studio.viewer.marks.children.filter(({ name }) => name === 'data points').map(({ geometry }) =>
    Object.values(geometry.attributes).map((a) => [a!.array.constructor.name, a!.array.length])));
  expect(drawn).toEqual([[['Float32Array', 3 * count], ['Uint16Array', 3 * count]]]); // one object, and nothing for each point
  await page.evaluate(() => {
    const w = window as never as { said: Set<string> };
    w.said = new Set();
    new MutationObserver(() => w.said.add(document.querySelector('.busy span')!.textContent!)).observe(document.querySelector('.busy')!, { childList: true, subtree: true });
  });
  await fill('Noise', '0.05 mm');
  await button('Morph').click();
  await expect.poll(state, { timeout: 120_000 }).toBe('followed');
  expect(await page.evaluate(() => [...(window as never as { said: Set<string> }).said])).toContain('Fitting the faces …');
  await expect.poll(async () => (await figures())[1]).toBeLessThan(0.3);
});

it('takes a mesh before and after', async () => {
  const triangle = (dz: number) => `v 0 0 ${dz}\nv 100 0 ${dz}\nv 0 100 ${dz}\nv 100 100 ${dz}\nf 1 2 3\nf 2 4 3\n`;
  await scene(studio.page, 'Clay sheet');
  expect(await points()).toEqual({ count: 0, colours: 0 });
  await drop(['before.obj', triangle(0)]);
  await choose('What the data are', 'pair');
  await expect.poll(() => status().textContent()).toContain('before.obj is the mesh before.');
  await drop(['after.obj', triangle(1)]);
  await expect.poll(state, { timeout: 60_000 }).toBe('compared');
  expect(await status().textContent()).toContain('before.obj and after.obj');
  expect((await figures())[1]).toBeCloseTo(1, 6);
});

it.each([[1440, 900], [1024, 768], [390, 844]])('fits a page of %i × %i', async (width, height) => {
  const { page } = studio;
  await page.setViewportSize({ width, height });
  await settled(page);
  await openMore();
  const parts = await panel().locator('button, select, input:not([hidden]), svg').all();
  expect(parts.length).toBeGreaterThan(8);
  for (const part of parts) {
    await part.scrollIntoViewIfNeeded();
    const box = (await part.boundingBox())!;
    expect([box.x >= 0, box.x + box.width <= width, box.width > 20], await part.evaluate((e) => e.outerHTML)).toEqual([true, true, true]);
  }
  const [legend, cube] = [(await page.locator('.deviation-legend').boundingBox())!, (await page.locator('.view-cube').boundingBox())!];
  expect(legend.x + legend.width).toBeLessThan(cube.x);
});

it('is worked by keys, and has names for what is in it', async () => {
  const { page } = studio;
  const scale = panel().locator('input[aria-label="Scale of the displacements"]');
  await scale.focus();
  await page.keyboard.press('Home');
  expect(await panel().locator('input[aria-label="Scale, a number"]').inputValue()).toBe('-2');
  await page.keyboard.press('End');
  await page.keyboard.press('ArrowLeft');
  expect(Number(await panel().locator('input[aria-label="Scale, a number"]').inputValue())).toBeCloseTo(1.95, 9);
  expect(await scale.getAttribute('aria-valuetext')).toBe('1.95');
  await fill('Scale, a number', '1');
  await button('Morph').focus();
  await page.keyboard.press('Enter');
  await expect.poll(state, { timeout: 60_000 }).toBe('followed');
  for (const control of await panel().locator('button, select, input:not([hidden])').all()) {
    const name = (await control.getAttribute('aria-label')) ?? (await control.textContent());
    expect(name?.trim(), await control.evaluate((e) => e.outerHTML)).toBeTruthy();
  }
  await panel().locator('summary').first().click();
  await expect.poll(points).toEqual({ count: 0, colours: 0 });
});
