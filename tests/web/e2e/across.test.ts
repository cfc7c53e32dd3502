import type { Command, Vector3 } from '@studio/engine/session_types';

import { commands, drag, positions, settled, spot, studioOfFile } from './page';

/** Strokes whose pointer goes from one selected surface to another. */

const studio = studioOfFile();

interface Page {
  hand: { brush: { settings: Record<string, unknown> }; surfaceBrush: { settings: Record<string, unknown> } };
  documents: { startFresh(name: string, commands: Command[]): Promise<unknown> };
}

const radius = 20, depth = 8;
/** A sheet of 200 × 200 in two halves that meet at x = 100. */
const halves: Command[] = [
  { do: 'new', size: [100, 200], net: [40, 64] }, { do: 'edge', which: 'u0' }, { do: 'edge', which: 'v0' }, { do: 'edge', which: 'v1' },
  { do: 'new', size: [100, 200], net: [40, 64], position: [100, 0, 0] }, { do: 'edge', which: 'u1' }, { do: 'edge', which: 'v0' }, { do: 'edge', which: 'v1' },
  { do: 'select', surfaces: ['#1', '#2'] }, { do: 'material', preset: 'clay' },
];

async function begin(key: string, list = halves): Promise<void> {
  const { page } = studio;
  await page.evaluate(async ({ list, settings }) => {
    const app = (window as never as { studio: Page }).studio;
    await app.documents.startFresh('halves', list);
    Object.assign(app.hand.brush.settings, settings);
    Object.assign(app.hand.surfaceBrush.settings, { kind: 'inflate', strength: 0.5, mirror: null, radial: 1, steady: 0 });
  }, { list, settings: { radius, strength: depth / radius } });
  await settled(page);
  await page.keyboard.press(key);
}

const led = (from: [number, number], to: [number, number], moves: number) => drag(studio.page, from, to, moves);

async function points(): Promise<Vector3[]> {
  const numbers = await positions(studio.page);
  return Array.from({ length: numbers.length / 3 }, (_, k) => [numbers[3 * k]!, numbers[3 * k + 1]!, numbers[3 * k + 2]!]);
}

/** Heights along a path of points of the plane: the largest displacement near it for each piece of x. */
function ridge(all: Vector3[], path: readonly (readonly number[])[]): [number, number][] {
  const [from, to] = [path[0]!, path.at(-1)!];
  const slope = (to[1]! - from[1]!) / (to[0]! - from[0]!);
  const [left, right] = [Math.min(from[0]!, to[0]!) + radius, Math.max(from[0]!, to[0]!) - radius];
  const bins = new Map<number, number>();
  for (const [x, y, z] of all) {
    if (x < left || x > right || Math.abs(y - from[1]! - slope * (x - from[0]!)) > 3) continue;
    const bin = Math.round(x / 4);
    bins.set(bin, Math.max(bins.get(bin) ?? 0, Math.abs(z)));
  }
  return [...bins].map(([bin, z]) => [4 * bin, z]);
}

const open = async (): Promise<number> => {
  // The two edges at x = 100, point by point.
  const all = (await points()).filter(([x]) => Math.abs(x - 100) < 1e-3);
  const byPlace = new Map<string, number[]>();
  for (const [, y, z] of all) byPlace.set(y.toFixed(2), [...(byPlace.get(y.toFixed(2)) ?? []), z]);
  const gaps = [...byPlace.values()].filter((z) => z.length > 1).map((z) => Math.max(...z) - Math.min(...z));
  expect(gaps.length).toBeGreaterThan(20);
  return Math.max(...gaps);
};

