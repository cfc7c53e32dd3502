import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { commands, directoryOfFile, openFile, scene, settled, stroke, studioOfFile } from './page';

/** Measuring: numbers of the engine at picked points, in all their digits; pinned ones follow the surface. */

const studio = studioOfFile({ width: 1100, height: 700 });
const directory = directoryOfFile();
beforeAll(async () => {
  await studio.page.context().grantPermissions(['clipboard-read', 'clipboard-write'], { origin: new URL(studio.url).origin });
});

type Point = { surface: number; at: number[]; point: number[]; normal: number[]; curvature: number[] | null };
type Reading = { kind: string; name: string; points: Point[]; pinned: boolean };
const readings = (): Promise<Reading[]> => studio.page.evaluate(() =>
  (window as never as { studio: { hand: { measure: { readings: Reading[] } } } }).studio.hand.measure.readings);
const panel = () => studio.page.locator('.panel[data-panel=Measure]');
/** What the panel says of a reading, by its labels. */
const said = async (name: string): Promise<Record<string, string>> => {
  const list = panel().locator(`li[data-reading="${name}"]`);
  const [labels, values] = [await list.locator('dt').allTextContents(), await list.locator('dd').allTextContents()];
  return Object.fromEntries(labels.map((l, k) => [l, values[k]!]));
};
const spotOf = (place: number[]): Promise<[number, number]> => studio.page.evaluate((p) => {
  const { viewer } = (window as never as { studio: { viewer: { origin: number[]; main: { projectAll(points: number[]): Float32Array } } } }).studio;
  const [x, y] = viewer.main.projectAll(p.map((c, d) => c - viewer.origin[d]!));
  return [x!, y!] as [number, number];
}, place);
const click = async (...places: number[][]) => {
  for (const place of places) {
    await studio.page.mouse.click(...(await spotOf(place)));
    await settled(studio.page);
  }
};
const kind = (name: string) => panel().locator(`button:text-is("${name}")`).click();
const execute = (list: object[]) => studio.page.evaluate((c) => (window as never as { studio: { execute(c: object[]): Promise<unknown> } }).studio.execute(c), list);

describe('on the clay sheet', () => {
  beforeAll(() => scene(studio.page, 'Clay sheet'));

  it('a distance is that of two points, in all its digits, and moves nothing', async () => {
    const { page } = studio;
    const before = await commands(page);
    await page.keyboard.press('q');
    await click([40, 60, 0], [160, 110, 0]);
    const [reading] = await readings();
    const [a, b] = reading!.points.map((p) => p.point);
    // The picked places to a pixel, and the numbers to all digits of the points.
    expect(Math.hypot(a![0]! - 40, a![1]! - 60, a![2]!)).toBeLessThan(1);
    expect(Math.hypot(b![0]! - 160, b![1]! - 110, b![2]!)).toBeLessThan(1);
    const exact = Math.hypot(...a!.map((x, d) => x - b![d]!));
    const { distance, Δz } = await said('distance 1');
    expect(distance).toMatch(/^\d+\.\d{8,} mm$/);
    expect(Math.abs(parseFloat(distance!) - exact)).toBeLessThan(1e-9);
    expect(Δz).toBe('0 mm');
    expect(await commands(page)).toEqual(before);
    const label = page.locator('.reading-label');
    expect(parseFloat((await label.textContent())!.replace('distance ', ''))).toBeCloseTo(exact, 2);
    const [x, y] = await spotOf([100, 85, 0]);
    const box = (await label.boundingBox())!;
    expect(Math.hypot(box.x - x, box.y + box.height - y)).toBeLessThan(30);
  });

  it('angles are of three points, or of normals', async () => {
    const { page } = studio;
    await kind('Angle');
    await click([100, 50, 0], [50, 50, 0]);
    expect(await panel().locator('.note').textContent()).toContain('Click a point');
    await page.keyboard.press('Escape');
    expect(await panel().locator('.note').textContent()).toContain('Click 3 points');
    await click([150, 50, 0], [50, 50, 0], [50, 150, 0]);
    expect(Math.abs(parseFloat((await said('angle 1')).angle!) - 90)).toBeLessThan(1);
    await kind('Normals');
    await click([150, 50, 0], [50, 50, 0]);
    expect((await said('normals 1'))['angle of normals']).toBe('0°');
  });

  it('a pinned reading follows the surface as it is sculpted, and undo takes it back', async () => {
    const { page } = studio;
    await kind('Radius');
    await click([100, 100, 0]);
    expect((await said('radius 1'))['smallest radius']).toBe('flat');
    await panel().locator('button[aria-label="Pin radius 1: it follows the surface"]').click();
    await expect.poll(async () => (await readings()).find((r) => r.name === 'radius 1')?.pinned).toBe(true);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'measure', name: 'radius 1/a' });
    const [before] = (await readings()).find((r) => r.name === 'radius 1')!.points;
    await page.keyboard.press('b');
    const [x, y] = await spotOf([100, 100, 0]);
    const box = (await page.locator('.view-perspective').boundingBox())!;
    const place: [number, number] = [x - box.x - box.width / 2, y - box.y - box.height / 2];
    await stroke(page, place, place);
    const [pressed] = (await readings()).find((r) => r.name === 'radius 1')!.points;
    expect(pressed!.at).toEqual(before!.at);
    expect(pressed!.point[2]).toBeLessThan(-2);
    // Under the ball the surface is as round as the ball, or rounder.
    const radius = 1 / Math.max(...pressed!.curvature!.map(Math.abs));
    expect(radius).toBeLessThan(60);
    expect(parseFloat((await said('radius 1'))['smallest radius']!)).toBeCloseTo(radius, 9);
    expect(parseFloat((await said('radius 1')).z!)).toBeCloseTo(pressed!.point[2]!, 9);
    await page.keyboard.press('Control+z');
    await settled(page);
    expect((await readings()).find((r) => r.name === 'radius 1')!.points[0]!.point).toEqual(before!.point);
  });

  it('readings are copied as text, and removed', async () => {
    const { page } = studio;
    await panel().locator('button:text-is("Copy all")').click();
    await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/^radius 1\n {2}smallest radius flat[^]*distance 1\n {2}distance \d+\.\d+ mm/);
    await panel().locator('button[aria-label="Remove radius 1"]').click();
    await expect.poll(async () => (await readings()).map((r) => r.name)).toEqual(['distance 1', 'angle 1', 'normals 1']);
    expect((await commands(page)).at(-1)).toEqual({ do: 'remove', measurement: 'radius 1/a' });
    await panel().locator('button[aria-label="Remove angle 1"]').click();
    expect((await readings()).map((r) => r.name)).toEqual(['distance 1', 'normals 1']);
    await scene(page, 'Hull');
    expect(await readings()).toEqual([]);
    expect(await page.locator('.reading-label').count()).toBe(0);
  });
});

