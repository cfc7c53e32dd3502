import { coefficients, type Command, type MaterialSamples, type Picture, type SurfaceInfo } from '../engine/session_types';

/** Painted material: samples of the coefficients over the domain, linear in between (docs/scripts.md, `material`). */

/** The coefficients that paint sets; α12 is unchanged. */
const painted = coefficients.filter((c) => c !== 'alpha12');

const most = 33;

/** As fine as the net can resolve, within limits. */
export const sampleCounts = ({ net, degree }: SurfaceInfo): [number, number] =>
  net.map((n, d) => Math.min(most, Math.max(9, n - degree[d]! + 1))) as [number, number];

/** Positions of the samples on the drawn grid, 3 numbers each. */
export function samplePlaces({ counts, s, t, positions }: Picture, [m, n]: [number, number]): Float32Array {
  const nearest = (lines: Float32Array, count: number) => {
    let k = 0;
    return Array.from({ length: count }, (_, i) => {
      const x = i / (count - 1);
      while (k + 1 < lines.length && Math.abs(lines[k + 1]! - x) <= Math.abs(lines[k]! - x)) ++k;
      return k;
    });
  };
  const [rows, columns] = [nearest(s, m), nearest(t, n)];
  const result = new Float32Array(3 * m * n);
  rows.forEach((k, i) => columns.forEach((l, j) => {
    const from = 3 * (k * counts[1] + l);
    result.set(positions.subarray(from, from + 3), 3 * (i * n + j));
  }));
  return result;
}

/** The commands that blend a material in, each sample by its share. */
export function blended(base: MaterialSamples, share: Float32Array, alpha: number, beta: number): Command[] {
  return painted.map((coefficient) => {
    const target = coefficient.startsWith('alpha') ? alpha : beta;
    const samples = [...base[coefficient]].map((x, k) => Number((x + share[k]! * (target - x)).toPrecision(share[k] === 0 ? 12 : 4)));
    return { do: 'material', coefficient, counts: base.counts, samples };
  });
}

/** How much each span's material differs from that of most of the surface: 0 the same, 1 ten times as stiff or soft. */
export function difference({ counts: [m, n], ...values }: MaterialSamples, linesS: readonly number[], linesT: readonly number[]): Float32Array {
  const stiff = [...values.beta11].map((b, k) => Math.log10(Math.max(b, 1e-9)) + Math.log10(Math.max(values.alpha11[k]!, 1e-9)));
  const tally = new Map<string, number>();
  for (const x of stiff) tally.set(x.toFixed(2), (tally.get(x.toFixed(2)) ?? 0) + 1);
  const usual = Number([...tally].reduce((a, b) => (b[1] > a[1] ? b : a))[0]);
  const columns = linesT.length - 1;
  return Float32Array.from({ length: (linesS.length - 1) * columns }, (_, k) => {
    const [a, b] = [Math.floor(k / columns), k % columns];
    const i = Math.round(((linesS[a]! + linesS[a + 1]!) / 2) * (m - 1));
    const j = Math.round(((linesT[b]! + linesT[b + 1]!) / 2) * (n - 1));
    return Math.min(1, Math.abs(stiff[i * n + j]! - usual));
  });
}
