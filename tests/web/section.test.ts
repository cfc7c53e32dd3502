import type { Picture } from '@studio/engine/session_types';
import { shown } from '@studio/engine/trim_tree';
import { cutOfContext, cutOfPicture } from '@studio/view/section_lines';
import { stepsBetween } from '@studio/view/section_planes';

/** A grid over the unit square, m × n points, at the height z(x, y). */
function sheet(m: number, n: number, z: (x: number, y: number) => number): Picture {
  const s = Float32Array.from({ length: m }, (_, k) => k / (m - 1));
  const t = Float32Array.from({ length: n }, (_, k) => k / (n - 1));
  const positions = new Float32Array(3 * m * n);
  for (let i = 0; i < m; ++i) for (let j = 0; j < n; ++j) positions.set([s[i]!, t[j]!, z(s[i]!, t[j]!)], 3 * (i * n + j));
  return { counts: [m, n], s, t, positions } as unknown as Picture;
}
const length = (pieces: number[]) => {
  let sum = 0;
  for (let k = 0; k < pieces.length; k += 6) sum += Math.hypot(...[0, 1, 2].map((d) => pieces[k + d]! - pieces[k + 3 + d]!));
  return sum;
};
const square = (lower: number, upper: number) => [lower, lower, upper, lower, upper, upper, lower, upper];

describe('the cut of a surface', () => {
  const flat = sheet(9, 13, () => 0);

  it('is as long as the surface is wide', () => {
    expect(length(cutOfPicture(flat, [1, 0, 0, -0.3], null))).toBeCloseTo(1, 6);
    expect(length(cutOfPicture(flat, [1, 1, 0, -1], null))).toBeCloseTo(Math.SQRT2, 6);
    expect(cutOfPicture(flat, [1, 0, 0, -1.01], null)).toEqual([]);
  });

  it('is that of the curve to the chords of the grid', () => {
    const bent = sheet(65, 65, (x) => Math.sqrt(1 - (x - 0.5) ** 2));
    const arc = length(cutOfPicture(bent, [0, 1, 0, -0.4], null));
    expect(Math.abs(arc - 2 * Math.asin(0.5))).toBeLessThan(1e-4);
  });

  it('ends exactly at the trims', () => {
    const ring = { faces: [[square(0.1, 0.9), square(0.35, 0.62)]] };
    expect(length(cutOfPicture(flat, [1, 0, 0, -0.5], ring))).toBeCloseTo(0.8 - 0.27, 6);
    expect(length(cutOfPicture(flat, [1, 0, 0, -0.2], ring))).toBeCloseTo(0.8, 6);
    expect(cutOfPicture(flat, [1, 0, 0, -0.05], ring)).toEqual([]);
    expect([shown(ring, 0.2, 0.2), shown(ring, 0.5, 0.5), shown(ring, 0.05, 0.5), shown(null, 2, 2)]).toEqual([true, false, false, true]);
  });
});

it('cuts triangles', () => {
  const positions = Float32Array.of(0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 2, 0);
  const context = { positions, normals: positions, indices: Uint32Array.of(0, 1, 2, 1, 3, 2), faces: [], skipped: [], parts: 0, places: 0 };
  expect(length(cutOfContext(context, [1, 0, 0, -0.5]))).toBeCloseTo(2, 6);
  expect(cutOfContext(context, [0, 0, 1, -0.5])).toEqual([]);
});

describe('the planes of section curves', () => {
  it('are multiples of the step, those in the middle where there are many', () => {
    expect(stepsBetween(-25, 41, 20)).toEqual([-20, 0, 20, 40].map((x) => x || expect.closeTo(0)));
    expect(stepsBetween(1, 2, 20)).toEqual([]);
    const many = stepsBetween(-1000, 1000, 1);
    expect(many.length).toBe(60);
    expect(Math.abs(many[0]! + many.at(-1)!)).toBeLessThan(2);
  });
});
