import type { Command, Picture, SurfaceInfo } from '../engine/session_types';

/** Painted material: samples of the coefficients over the domain, linear in between (docs/scripts.md, `material`). */

export const coefficients = ['alpha11', 'alpha22', 'beta11', 'beta12', 'beta22'] as const;
type Coefficient = (typeof coefficients)[number];
const plain: Record<Coefficient, number> = { alpha11: 1, alpha22: 1, beta11: 0.01, beta12: 0.01, beta22: 0.01 };

/** (i, j) is sample i counts[1] + j, at fractions i / (counts[0] - 1), j / (counts[1] - 1). */
export interface Samples {
  counts: [number, number];
  values: Record<Coefficient, Float64Array>;
}

interface Field {
  counts: [number, number];
  samples: readonly number[];
}

const most = 33;

/** As finely as the net can follow, within reason. */
export const sampleCounts = ({ net, degree }: SurfaceInfo): [number, number] =>
  net.map((n, d) => Math.min(most, Math.max(9, n - degree[d]! + 1))) as [number, number];

function at({ counts: [m, n], samples }: Field, s: number, t: number): number {
  const [x, y] = [s * (m - 1), t * (n - 1)];
  const [i, j] = [Math.min(Math.floor(x), Math.max(0, m - 2)), Math.min(Math.floor(y), Math.max(0, n - 2))];
  const value = (a: number, b: number) => samples[Math.min(a, m - 1) * n + Math.min(b, n - 1)]!;
  const across = (a: number) => value(a, j) + (y - j) * (value(a, j + 1) - value(a, j));
  return across(i) + (x - i) * (across(i + 1) - across(i));
}

/** What the commands that stand have made of the material of a surface. Regions of older scripts are not among it. */
export function materialOf(commands: readonly Command[], info: SurfaceInfo, only: boolean): Samples {
  let mine = only;
  let fields: Partial<Record<Coefficient, Field | number>> = {};
  for (const c of commands) {
    if (c.do === 'new') mine = only;
    if (c.do === 'select') mine = c.surface === info.id || (Array.isArray(c.surfaces) && c.surfaces.includes(info.id));
    if (c.do !== 'material' || !mine || c.region !== undefined) continue;
    if (typeof c.coefficient === 'string') {
      fields[c.coefficient as Coefficient] = { counts: c.counts as [number, number], samples: c.samples as number[] };
    } else {
      const [alpha, beta] = [(c.alpha ?? [1, 0, 1]) as number[], (c.beta ?? [0.01, 0.01, 0.01]) as number[]];
      fields = { alpha11: alpha[0]!, alpha22: alpha[2]!, beta11: beta[0]!, beta12: beta[1]!, beta22: beta[2]! };
    }
  }
  const counts = sampleCounts(info);
  const [m, n] = counts;
  const sampled = (name: Coefficient) => {
    const field = fields[name] ?? plain[name];
    return Float64Array.from({ length: m * n }, (_, k) =>
      typeof field === 'number' ? field : at(field, Math.floor(k / n) / (m - 1), (k % n) / (n - 1)));
  };
  return { counts, values: Object.fromEntries(coefficients.map((c) => [c, sampled(c)])) as Record<Coefficient, Float64Array> };
}

/** Where the samples lie: places of the drawn grid, 3 numbers each. */
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
export function blended(base: Samples, share: Float32Array, alpha: number, beta: number): Command[] {
  return coefficients.map((coefficient) => {
    const target = coefficient.startsWith('alpha') ? alpha : beta;
    const samples = [...base.values[coefficient]].map((x, k) => Number((x + share[k]! * (target - x)).toPrecision(4)));
    return { do: 'material', coefficient, counts: base.counts, samples };
  });
}

/** How far each span's material is from that which most of the surface has: 0 alike, 1 ten times as stiff or soft. */
export function difference({ counts: [m, n], values }: Samples, linesS: readonly number[], linesT: readonly number[]): Float32Array {
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
