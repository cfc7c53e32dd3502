import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { directoryOfFile, downloaded, openFile, scene, settled, spot, studioOfFile } from './page';

/** Views by name, the cube, projections, the turntable, and the views that a document keeps. */

const studio = studioOfFile({ width: 1100, height: 700 });
const directory = directoryOfFile();

interface App {
  viewer: {
    origin: number[];
    main: { axial: boolean; projectAll(points: number[]): Float32Array; target: { toArray(): number[] };
      camera: { position: { toArray(): number[] }; getWorldDirection(v: object): { toArray(): number[] } } };
  };
}
const main = () => studio.page.evaluate(() => {
  const { main: view, origin } = (window as never as { studio: App }).studio.viewer;
  const [eye, target] = [view.camera.position.toArray(), view.target.toArray()];
  const away = eye.map((x, d) => x - target[d]!);
  const length = Math.hypot(...away);
  return { from: away.map((x) => x / length), target, axial: view.axial, origin };
});
/** Where places of the file are on the page. */
const seen = (places: number[][]): Promise<number[]> => studio.page.evaluate((all) => {
  const { main: view, origin } = (window as never as { studio: App }).studio.viewer;
  return [...view.projectAll(all.flatMap((p) => p.map((x, d) => x - origin[d]!)))];
}, places);
const apart = (a: number[], b: number[]) => Math.max(...a.map((x, k) => Math.abs(x - b[k]!)));
const corners = [[0, 0, 0], [200, 0, 0], [0, 200, 0], [200, 200, 0]];

const s = Math.sqrt(1 / 3);
const named: [string, string, number[]][] = [
  ['Front', '1', [0, -1, 0]], ['Back', 'Shift+Digit1', [0, 1, 0]], ['Right', '2', [1, 0, 0]], ['Left', 'Shift+Digit2', [-1, 0, 0]],
  ['Top', '3', [0, 0, 1]], ['Bottom', 'Shift+Digit3', [0, 0, -1]], ['Isometric', '6', [s, -s, s]],
];

describe('a view with a name', () => {
  it.each(named)('%s by its key %s and by its button', async (name, key, from) => {
    const { page } = studio;
    await page.keyboard.press('0');
    expect(apart((await main()).from, from)).toBeGreaterThan(0.1);
    await page.keyboard.press(key);
    expect(apart((await main()).from, from)).toBeLessThan(1e-9);
    await page.keyboard.press('0');
    const panel = page.locator('.panel[data-panel=Views]');
    if (!(await panel.getAttribute('open').then((o) => o !== null))) await panel.locator('summary').click();
    await panel.locator(`button:text-is("${name}")`).click();
    expect(apart((await main()).from, from)).toBeLessThan(1e-9);
  });

  it('stands in the list of shortcuts', async () => {
    const { page } = studio;
    await page.keyboard.press('?');
    const keys = await page.locator('.shortcuts dt').allTextContents();
    for (const key of ['1 2 3', '6', '7', '8']) expect(keys).toContain(key);
    expect(new Set(keys).size).toBe(keys.length);
    await page.keyboard.press('Escape');
  });

  it('is turned on from by the mouse, from straight above too', async () => {
    const { page } = studio;
    await page.keyboard.press('3');
    const [x, y] = await spot(page);
    await page.mouse.move(x, y);
    await page.mouse.down({ button: 'right' });
    await page.mouse.move(x, y - 60, { steps: 4 });
    await page.mouse.up({ button: 'right' });
    const { from } = await main();
    expect(from[2]).toBeLessThan(0.99);
    expect(from[2]).toBeGreaterThan(0.7);
    expect(Math.abs(from[0]!)).toBeLessThan(1e-6);
  });
});