describe('over the seam of two selected surfaces', () => {
  it('a stroke in clay goes on', async () => {
    await begin('b');
    await led([-100, 10], [100, -10], 40);
    const pressed = (await commands(studio.page)).filter((c) => c.do === 'stroke')[0] as Extract<Command, { do: 'stroke' }>;
    const heights = ridge(await points(), pressed.path);
    expect(heights.some(([x]) => x < 90)).toBe(true);
    expect(heights.some(([x]) => x > 110)).toBe(true);
    for (const [, z] of heights) {
      expect(z).toBeGreaterThan(0.92 * depth);
      expect(z).toBeLessThan(1.08 * depth);
    }
    expect(await open()).toBeLessThan(1e-4); // pictures are single precision
    await studio.page.keyboard.press('Control+z');
    await settled(studio.page);
    expect((await commands(studio.page)).length).toBe(halves.length);
  });

  it('a brush goes on, and is one command', async () => {
    await begin('w');
    await led([-100, 10], [100, -10], 40);
    const all = await commands(studio.page);
    expect(all.length).toBe(halves.length + 1);
    const brush = all.at(-1) as Extract<Command, { do: 'brush' }>;
    expect(new Set(brush.surfaces)).toEqual(new Set(['#1', '#2']));
    expect(brush.surfaces!.length).toBe(brush.path!.length);
    const path = brush.path!.map(([s, t], k) => [100 * s + (brush.surfaces![k] === '#2' ? 100 : 0), 200 * t]);
    const heights = ridge(await points(), path);
    expect(heights.some(([x]) => x < 90)).toBe(true);
    expect(heights.some(([x]) => x > 110)).toBe(true);
    for (const [, z] of heights) expect(Math.abs(z - brush.height!)).toBeLessThan(0.05 * brush.height!);
    expect(await open()).toBeLessThan(1e-4);
  });

  it('what is dragged is on the surface under the pointer', async () => {
    await begin('g');
    const { page } = studio;
    await page.mouse.move(...(await spot(page, 60, 0)));
    await page.mouse.down();
    await settled(page);
    for (const up of [-25, -50]) {
      await page.mouse.move(...(await spot(page, 60, up)));
      await settled(page);
    }
    await page.mouse.up();
    await settled(page);
    const drag = (await commands(studio.page)).at(-1) as Extract<Command, { do: 'drag' }>;
    expect(drag).toMatchObject({ do: 'drag', surface: '#2' });
    const tops = [...(await points())].sort((p, q) => Math.abs(q[2]) - Math.abs(p[2]));
    expect(Math.abs(tops[0]![2])).toBeGreaterThan(3);
    const [s] = drag.at as [number, number];
    expect(Math.abs(tops[0]![0] - 100 - 100 * s)).toBeLessThan(radius);
  });

  it('a crease is said, and the button does the stroke again without', async () => {
    const { page } = studio;
    /** A cubic net of points of a quadrilateral, from its corners at (0, 0), (1, 0), (0, 1), (1, 1). */
    const quad = (a: Vector3, b: Vector3, c: Vector3, d: Vector3): Command => {
      const n = 24;
      const knot = (k: number) => Math.min(1, Math.max(0, (k - 3) / (n - 3)));
      const greville = (k: number) => (knot(k + 1) + knot(k + 2) + knot(k + 3)) / 3;
      const points = Array.from({ length: n * n }, (_, k) => {
        const s = greville(Math.floor(k / n)), t = greville(k % n);
        return [0, 1, 2].map((i) => (1 - s) * ((1 - t) * a[i]! + t * c[i]!) + s * ((1 - t) * b[i]! + t * d[i]!)) as Vector3;
      });
      return { do: 'new', net: [n, n], points };
    };
    await begin('w', [
      quad([0, 50, 0], [100, 0, 0], [0, 150, 0], [100, 200, 0]), quad([100, 0, 0], [200, 0, 0], [100, 200, 0], [200, 200, 0]),
      { do: 'select', surfaces: ['#1', '#2'] }, { do: 'material', preset: 'clay' },
    ]);
    await led([-60, 10], [60, -10], 12);
    const brush = (await commands(page)).at(-1)!;
    const notice = page.locator('.notice', { hasText: 'was smooth, and now has a crease of' });
    await expect.poll(() => notice.count()).toBe(1);
    expect(await notice.textContent()).toMatch(/#1 u1 and #2 u0/);
    await notice.locator('button', { hasText: 'Keep it smooth' }).click();
    await expect.poll(async () => (await commands(page)).at(-2)).toMatchObject({ do: 'seams', smooth: true });
    await settled(page);
    expect((await commands(page)).at(-1)).toEqual(brush);
    const notes = await page.evaluate(() => (window as never as { studio: { state: { notes: { text: string }[] } } }).studio.state.notes);
    expect(notes.filter(({ text }) => text.includes('crease of'))).toEqual([]);
  });
});
