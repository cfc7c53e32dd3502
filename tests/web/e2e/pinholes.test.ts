import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { directoryOfFile, draws, openFile, screen, settled, studioOfFile } from './page';

/** Faces that meet along a slanted trim leave no hole between them in the picture. */

const studio = studioOfFile({ width: 1100, height: 700 });
const directory = directoryOfFile();
beforeAll(() => draws(studio.page, true));

/** Two flat patches of different size over each other; a triangle of each is shown, and both meet along a slanted edge. */
function triangles(): string {
  const lines: string[] = [];
  const add = (record: string) => lines.push(`#${lines.length + 1}=${record};`);
  const real = (x: number) => (Number.isInteger(x) ? `${x}.` : `${x}`);
  const point = (x: number, y: number) => add(`CARTESIAN_POINT('',(${real(x)},${real(y)},0.))`);
  const patch = (lower: [number, number], size: [number, number]) => {
    const net = [0, 1].map((i) => `(${[0, 1].map((j) => `#${point(lower[0] + i * size[0], lower[1] + j * size[1])}`).join()})`).join();
    return add(`B_SPLINE_SURFACE_WITH_KNOTS('',1,1,(${net}),.UNSPECIFIED.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)`);
  };
  const corners = [[-40, -30], [40, 37], [-40, 37], [40, -30]] as const;
  const vertices = corners.map(([x, y]) => add(`VERTEX_POINT('',#${point(x, y)})`));
  const edge = (a: number, b: number) => {
    const [[x, y], [u, v]] = [corners[a]!, corners[b]!];
    const length = Math.hypot(u - x, v - y);
    const direction = add(`DIRECTION('',(${real((u - x) / length)},${real((v - y) / length)},0.))`);
    const line = add(`LINE('',#${point(x, y)},#${add(`VECTOR('',#${direction},1.)`)})`);
    return add(`EDGE_CURVE('',#${vertices[a]},#${vertices[b]},#${line},.T.)`);
  };
  const shared = edge(0, 1);
  const face = (surface: number, edges: [number, boolean][]) => {
    const oriented = edges.map(([e, along]) => `#${add(`ORIENTED_EDGE('',*,*,#${e},${along ? '.T.' : '.F.'})`)}`).join();
    add(`ADVANCED_FACE('',(#${add(`FACE_OUTER_BOUND('',#${add(`EDGE_LOOP('',(${oriented}))`)},.T.)`)}),#${surface},.T.)`);
  };
  face(patch([-53, -41], [111, 97]), [[shared, true], [edge(1, 2), true], [edge(2, 0), true]]);
  face(patch([-61, -47], [131, 103]), [[shared, false], [edge(0, 3), true], [edge(3, 1), true]]);
  return `ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n${lines.join('\n')}\nENDSEC;\nEND-ISO-10303-21;\n`;
}

it('shows no background through an edge, from near or far', async () => {
  const { page } = studio;
  const path = join(directory, 'triangles.step');
  writeFileSync(path, triangles());
  await openFile(page, path);
  await page.waitForFunction(() => (window as never as { studio: { viewer: { trimOf(k: number): unknown } } }).studio.viewer.trimOf(1) !== null);
  await page.evaluate(() => (window as never as { studio: { setDisplay(d: object): void } }).studio.setDisplay({ isocurves: false, grid: false }));
  await page.keyboard.press('3');
  for (const zoom of [1, 3, 10]) {
    // About a point of the edge.
    await page.evaluate((factor) => {
      const { main, origin } = (window as never as { studio: { viewer: { origin: number[]; main: {
        placement(): { position: number[]; target: number[]; height: number }; restore(p: object): void } } } }).studio.viewer;
      const to = [7, -30 + (67 / 80) * 47, 0].map((x, d) => x - origin[d]!);
      const p = main.placement();
      main.restore({ ...p, target: to, position: [to[0], to[1], to[2]! + 1], height: 90 / factor });
    }, zoom);
    await settled(page);
    const holes = await (await screen(page)).evaluate(({ data, width, height }) => {
      const { main, origin, palette } = (window as never as { studio: { viewer: { origin: number[]; palette: { background: number }; main: { projectAll(p: number[]): Float32Array } } } }).studio.viewer;
      const box = document.querySelector<HTMLCanvasElement>('.viewer-canvas')!.getBoundingClientRect();
      const background = [palette.background >> 16, (palette.background >> 8) & 255, palette.background & 255];
      let [bad, seen] = [0, 0];
      for (let k = 0; k <= 4000; ++k) {
        const share = 0.02 + 0.96 * (k / 4000);
        const [x, y] = main.projectAll([-40 + 80 * share - origin[0]!, -30 + 67 * share - origin[1]!, -origin[2]!]);
        const [col, row] = [Math.round((x! - box.left) * (width / box.width)), Math.round((y! - box.top) * (width / box.width))];
        for (const [dx, dy] of [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
          if (col + dx < 1 || col + dx >= width - 1 || row + dy < 1 || row + dy >= height - 1) continue;
          const at = 4 * ((row + dy) * width + col + dx);
          ++seen;
          // Nearer to the background than to the clay.
          if (background.every((c, d) => Math.abs(data[at + d]! - c) < 40)) ++bad;
        }
      }
      return { bad, seen };
    });
    expect(holes.seen, `zoom ${zoom}`).toBeGreaterThan(1500);
    expect(holes.bad, `zoom ${zoom}`).toBe(0);
  }
});

it('ends faces within a pixel of their edges, from near or far', async () => {
  const { page } = studio;
  const path = join(directory, 'disc.step');
  writeFileSync(path, facesStep());
  await openFile(page, path);
  // Of this file: a circle, not the triangle of the one before.
  await page.waitForFunction(() => ((window as never as { studio: { viewer: { trimOf(k: number): { faces: number[][][] } | null } } }).studio.viewer.trimOf(0)?.faces[0]![0]!.length ?? 0) > 40);
  await page.evaluate(() => (window as never as { studio: { setDisplay(d: object): void } }).studio.setDisplay({ isocurves: false, grid: false, context: false }));
  await page.keyboard.press('3');
  for (const zoom of [1, 5, 20]) {
    // About a point of the circle of radius 4, which is the edge.
    const angle = 0.7;
    await page.evaluate(async ([factor, angle]) => {
      const { main, origin } = (window as never as { studio: { viewer: { origin: number[]; main: { placement(): object; restore(p: object): void } } } }).studio.viewer;
      const to = [4 * Math.cos(angle) - origin[0]!, 4 * Math.sin(angle) - origin[1]!, -origin[2]!];
      main.restore({ ...main.placement(), target: to, position: [to[0], to[1], to[2]! + 1], height: 12 / factor });
      // The view stands still, and is drawn finely.
      const { viewer } = (window as never as { studio: { viewer: { surfaces: { picture: { window: object | null } }[] } } }).studio;
      for (let k = 0; k < 100 && factor > 10 && !viewer.surfaces[0]!.picture.window; ++k) await new Promise((resolve) => setTimeout(resolve, 100));
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
    }, [zoom, angle] as const);
    const found = await (await screen(page)).evaluate(({ data, width, height }, [factor, angle]) => {
      const { main, origin, palette } = (window as never as { studio: { viewer: { origin: number[]; palette: { background: number }; main: {
        projectAll(p: number[]): Float32Array } } } }).studio.viewer;
      const box = document.querySelector<HTMLCanvasElement>('.viewer-canvas')!.getBoundingClientRect();
      const background = [palette.background >> 16, (palette.background >> 8) & 255, palette.background & 255];
      // Inwards to the middle of the circle, in steps of a tenth of a pixel: the first pixel of the face, by its middle.
      const pixel = 12 / factor / box.height;
      const places: number[] = [];
      for (let k = -400; k <= 400; ++k) {
        const a = angle + (k / 400) * Math.min(1, 1.2 / factor);
        for (let off = 60; off >= -60; --off) {
          const r = 4 + (off / 10) * pixel;
          const [x, y] = main.projectAll([r * Math.cos(a) - origin[0]!, r * Math.sin(a) - origin[1]!, -origin[2]!]);
          const [right, down] = [(x! - box.left) * (width / box.width), (y! - box.top) * (width / box.width)];
          const [col, row] = [Math.floor(right), Math.floor(down)];
          if (!(col >= 0 && row >= 0 && col < width && row < height)) break;
          const at = 4 * (row * width + col);
          if (background.every((c, d) => Math.abs(data[at + d]! - c) < 30)) continue;
          places.push(off / 10 + (col + 0.5 - right) * Math.cos(a) - (row + 0.5 - down) * Math.sin(a));
          break;
        }
      }
      return { farthest: Math.max(...places), nearest: Math.min(...places), count: places.length };
    }, [zoom, angle] as const);
    expect(found.count, `zoom ${zoom}`).toBeGreaterThan(200);
    expect(found.farthest, `zoom ${zoom}`).toBeLessThan(0.75); // half a pixel over the edge
    expect(found.nearest, `zoom ${zoom}`).toBeGreaterThan(-1.5); // the path meets a corner of the pixel (0.7), the loop has chords (0.5)
  }
});
