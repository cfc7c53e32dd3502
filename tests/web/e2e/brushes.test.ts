import type { Command, Vector3 } from '@studio/engine/session_types';

import { commands, drag, positions, settled, spot, studioOfFile, directoryOfFile, drawnBy, engineOf, saveAs } from './page';

/** Brushes, from the pointer's events to the saved file. */

const studio = studioOfFile();
const directory = directoryOfFile();

interface Page {
  hand: { brush: { settings: { radius: number } }; surfaceBrush: { settings: Record<string, unknown> } };
  documents: { startFresh(name: string, commands: Command[]): Promise<unknown> };
}

const radius = 25, side = 200;
/** Pressure of a pen where its strokes begin. */
const least = 0.25;
const sheet: Command[] = [{ do: 'new', size: [side, side], net: [48, 48] }, { do: 'edge' }];
const bumps: Command[] = [
  { do: 'brush', kind: 'pull', radius: 40, height: 6, path: [[0.45, 0.5]] }, { do: 'brush', kind: 'push', radius: 14, height: 2, path: [[0.55, 0.5]] },
];

async function begin(kind: string, more: Command[] = [], settings: Record<string, unknown> = {}): Promise<void> {
  const { page } = studio;
  await page.evaluate(async (list) => { await (window as never as { studio: Page }).studio.documents.startFresh('sheet', list); }, [...sheet, ...more]);
  await settled(page); // the page gives a new document a radius of its own
  await page.evaluate(({ size, brush }) => {
    const { hand } = (window as never as { studio: Page }).studio;
    hand.brush.settings.radius = size;
    Object.assign(hand.surfaceBrush.settings, brush);
  }, { size: radius, brush: { strength: 0.5, mirror: null, radial: 1, steady: 0, presses: 'depth', tilt: false, ...settings } });
  await settled(page);
  await page.keyboard.press('w');
  await choose(kind);
}

const choose = (kind: string) => studio.page.locator('[data-panel=Brush] .chip', { hasText: new RegExp(`^${kind}$`) }).click();

const led = (from: [number, number], to: [number, number], moves: number) => drag(studio.page, from, to, moves);

/** One stroke of a pen between places of the middle view, the harder the farther; leaning to the right by so many degrees. */
async function penned(from: [number, number], to: [number, number], moves: number, lean = 0): Promise<void> {
  const { page } = studio;
  const devtools = await page.context().newCDPSession(page);
  const event = async (type: 'mousePressed' | 'mouseMoved' | 'mouseReleased', share: number) => {
    const [x, y] = await spot(page, from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]));
    await devtools.send('Input.dispatchMouseEvent', {
      type, x, y, button: 'left', buttons: 1, clickCount: 1, pointerType: 'pen', force: least + (1 - least) * share, tiltX: lean, tiltY: 0,
    });
  };
  await event('mousePressed', 0);
  for (let k = 1; k <= moves; ++k) await event('mouseMoved', k / moves);
  await event('mouseReleased', 1);
  await settled(page);
}

let savedPath = '';
/** The surface in the file that the page saves, as the engine reads it: a grid of points. */
async function saved(): Promise<Vector3[]> {
  savedPath = await saveAs(studio.page, directory, 'CAD file');
  return drawnBy(await engineOf(savedPath), 200);
}

/** The control points in the file that was saved last, to the last bit. */
async function savedNet(): Promise<Vector3[]> {
  const numbers = (await engineOf(savedPath)).query('control_points', { surface: 0 });
  return Array.from({ length: numbers.length / 3 }, (_, k) => [numbers[3 * k]!, numbers[3 * k + 1]!, numbers[3 * k + 2]!]);
}

/** The last brush that stands, and the points of its path. */
async function last(): Promise<Extract<Command, { do: 'brush' }> & { places: [number, number][] }> {
  const all = await commands(studio.page);
  const brush = all.at(-1) as Extract<Command, { do: 'brush' }>;
  expect(brush.do).toBe('brush');
  expect(brush.open ?? false).toBe(false);
  return { ...brush, places: (brush.path ?? []).map(([s, t]) => [side * s, side * t]) };
}