describe('projection', () => {
  it('is parallel or perspective; what lies at the target keeps its size', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await page.keyboard.press('1');
    // Edges of 200 mm across the line of sight, 200 mm apart in depth.
    const lengths = async () => {
      const [a, , b, , c, , d] = await seen(corners);
      return [b! - a!, d! - c!];
    };
    const [near, far] = await lengths();
    expect(near! / far!).toBeGreaterThan(1.1);
    const { target } = await main();
    await page.keyboard.press('7');
    const [alike, other] = await lengths();
    expect(Math.abs(alike! - other!)).toBeLessThan(1e-3);
    expect(alike!).toBeGreaterThan(far!);
    expect(alike!).toBeLessThan(near!);
    expect(apart((await main()).target, target)).toBeLessThan(1e-9);
    expect(await page.locator('.view-perspective .viewport-label').textContent()).toBe('Parallel');
    expect(await page.locator('.view-cube button[aria-label^=Parallel]').getAttribute('aria-pressed')).toBe('true');
    // A wheel zooms, a stroke finds the clay.
    await page.keyboard.press('0');
    await page.mouse.move(...(await spot(page)));
    await page.mouse.wheel(0, -300);
    const before = await seen(corners);
    await page.keyboard.press('7');
    await page.keyboard.press('7');
    expect(apart(await seen(corners), before)).toBeLessThan(0.01);
    await page.keyboard.press('7');
    expect(await page.locator('.view-perspective .viewport-label').textContent()).toBe('Perspective');
    expect(apart((await lengths()), [near!, far!])).toBeGreaterThan(1); // zoomed
    await page.keyboard.press('f');
  });
});

describe('the view cube', () => {
  const cube = () => studio.page.locator('.view-cube');
  const middle = async () => {
    const box = (await cube().locator('.cube-space').boundingBox())!;
    return [Math.round(box.x + box.width / 2), Math.round(box.y + box.height / 2)] as [number, number];
  };
  /** What a click at a place would press. */
  const under = ([x, y]: [number, number]) => studio.page.evaluate(([a, b]) => document.elementFromPoint(a!, b!)?.getAttribute('aria-label'), [x, y]);

  it('shows the side that is looked at', async () => {
    const { page } = studio;
    for (const [name, key] of named.slice(0, 6)) {
      await page.keyboard.press(key);
      await settled(page);
      expect(await under(await middle())).toBe(`View from ${name.toLowerCase()}`);
    }
  });

  it('turns the view by faces, edges and corners, which have names', async () => {
    const { page } = studio;
    const names = await cube().locator('.cube-zone').evaluateAll((all) => all.map((e) => e.getAttribute('aria-label')));
    expect(new Set(names).size).toBe(26);
    await page.keyboard.press('1');
    await settled(page);
    const [x, y] = await middle();
    await page.mouse.click(x + 24, y); // the edge towards the right
    expect(apart((await main()).from, [Math.SQRT1_2, -Math.SQRT1_2, 0])).toBeLessThan(1e-9);
    await page.keyboard.press('1');
    await settled(page);
    await page.mouse.click(x - 24, y - 24);
    expect(apart((await main()).from, [-s, -s, s])).toBeLessThan(1e-9);
    await settled(page);
    expect(await under(await middle())).toBe('View from top front left');
    await page.mouse.click(x, y - 20); // on the lid
    expect((await main()).from[2]).toBeGreaterThan(0.5);
  });

  it('turns the view as it is dragged, and no click comes of that', async () => {
    const { page } = studio;
    await page.keyboard.press('6');
    await settled(page);
    const before = (await main()).from;
    const [x, y] = await middle();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 15, y, { steps: 5 });
    await page.mouse.up();
    const after = (await main()).from;
    expect(Math.abs(after[2]! - before[2]!)).toBeLessThan(1e-6);
    const turned = Math.atan2(before[0]! * after[1]! - before[1]! * after[0]!, before[0]! * after[0]! + before[1]! * after[1]!);
    expect(turned).toBeCloseTo(-0.3, 1);
  });

  it('is beside the legend, and within its view of four', async () => {
    const { page } = studio;
    await page.locator('select[aria-label="Colour by"]').selectOption({ label: 'Mean curvature' });
    await page.locator('.legend-card').waitFor();
    const [a, b] = [(await cube().boundingBox())!, (await page.locator('.legend-card').boundingBox())!];
    expect(a.x + a.width <= b.x || a.y >= b.y + b.height || b.y >= a.y + a.height).toBe(true);
    await page.locator('select[aria-label="Colour by"]').selectOption('none');
    await page.keyboard.press('4');
    const view = (await page.locator('.view-perspective').boundingBox())!;
    const box = (await cube().boundingBox())!;
    expect(box.x >= view.x && box.x + box.width <= view.x + view.width).toBe(true);
    await page.keyboard.press('4');
  });

  it('leaves a view along an axis for one that can turn', async () => {
    const { page } = studio;
    await page.keyboard.press('5');
    expect((await main()).axial).toBe(true);
    await settled(page);
    const [x, y] = await middle();
    await page.mouse.click(x + 24, y - 24);
    expect((await main()).axial).toBe(false);
    expect(apart((await main()).from, [s, s, s])).toBeLessThan(1e-9);
  });
});