it('the radius of a cylinder is exact', async () => {
  const { page } = studio;
  await execute([{ do: 'new', name: 'pipe', shape: 'cylinder', radius: 30, height: 80, position: [500, 0, 0] }]);
  await page.keyboard.press('q');
  await page.keyboard.press('1');
  await page.keyboard.press('Shift+F');
  await settled(page);
  await kind('Radius');
  const middle = await page.evaluate(() => {
    const { surfaces } = (window as never as { studio: { state: { surfaces: { lower: number[]; upper: number[] }[] } } }).studio.state;
    const { lower, upper } = surfaces.at(-1)!;
    return lower.map((x, d) => (d === 1 ? x : (x + upper[d]!) / 2)); // of its front
  });
  await click(middle);
  const values = await said('radius 1');
  expect(Math.abs(parseFloat(values['smallest radius']!) - 30)).toBeLessThan(1e-9);
  expect(values['largest radius']).toBe('flat');
});

it('points that trims hide are not there', async () => {
  const { page } = studio;
  const path = join(directory, 'faces.step');
  writeFileSync(path, facesStep());
  await openFile(page, path);
  await page.waitForFunction(() => (window as never as { studio: { viewer: { trimOf(k: number): unknown } } }).studio.viewer.trimOf(0) !== null);
  await page.keyboard.press('q');
  await page.keyboard.press('3');
  await kind('Radius');
  await click([4.6, 4.6, 0]); // of the patch, not of the disc on it: the plane below
  await click([1, 1, 0]);
  expect((await readings()).map((r) => [r.points[0]!.surface, r.points[0]!.point[2]])).toEqual([[-1, -4], [0, 0]]);
});

it('grey faces are measured like surfaces, but not pinned, and F shows the one that was clicked', async () => {
  const { page } = studio;
  await page.keyboard.press('Shift+F');
  await settled(page);
  await kind('Distance');
  await click([0, 1, 0], [-15, 10, -4]);
  const [a, b] = (await readings()).find((r) => r.name === 'distance 1')!.points;
  expect([a!.surface, b!.surface]).toEqual([0, -1]);
  expect(b!.point[2]).toBe(-4);
  expect(Math.hypot(b!.point[0]! + 15, b!.point[1]! - 10)).toBeLessThan(0.2); // the pixel
  expect(b!.normal).toEqual([0, 0, 1]);
  expect((await said('distance 1'))['Δz']).toMatch(/^-4 /);
  expect(await panel().locator('li[data-reading="distance 1"] button').first().isDisabled()).toBe(true);
  // From near, the whole face.
  const height = (near: number | null) => page.evaluate((zoom) => {
    const { main, origin } = (window as never as { studio: { viewer: { origin: number[]; main: { placement(): { height: number }; restore(p: object): void } } } }).studio.viewer;
    const to = [-15, 10, -4].map((x, d) => x - origin[d]!);
    if (zoom) main.restore({ ...main.placement(), target: to, position: [to[0], to[1], to[2]! + 1], height: zoom });
    return main.placement().height;
  }, near);
  await page.keyboard.press('v');
  expect(await height(3)).toBeCloseTo(3, 6);
  await click([-15, 10, -4]);
  await page.keyboard.press('f');
  expect(await height(null)).toBeGreaterThan(40);
});