async function undone(count: number): Promise<void> {
  await studio.page.keyboard.press('Control+z');
  await settled(studio.page);
  expect((await commands(studio.page)).length).toBe(count); // one undo takes the stroke back
}

describe('brushes', () => {
  it('inflate as high as they say along the path, and as much by eight events as by many', async () => {
    await begin('Inflate');
    await led([-80, 0], [80, 20], 8);
    const few = await positions(studio.page);
    const { height, places } = await last();
    expect(height).toBeCloseTo(0.25 * radius, 9);
    const points = await saved();
    const top = Math.max(...points.map((p) => p[2]));
    expect(Math.abs(top - height!)).toBeLessThan(0.02 * height!);
    const reach = (p: Vector3) => Math.min(...places.map(([x, y]) => Math.hypot(p[0] - x, p[1] - y)));
    const beyond = (await savedNet()).filter((p) => reach(p) > 1.8 * radius);
    expect(beyond.length).toBeGreaterThan(100);
    for (const p of beyond) expect(Math.abs(p[2])).toBeLessThan(1e-9);
    await undone(sheet.length);
    await led([-80, 0], [80, 20], 160);
    const many = await positions(studio.page);
    const apart = few.reduce((most, x, k) => Math.max(most, Math.abs(x - many[k]!)), 0);
    console.log(`inflated by ${top.toFixed(3)} of ${height}; 8 and 160 events ${apart.toFixed(4)} apart`);
    expect(apart).toBeLessThan(0.03 * height!);
  });

  it('stamp the shape of a tool, turned by the hand, and an image', async () => {
    const { page } = studio;
    const fine: Command[] = [{ do: 'refine', permission: 'auto' }]; // a span of the sheet is a third of the side
    await begin('Stamp', fine, { strength: 0.4, stamp: { shape: 'box' } });
    await led([0, 0], [90, 0], 6);
    const box = await last();
    expect(box).toMatchObject({ kind: 'stamp', shape: 'box', angle: 45 });
    expect(box.places.length).toBe(1);
    const [x, y] = box.places[0]!, height = box.height!;
    const at = (points: Vector3[], dx: number, dy: number) =>
      points.reduce((best, p) => (Math.hypot(p[0] - x - dx, p[1] - y - dy) < Math.hypot(best[0] - x - dx, best[1] - y - dy) ? p : best))[2];
    const block = await saved(), half = 0.75 * radius / Math.SQRT2; // of its sides
    expect(Math.abs(at(block, 0, 0) - height)).toBeLessThan(0.02 * height);
    // A corner of the square lies where its side was before the turn.
    expect(at(block, 1.05 * half, 0)).toBeGreaterThan(0.5 * height);
    expect(at(block, 0.9 * half, 0.9 * half)).toBeLessThan(0.15 * height);
    await undone(sheet.length + fine.length);

    const halfWhite = await page.evaluate(() => {
      const canvas = document.createElement('canvas');
      canvas.width = canvas.height = 64;
      const context = canvas.getContext('2d')!;
      context.fillRect(0, 0, 64, 64);
      context.fillStyle = 'white';
      context.fillRect(32, 0, 32, 64);
      return canvas.toDataURL('image/png').split(',')[1]!;
    });
    await page.locator('input[aria-label="Image of the stamp"]').setInputFiles({ name: 'half.png', mimeType: 'image/png', buffer: Buffer.from(halfWhite, 'base64') });
    await expect.poll(() => page.locator('select[aria-label=Stamp]').inputValue()).toBe('image');
    await led([0, 0], [0, 0], 1);
    const image = await last();
    expect(image.pattern!.length).toBe(64);
    expect([image.pattern![10]![10], image.pattern![10]![50]]).toEqual([0, 1]);
    const pressed = await saved();
    expect(Math.abs(at(pressed, 0.45 * half, 0) - height)).toBeLessThan(0.15 * height);
    expect(Math.abs(at(pressed, -0.45 * half, 0))).toBeLessThan(0.15 * height);
  });

  it('flatten what is under them', async () => {
    await begin('Flatten', bumps, { strength: 1 });
    const rough = (points: Vector3[], [x, y]: [number, number]) => {
      const near = points.filter((p) => Math.hypot(p[0] - x, p[1] - y) < 0.35 * radius);
      // Distances from the plane that fits best, by its normal equations.
      const mean = [0, 1, 2].map((k) => near.reduce((sum, p) => sum + p[k]!, 0) / near.length);
      const m = (i: number, j: number) => near.reduce((sum, p) => sum + (p[i]! - mean[i]!) * (p[j]! - mean[j]!), 0);
      const det = m(0, 0) * m(1, 1) - m(0, 1) ** 2;
      const a = (m(0, 2) * m(1, 1) - m(1, 2) * m(0, 1)) / det, b = (m(1, 2) * m(0, 0) - m(0, 2) * m(0, 1)) / det;
      return Math.sqrt(near.reduce((sum, p) => sum + (p[2] - mean[2]! - a * (p[0] - mean[0]!) - b * (p[1] - mean[1]!)) ** 2, 0) / near.length);
    };
    const before = await saved();
    await led([0, 0], [1, 0], 1);
    const { places } = await last();
    const after = await saved();
    console.log(`rms from the plane ${rough(before, places[0]!).toFixed(4)} before, ${rough(after, places[0]!).toFixed(5)} after`);
    expect(rough(before, places[0]!)).toBeGreaterThan(0.05);
    expect(rough(after, places[0]!)).toBeLessThan(0.05 * rough(before, places[0]!));
  });

  it('smooth, and leave edges alone', async () => {
    await begin('Smooth', bumps, { strength: 1 });
    const before = await saved(), netBefore = await savedNet();
    await led([-60, 0], [60, 0], 30);
    const after = await saved(), netAfter = await savedNet();
    const largest = (points: Vector3[]) => Math.max(...points.map((p) => p[2]));
    expect(largest(after)).toBeLessThan(largest(before));
    expect(netAfter.length).toBe(netBefore.length);
    netAfter.forEach((p, k) => {
      if (p[0] < 1e-9 || p[1] < 1e-9 || p[0] > side - 1e-9 || p[1] > side - 1e-9) expect(p).toEqual(netBefore[k]);
    });
    await undone(sheet.length + bumps.length);
  });

  it('grab a point, which stays under the pointer', async () => {
    await begin('Grab');
    await led([0, 0], [20, -60], 20);
    const { by, places } = await last();
    expect(Math.hypot(...by!)).toBeGreaterThan(5);
    expect(places.length).toBe(1);
    const [x, y] = places[0]!;
    const goal = [x + by![0], y + by![1], by![2]];
    const off = Math.min(...(await saved()).map((p) => Math.hypot(p[0] - goal[0]!, p[1] - goal[1]!, p[2] - goal[2]!)));
    expect(off).toBeLessThan(1); // of a grid of points a unit apart
    await undone(sheet.length);
  });

  it('leave what is masked as it is', async () => {
    await begin('Mask');
    await led([0, 0], [1, 0], 1);
    const { places: [middle] } = await last();
    expect(await studio.page.locator('select[aria-label="Colour by"]').inputValue()).toBe('mask');
    await choose('Inflate');
    await led([-60, 0], [60, 0], 30);
    const points = await saved();
    // The mask is whole up to half its radius.
    const kept = (await savedNet()).filter((p) => Math.hypot(p[0] - middle![0], p[1] - middle![1]) < 0.45 * radius);
    expect(kept.length).toBeGreaterThan(10);
    for (const p of kept) expect(p[2]).toBe(0);
    expect(Math.max(...points.map((p) => p[2]))).toBeGreaterThan(0.2 * radius);
    await studio.page.locator('button', { hasText: /^Clear$/ }).click();
    await settled(studio.page);
    expect((await commands(studio.page)).at(-1)).toMatchObject({ do: 'mask', change: 'clear' });
  });

  it('follow the pressure of a pen, and are done again to the same bits', async () => {
    const { page } = studio;
    await begin('Push');
    await penned([-80, 0], [80, 10], 20);
    const { height, places, pressure, tilt } = await last();
    expect(tilt).toEqual([]);
    expect(pressure).toHaveLength(places.length);
    expect(pressure![0]).toBeCloseTo(least, 2);
    expect(pressure!.at(-1)).toBeCloseTo(1, 2);
    const points = await saved();
    places.forEach(([x, y], k) => {
      const near = points.filter((p) => Math.hypot(p[0] - x, p[1] - y) < 0.06 * radius);
      const deepest = Math.max(...near.map((p) => -p[2]));
      // What is pressed deeper a little farther on reaches back to here.
      const strongest = Math.max(...pressure!.filter((_, j) => Math.hypot(places[j]![0] - x, places[j]![1] - y) < 0.35 * radius));
      expect(deepest).toBeGreaterThan(0.92 * pressure![k]! * height!);
      expect(deepest).toBeLessThan(1.08 * strongest * height!);
    });
    const drawn = await positions(page), script = await commands(page);
    await page.evaluate((list) => (window as never as { studio: Page }).studio.documents.startFresh('again', list), script);
    await settled(page);
    expect(await positions(page)).toEqual(drawn);
    // A mouse sends neither.
    await page.keyboard.press('w');
    await led([-40, 40], [40, 40], 8);
    expect((await last()).pressure).toEqual([]);
  });

  it('become larger by the pressure of a pen, and lean with it, where they are set to', async () => {
    await begin('Pull');
    await studio.page.locator('select[aria-label="Pressure of the pen"]').selectOption('size');
    await studio.page.locator('[data-panel=Brush] .chip', { hasText: /^Tilt$/ }).click();
    await penned([-80, 0], [80, 10], 20, 40);
    const { presses, tilt, height, places } = await last();
    expect(presses).toBe('size');
    expect(tilt).toHaveLength(places.length);
    const points = await saved();
    const wide = (k: number) => points.filter((p) => Math.abs(p[0] - places[k]![0]) < 1 && p[2] > 0.5 * height! * Math.cos(Math.PI / 3)).length;
    expect(wide(places.length - 1)).toBeGreaterThan(1.5 * wide(0));
    // It leans: what is raised lies beside the path, as far as the axis leads there.
    const [from, to] = [places[0]!, places.at(-1)!], length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const across = [-(to[1] - from[1]) / length, (to[0] - from[0]) / length] as const;
    const raised = points.filter((p) => p[2] > 0.85 * height! * tilt![0]![2] && p[0] > 80 && p[0] < 120);
    const beside = raised.reduce((sum, p) => sum + (p[0] - from[0]) * across[0] + (p[1] - from[1]) * across[1], 0) / raised.length;
    const expected = height! * (tilt![0]![0] * across[0] + tilt![0]![1] * across[1]);
    expect(Math.abs(expected)).toBeGreaterThan(0.5);
    expect(Math.abs(beside - expected)).toBeLessThan(0.35 * Math.abs(expected));
  });

  it('repeat strokes in a mirror', async () => {
    await begin('Inflate');
    await studio.page.locator('select[aria-label="Mirror across"]').selectOption('x');
    await led([-90, 30], [-40, 10], 20);
    const { mirror } = await last();
    expect(mirror![0][0]).toBeCloseTo(side / 2, 9);
    const points = await saved();
    const heights = new Map(points.map((p) => [`${p[0].toFixed(3)} ${p[1].toFixed(3)}`, p[2]]));
    let compared = 0;
    for (const p of points) {
      const other = heights.get(`${(side - p[0]).toFixed(3)} ${p[1].toFixed(3)}`);
      if (other === undefined) continue;
      expect(Math.abs(other - p[2])).toBeLessThan(1e-5); // pictures are single precision
      ++compared;
    }
    expect(compared).toBeGreaterThan(1000);
    expect(Math.max(...points.map((p) => p[2]))).toBeGreaterThan(0.2 * radius);
  });
});