describe('the turntable', () => {
  it('turns slowly about the vertical, and stops at a touch', async () => {
    const { page } = studio;
    await page.keyboard.press('0');
    const start = await main();
    await page.keyboard.press('8');
    await expect.poll(async () => apart((await main()).from, start.from)).toBeGreaterThan(0.02);
    const later = await main();
    expect(Math.abs(later.from[2]! - start.from[2]!)).toBeLessThan(1e-6);
    expect(apart(later.target, start.target)).toBeLessThan(1e-6);
    expect(await page.locator('.view-cube button[aria-label^=Turntable]').getAttribute('aria-pressed')).toBe('true');
    await page.keyboard.press('v');
    await page.mouse.click(...(await spot(page, 0, -200)));
    const stopped = await main();
    await page.waitForTimeout(300);
    expect(apart((await main()).from, stopped.from)).toBe(0);
    expect(await page.locator('.view-cube button[aria-label^=Turntable]').getAttribute('aria-pressed')).toBe('false');
  });
});

describe('a view that is kept', () => {
  const panel = () => studio.page.locator('.panel[data-panel=Views]');
  const keep = async (name: string) => {
    await panel().locator('input').fill(name);
    await panel().locator('button', { hasText: 'Keep view' }).click();
  };
  const items = () => panel().locator('.list .item span').allTextContents();

  it('comes back as it was, saved with the document', async () => {
    const { page } = studio;
    await page.keyboard.press('2');
    await page.keyboard.press('7');
    await page.mouse.move(...(await spot(page, 30, 10)));
    await page.mouse.wheel(0, -200);
    await keep('The rim');
    const rim = await seen(corners);
    await page.keyboard.press('7');
    await page.keyboard.press('3'); // straight from above
    await keep('Plan');
    const plan = await seen(corners);
    await page.keyboard.press('0');
    expect(apart(await seen(corners), rim)).toBeGreaterThan(5);
    expect(await items()).toEqual(['The rim', 'Plan']);

    await page.locator('summary[aria-label=Save]').click();
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('details[open] .menu-item', { hasText: 'Knead' }).first().click()]);
    const path = join(directory, 'kept.knead');
    await download.saveAs(path);
    expect(readFileSync(path, 'utf8')).toBe(await downloaded(download));
    await scene(page, 'Hull');
    expect(await items()).toEqual([]);
    await openFile(page, path);
    expect(await items()).toEqual(['The rim', 'Plan']);
    await panel().locator('button.item', { hasText: 'Plan' }).click();
    expect(apart(await seen(corners), plan)).toBeLessThan(0.01);
    await panel().locator('button.item', { hasText: 'The rim' }).click();
    expect(apart(await seen(corners), rim)).toBeLessThan(0.01);
    await panel().locator('button[aria-label="Forget the view Plan"]').click();
    expect(await items()).toEqual(['The rim']);
    await keep('The rim');
    expect(await items()).toEqual(['The rim']);
  });
});

it('leaves room on a telephone', async () => {
  const { page } = studio;
  await page.setViewportSize({ width: 390, height: 844 });
  await settled(page);
  const cube = (await page.locator('.cube-space').boundingBox())!;
  const view = (await page.locator('.viewer').boundingBox())!;
  expect(cube.x + cube.width).toBeLessThanOrEqual(390);
  expect(cube.width * cube.height).toBeLessThan(0.06 * view.width * view.height);
});
