import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import { type DrawnBody, nearestChord, nearestPoint } from '@studio/view/near';
import { still } from '@studio/view/placing';
import { heldPoints } from '@studio/view/body_view';

const wasm = readFileSync(join(fileURLToPath(new URL('../..', import.meta.url)), 'web/src/engine/knead_studio.wasm'));

describe('curves and volumes as they are drawn', () => {
  it('have their control points in order, and for each end of a chord its place in the domain', async () => {
    const engine = await Engine.load(wasm);
    engine.query('fresh', { name: 'bodies' });
    engine.execute({ do: 'new', shape: 'volume', form: 'box', size: [2, 3, 4], net: [4, 5, 6], degree: [3, 3, 3] });
    const { lines, at, points } = engine.query('body_picture', { body: 0 });
    expect(points.length).toBe(3 * 4 * 5 * 6);
    expect(at.length).toBe(lines.length);
    // A box at rest: the place in it is linear in the fractions.
    const o = engine.query('origin'), corner = [0, 1, 2].map((d) => points[d]! + o[d]!), far = [0, 1, 2].map((d) => points[points.length - 3 + d]! + o[d]!);
    for (let k = 0; k < lines.length; ++k) {
      const d = k % 3;
      expect(lines[k]! + o[d]!).toBeCloseTo(corner[d]! + at[k]! * (far[d]! - corner[d]!), 5);
    }
  });

  it('show the block of a lattice beyond all control points of the selected surfaces', async () => {
    const engine = await Engine.load(wasm);
    engine.query('fresh', { name: 'sheet' });
    engine.execute({ do: 'new', shape: 'plane', size: [30, 40], net: [6, 6] });
    const { points } = engine.query('lattice_picture', { net: [4, 5, 6], margin: 0.1 });
    expect(points.length).toBe(3 * 120);
    const extent = (d: number) => {
      const all = [...points].filter((_, k) => k % 3 === d);
      return Math.max(...all) - Math.min(...all);
    };
    [30, 40, 0].forEach((size, d) => expect(extent(d)).toBeCloseTo(size + 2 * 0.1 * 50, 4));
    expect(() => engine.query('lattice_picture', { net: [4, 5, 6], margin: 0 })).toThrow(/margin/);
  });

  it('show a lattice where it was pulled to, and another round the surfaces as they are', async () => {
    const engine = await Engine.load(wasm);
    engine.query('fresh', { name: 'sheet' });
    engine.execute({ do: 'new', shape: 'plane', size: [30, 40], net: [6, 6] });
    const block = { net: [4, 4, 4] as [number, number, number], margin: 0.1 };
    const before = engine.query('lattice_picture', block);
    expect(before.pulled).toBe(false);
    engine.execute({ do: 'lattice', ...block, which: [23], by: [0, 0, 20] });
    const { points, pulled } = engine.query('lattice_picture', block);
    expect(pulled).toBe(true);
    points.forEach((x, k) => expect(x - before.points[k]!).toBeCloseTo(k === 3 * 23 + 2 ? 20 : 0, 5));
    engine.execute({ do: 'lattice', ...block, which: [23], by: [5, 0, 0], again: true });
    expect(engine.query('lattice_picture', block).points[3 * 23]! - points[3 * 23]!).toBeCloseTo(5, 5);
    const anew = engine.query('lattice_picture', { ...block, anew: true });
    expect(anew.pulled).toBe(false);
    expect(anew.points[3 * 63 + 2]!).toBeGreaterThan(before.points[3 * 63 + 2]! + 0.2); // round what has risen
    engine.execute({ do: 'undo' });
    expect([...engine.query('lattice_picture', block).points]).toEqual([...points]);
  });

  it('are met where the pointer is near their lines, at the place between the ends of a chord', () => {
    const body = { lines: new Float32Array([0, 0, 0, 10, 0, 0]), at: new Float32Array([0.2, 0, 0, 0.4, 0, 0]), net: new Float32Array(), points: new Float32Array(), pulled: false };
    const drawn = [{ body: 0, picture: body, standing: still }];
    const flat = ({ picture }: DrawnBody) => new Float32Array([...picture.lines].filter((_, k) => k % 3 < 2));
    const hit = nearestChord(drawn, 5, 3, 9, flat)!;
    expect(hit.body).toBe(0);
    expect(hit.point.toArray()).toEqual([5, 0, 0]);
    expect(hit.at[0]).toBeCloseTo(0.3, 6);
    expect(nearestChord(drawn, 5, 12, 9, flat)).toBeNull();
    expect(nearestChord(drawn, 5, 0, 9, () => new Float32Array([NaN, NaN, NaN, NaN]))).toBeNull();
    expect(nearestPoint(new Float32Array([0, 0, 10, 0, NaN, 0]), { clientX: 8, clientY: 1 }, 9)).toBe(1);
  });

  it('have on their sides the control points whose index is the first or the last', () => {
    expect(heldPoints([5], ['u0'])).toEqual([0]);
    expect(heldPoints([5], ['u0', 'u1'])).toEqual([0, 4]);
    expect(heldPoints([2, 2, 3], ['w1'])).toEqual([2, 5, 8, 11]);
    expect(heldPoints([2, 2, 3], ['v0'])).toEqual([0, 1, 2, 6, 7, 8]);
  });
});
