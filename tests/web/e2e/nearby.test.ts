import { join } from 'node:path';

import type { Client } from '@studio/engine/client';
import type { Picture } from '@studio/engine/session_types';

import { openFile, root, settled, spot, stroke, studioOfFile } from './page';

/** However near a view is, what it shows of a surface is drawn within a pixel of it. */

const studio = studioOfFile({ width: 1000, height: 700 });

interface App {
  frame: { pictures: Picture[]; origin: number[] };
  client: Pick<Client, 'query'>;
  viewer: { main: { placement(): { height: number }; restore(p: object): void; projectAll(points: number[]): Float32Array } };
}

/** When the views have stood still for long enough, chords are within a pixel: as many as are given back. */
async function fine(): Promise<Awaited<ReturnType<typeof chordError>>> {
  let found: Awaited<ReturnType<typeof chordError>> | undefined;
  await expect.poll(async () => {
    found = await chordError();
    return found.finer && found.count > 10 ? found.most : Infinity; // where it is coarse still, hardly an edge may lie in the view
  }).toBeLessThan(0.6);
  return found!;
}

/** Looks at a point of the first surface so that the window is as high as `height`, file units. */
async function lookAt(at: [number, number], height: number): Promise<void> {
  const { page } = studio;
  await page.evaluate(async ([place, high]) => {
    const { studio: app } = window as never as { studio: App };
    const { point } = await app.client.query('reading', { surface: 0, at: place });
    const target = point.map((x, d) => x - app.frame.origin[d]!);
    const p = app.viewer.main.placement() as unknown as { position: number[]; target: number[] };
    app.viewer.main.restore({ ...app.viewer.main.placement(), target, position: target.map((x, d) => x + p.position[d]! - p.target[d]!), height: high });
  }, [at, height] as const);
}

/** Of up to 300 edges of the picture's cells in the view: how far the middle is from the surface, across, pixels; whether it is drawn finer there. */
const chordError = (): Promise<{ most: number; count: number; points: number; finer: boolean }> => studio.page.evaluate(async () => {
  const { studio: app } = window as never as { studio: App };
  const { positions, counts: [m, n], s, t, window: finer } = app.frame.pictures[0]!;
  const view = app.viewer.main;
  const box = document.querySelector('.view-perspective')!.getBoundingClientRect();
  const at = (k: number, l: number) => [...positions.subarray(3 * (k * n + l), 3 * (k * n + l) + 3)];
  const edges: [number[], number[], [number, number]][] = [];
  const places = view.projectAll([...positions]);
  const inside = (x: number, y: number) => x > box.left && x < box.right && y > box.top && y < box.bottom;
  const near = (k: number, l: number, dk: number, dl: number) => {
    const [a, b] = [2 * (k * n + l), 2 * ((k + dk) * n + l + dl)];
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      if (inside(places[a]! * (1 - share) + places[b]! * share, places[a + 1]! * (1 - share) + places[b + 1]! * share)) return true;
    }
    return false;
  };
  for (let k = 0; k + 1 < m; ++k) {
    for (let l = 0; l + 1 < n; ++l) {
      if (near(k, l, 1, 0)) edges.push([at(k, l), at(k + 1, l), [(s[k]! + s[k + 1]!) / 2, t[l]!]]);
      if (near(k, l, 0, 1)) edges.push([at(k, l), at(k, l + 1), [s[k]!, (t[l]! + t[l + 1]!) / 2]]);
    }
  }
  const every = Math.max(1, Math.ceil(edges.length / 300));
  let most = 0;
  let count = 0;
  for (let e = 0; e < edges.length; e += every, ++count) {
    const [a, b, place] = edges[e]!;
    const { point } = await app.client.query('reading', { surface: 0, at: place });
    const exact = point.map((x, d) => x - app.frame.origin[d]!);
    const [ax, ay, bx, by, px, py] = view.projectAll([...a, ...b, ...exact]) as never as number[];
    const length = Math.hypot(bx! - ax!, by! - ay!);
    if (length > 1e-6) most = Math.max(most, Math.abs((bx! - ax!) * (py! - ay!) - (by! - ay!) * (px! - ax!)) / length);
  }
  return { most, count, points: m * n, finer: finer !== null };
});

it('is drawn finely where a view is near, and only there', async () => {
  const { page } = studio;
  await openFile(page, join(root, 'samples/bonnet.step'));
  const height = await page.evaluate(() => (window as never as { studio: App }).studio.viewer.main.placement().height);
  const far = await chordError();
  expect(far.count).toBeGreaterThan(200);
  expect(far.most).toBeLessThan(0.6);
  for (const zoom of [10, 100, 1000]) {
    await lookAt([0.31, 0.43], height / zoom);
    const near = await fine();
    expect(near.count, `${zoom} times`).toBeGreaterThan(10);
    expect(near.points, `${zoom} times`).toBeLessThan(100_001);
  }
  // Isocurves and what else counts the lines of the picture stay where they are.
  await page.keyboard.press('Shift+F');
  await expect.poll(async () => (await chordError()).points).toBe(far.points);
});

it('goes coarse while a stroke is under way, and fine again', async () => {
  const { page } = studio;
  await lookAt([0.5, 0.5], 15);
  await stroke(page, [0, 0]); // selects it
  await settled(page);
  const before = await fine();
  await page.mouse.move(...(await spot(page)));
  await page.mouse.down();
  await page.mouse.move(...(await spot(page, 30, 10)), { steps: 4 });
  await settled(page);
  const during = await chordError();
  await page.mouse.up();
  await settled(page);
  expect(during.finer).toBe(false);
  expect(during.points).toBeLessThan(before.points);
  await fine();
});
