import type { Command, Vector3 } from '@studio/engine/session_types';

import { commands, drag, positions, settled, studioOfFile, directoryOfFile, drawnBy, engineOf, saveAs } from './page';

/** From the pointer's events to the saved file: what a stroke leaves in clay is as wide and as deep as the ball that was led. */

const studio = studioOfFile();
const directory = directoryOfFile();

interface Page {
  hand: { brush: { settings: { radius: number; strength: number } } };
  documents: { startFresh(name: string, commands: Command[]): Promise<unknown> };
}

const radius = 20, depth = 8;
const sheet: Command[] = [{ do: 'new', size: [200, 200], net: [64, 64] }, { do: 'edge' }, { do: 'material', preset: 'clay' }];

/** A stroke over the middle of the view, by so many moves of the pointer. */
async function led(from: [number, number], to: [number, number], moves: number): Promise<void> {
  const { page } = studio;
  await page.evaluate((list) => (window as never as { studio: Page }).studio.documents.startFresh('sheet', list), sheet);
  await settled(page); // the first picture of a document chooses the radius
  await page.evaluate((settings) => {
    Object.assign((window as never as { studio: Page }).studio.hand.brush.settings, settings);
  }, { radius, strength: depth / radius });
  await page.keyboard.press('b');
  await drag(page, from, to, moves);
}

/** The points of the surface in the file that the page saves, as the engine reads it. */
async function saved(): Promise<Vector3[]> {
  return drawnBy(await engineOf(await saveAs(studio.page, directory, 'CAD file')), 400);
}

describe('a stroke in clay', () => {
  it.each([['along', [-110, 40], [110, -40]], ['across', [-70, -60], [80, 50]]] as const)('%s leaves the groove of its ball', async (_, from, to) => {
    await led([...from], [...to], 40);
    const path = (await commands(studio.page)).flatMap((c) => (c.do === 'stroke' ? c.path : []));
    const [begin, end] = [path[0]!, path.at(-1)!];
    const length = Math.hypot(end[0] - begin[0], end[1] - begin[1]);
    expect(length).toBeGreaterThan(3 * radius);
    const [e, f] = [(end[0] - begin[0]) / length, (end[1] - begin[1]) / length];
    const bins = new Map<number, { bottom: number; left: number; right: number }>();
    let beyond = 0, lowest = 0, highest = 0;
    for (const [x, y, z] of await saved()) {
      const along = (x - begin[0]) * e + (y - begin[1]) * f, across = (y - begin[1]) * e - (x - begin[0]) * f;
      lowest = Math.min(lowest, z);
      highest = Math.max(highest, z);
      if (Math.hypot(across, Math.max(0, -along, along - length)) > 2.5 * radius) beyond = Math.max(beyond, Math.abs(z));
      if (along < radius || along > length - radius) continue;
      const bin = bins.get(Math.floor(along / 2)) ?? { bottom: 0, left: 0, right: 0 };
      bin.bottom = Math.min(bin.bottom, z);
      if (z < -depth / 2) Object.assign(bin, { left: Math.min(bin.left, across), right: Math.max(bin.right, across) });
      bins.set(Math.floor(along / 2), bin);
    }
    const bottoms = [...bins.values()].map((b) => -b.bottom), widths = [...bins.values()].map((b) => b.right - b.left);
    console.log(`bottom ${Math.min(...bottoms).toFixed(2)} to ${Math.max(...bottoms).toFixed(2)}, width up to ${Math.max(...widths).toFixed(1)}, beyond ${beyond.toFixed(3)}, rim ${highest.toFixed(3)}`);
    expect(Math.min(...bottoms)).toBeGreaterThan(0.92 * depth);
    expect(-lowest).toBeLessThan(1.001 * depth); // never deeper than the ball went
    const chord = 2 * Math.sqrt(radius ** 2 - (radius - depth / 2) ** 2);
    expect(Math.max(...widths)).toBeLessThan(1.25 * chord);
    expect(beyond).toBeLessThan(0.01 * depth);
    expect(highest).toBeLessThan(0.02 * depth);
    await studio.page.keyboard.press('Control+z');
    await settled(studio.page);
    expect((await commands(studio.page)).length).toBe(sheet.length); // one undo takes all back
  });

  it('is the same by eight events and by many', async () => {
    await led([-90, 0], [90, 0], 8);
    const few = await positions(studio.page);
    expect(Math.min(...few.filter((_, k) => k % 3 === 2))).toBeLessThan(-0.9 * depth);
    await led([-90, 0], [90, 0], 160);
    const many = await positions(studio.page);
    const apart = few.reduce((most, x, k) => Math.max(most, Math.abs(x - many[k]!)), 0);
    console.log(`8 and 160 events: ${apart.toFixed(4)} apart`);
    expect(apart).toBeLessThan(0.03 * depth);
  });
});
