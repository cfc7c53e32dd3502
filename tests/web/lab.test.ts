import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { KneadError } from '@studio/engine/session_types';
import { change, groups, inserted, knotText, moved, parseKnots, removed, withDegree } from '@studio/panels/lab/knots';
import { type Jumps, LabModule, methods, pairs } from '@studio/panels/lab/module';

const root = fileURLToPath(new URL('../..', import.meta.url));
const wasm = readFileSync(join(root, 'web/src/panels/lab/knead_lab.wasm'));
const native = process.env.KNEAD_CLI || join(root, 'build/release/knead');

const uniform = [0, 0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1, 1];
const families: [string, number, number[]][] = [
  ['clamped', 3, uniform],
  ['repeated', 3, [0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5]],
  ['unclamped', 2, [-2, -1.5, 0, 1, 1.25, 3, 4, 6]],
  ['clustered', 3, [0, 0, 0, 0, 1, 1 + 1e-6, 3, 3, 3, 3]],
  ['linear', 1, [0, 0, 1, 1, 2, 5, 5]],
  ['of degree 7', 7, [0, 0, 0, 0, 0, 0, 0, 0, 0.3, 0.4, 0.4, 1, 1, 1, 1, 1, 1, 1, 1]],
];

const load = () => LabModule.load(wasm);
const cli = (degree: number, knots: number[], ...more: string[]): string =>
  execFileSync(native, [more[0]!, '--degree', String(degree), `--knots=${knots.join(',')}`, ...more.slice(1)], { encoding: 'utf8' });

interface Sampled {
  jumps?: { knot: number; jump: number }[];
  diracs?: { knot: number; weight: number }[];
  samples: [number, number | null][];
}

describe("the lab's module", () => {
  it.each(families)('gives the Gramians of the command line, knots %s', async (_, degree, knots) => {
    const lab = await load();
    const { count } = lab.setKnots(degree, knots);
    for (const [a, b] of [[0, 0], [1, 1], [2, 2], [1, 0], [0, 2], [3, 1]] as const) {
      const all = lab.gramians(a, b);
      expect(all.size).toBe(count);
      methods.forEach((method, m) => {
        const { gramians, method: used } = JSON.parse(cli(degree, knots, 'gramian', '--a', `${a}`, '--b', `${b}`, '--method', method)) as
          { method: string; gramians: Record<string, { band: number[][] }> };
        expect(all.used[m]).toBe(used);
        const { band } = gramians[`${a}${b}`]!;
        band.forEach((row, i) => row.forEach((value, s) => {
          const at = i * (2 * degree + 1) + s;
          // The same operations in the same order; only where a function is cut off by the domain the widths of extended
          // precision differ, by less than the rounding of what comes out.
          const tolerance = method === 'analytic' ? 0 : 2.3e-16 * Math.abs(value);
          expect(Math.abs(all.values[m]![at]! - value)).toBeLessThanOrEqual(tolerance);
        }));
      });
    }
  });

  it.each(families)('samples the functions of the command line bit for bit, knots %s', async (_, degree, knots) => {
    const lab = await load();
    const { count } = lab.setKnots(degree, knots);
    for (const order of [0, 1, 2, degree, degree + 1, -1, -3]) {
      for (const i of [0, Math.floor(count / 2), count - 1]) {
        const { samples } = JSON.parse(cli(degree, knots, 'basis', '--index', `${i}`, '--samples', '37', '--format', 'json',
          order < 0 ? '--integral' : '--derivative', `${Math.abs(order)}`)) as Sampled;
        for (const [u, value] of samples) {
          if (u === samples.at(-1)![0]) continue; // at the end of an unclamped domain the limits differ
          expect(lab.probe(order, u).values[i]).toBe(value);
        }
      }
    }
  });

  it.each(families)('draws what it probes, and breaks where a function jumps, knots %s', async (_, degree, knots) => {
    const lab = await load();
    const { count } = lab.setKnots(degree, knots);
    for (let order = -2; order <= degree; ++order) {
      const { points, offsets, lowest, highest } = lab.curves(order, 300);
      expect(offsets.length).toBe(count + 1);
      for (let i = 0; i < count; ++i) {
        const jumps = new Map<number, number>();
        for (let k = offsets[i]!; k < offsets[i + 1]!; ++k) {
          const [u, value] = [points[2 * k]!, points[2 * k + 1]!];
          expect(value).toBeGreaterThanOrEqual(lowest);
          expect(value).toBeLessThanOrEqual(highest);
          if (!knots.includes(u)) expect(lab.probe(order, u).values[i]).toBe(value);
          else if (k > offsets[i]! && points[2 * k - 2] === u) jumps.set(u, value - points[2 * k - 1]!);
        }
        if (order < 0) continue;
        for (const { knot, lowest: least, jumps: sizes } of lab.jumps(i)) {
          const seen = jumps.get(knot);
          if (seen === undefined) continue; // an end of the support
          const size = order < least ? 0 : sizes[order - least]!;
          expect(Math.abs(seen - size)).toBeLessThanOrEqual(1e-9 * (highest - lowest));
        }
      }
    }
  });

  it('knows the impulses of derivatives: the jumps of those before', async () => {
    const lab = await load();
    const [, degree, knots] = families[1]!;
    lab.setKnots(degree, knots);
    for (let order = 1; order <= degree + 2; ++order) {
      const { impulses } = lab.curves(order, 100);
      const found = Array.from({ length: impulses.length / 4 }, (_, k) => impulses.subarray(4 * k, 4 * k + 4));
      for (let i = 0; i < 14; ++i) {
        const expected = JSON.parse(cli(degree, knots, 'basis', '--index', `${i}`, '--samples', '1', '--format', 'json',
          '--derivative', `${order - 1}`)) as Sampled;
        const own = found.filter((f) => f[0] === i && f[2] === 0).map((f) => ({ knot: f[1], jump: f[3] }));
        expect(own).toEqual(order - 1 > degree ? [] : expected.jumps);
      }
    }
    const { diracs } = JSON.parse(cli(degree, knots, 'basis', '--index', '5', '--samples', '1', '--format', 'json', '--derivative', '4')) as Sampled;
    const all = lab.curves(4, 100).impulses;
    const weights = Array.from({ length: all.length / 4 }, (_, k) => all.subarray(4 * k, 4 * k + 4)).filter((f) => f[0] === 5 && f[2] === 0);
    expect(weights.map((f) => ({ knot: f[1], weight: f[3] }))).toEqual(diracs!.map(({ knot, weight }) => ({ knot, weight })));
  });

  it('has functions that sum to one, and integrals that sum to the length', async () => {
    const lab = await load();
    for (const [, degree, knots] of families) {
      const { domain, integrals, clamped } = lab.setKnots(degree, knots);
      expect(lab.curves(0, 300).unity).toBeLessThan(4 * degree * 2.3e-16 * (degree + 1));
      const middle = 0.37 * domain[0] + 0.63 * domain[1];
      expect(lab.probe(0, middle).sum).toBeCloseTo(1, 14);
      expect(Math.abs(lab.probe(1, middle).sum)).toBeLessThan(1e-8);
      if (clamped[0] && clamped[1]) expect(integrals.reduce((sum, x) => sum + x, 0)).toBeCloseTo(domain[1] - domain[0], 13);
      expect(lab.probe(-1, domain[1] + 5).values[0]).toBeCloseTo(integrals[0]!, 13);
    }
  });

  it('measures differences between methods against the integral of the absolute product', async () => {
    const lab = await load();
    lab.setKnots(3, uniform);
    for (const [a, b] of [[0, 0], [1, 1], [2, 2], [1, 0]] as const) {
      const all = lab.gramians(a, b);
      pairs.forEach(([first, second], k) => {
        const [x, y] = [all.values[methods.indexOf(first)]!, all.values[methods.indexOf(second)]!];
        let worst = 0;
        x.forEach((value, at) => {
          expect(all.differences[k]![at]).toBe(value - y[at]!);
          const size = Math.abs(value - y[at]!);
          expect(all.relative[k]![at]).toBe(size === 0 ? 0 : size / all.absolute[at]!);
          worst = Math.max(worst, all.relative[k]![at]!);
        });
        expect(all.worst[k]!.relative).toBe(worst);
        expect(worst).toBeLessThan(1e-11); // docs/gramians: analytic loses some digits on uniform knots, the others none
      });
      all.absolute.forEach((size, at) => {
        expect(size * (1 + 1e-12)).toBeGreaterThanOrEqual(Math.abs(all.values[0]![at]!));
        if (a + b === 0) expect(size).toBeCloseTo(all.values[0]![at]!, 14);
      });
    }
    // ∫|N_0'|² of degree 1 by hand: knots 0, 0, 1, 2, 2 have the slopes −1 | 1, −1 | 1.
    lab.setKnots(1, [0, 0, 1, 2, 2]);
    expect([...lab.gramians(1, 1).absolute]).toEqual([0, 1, 1, 1, 2, 1, 1, 1, 0].map((x) => expect.closeTo(x, 14) as number));
    expect(lab.times(1, 1, 0.001).every((t) => t > 0 && t < 1)).toBe(true);
  });

  it('refuses what is no knot vector, says why, and keeps the one before', async () => {
    const lab = await load();
    expect(() => lab.curves(0, 100)).toThrow(/no knots/);
    lab.setKnots(3, uniform);
    const before = lab.curves(0, 100);
    expect(() => lab.setKnots(3, [0, 0, 0, 0, 2, 1, 3, 3, 3, 3])).toThrow(KneadError);
    expect(() => lab.setKnots(3, [0, 0, 0, 0])).toThrow(/knots/);
    expect(() => lab.setKnots(26, uniform)).toThrow(/degree/);
    expect(() => lab.setKnots(3, [0, 0, 0, 0, NaN, 1, 1, 1, 1])).toThrow(/knot/);
    expect(() => lab.curves(99, 100)).toThrow(/order/);
    expect(() => lab.gramians(26, 0)).toThrow(/26/);
    expect(() => lab.jumps(7)).toThrow(/function 7/);
    expect(lab.curves(0, 100)).toEqual(before);
  });

  it('does not grow while a knot is dragged', async () => {
    const lab = await load();
    const knots = Array.from({ length: 68 }, (_, k) => Math.min(61, Math.max(0, k - 3)));
    const drag = (k: number) => {
      lab.setKnots(3, moved(knots, 30, 30, 27 + (k % 10) / 10));
      lab.curves(0, 800);
      lab.curves(-2, 800);
      lab.gramians(1, 1);
    };
    for (let k = 0; k < 20; ++k) drag(k);
    const before = lab.memorySize;
    for (let k = 0; k < 200; ++k) drag(k);
    expect(lab.memorySize).toBe(before);
  });
});

describe('editing of knots', () => {
  it('keeps a moved knot between its neighbours, and makes it one of them when it is near', () => {
    expect(moved(uniform, 5, 5, 0.6)[5]).toBe(0.6);
    expect(moved(uniform, 5, 5, 2)[5]).toBe(0.75);
    expect(moved(uniform, 5, 5, 0.74, 0.02)[5]).toBe(0.75);
    expect(moved(uniform, 5, 5, 0.72, 0.02)[5]).toBe(0.72);
    expect(moved(uniform, 0, 3, -1).slice(0, 5)).toEqual([-1, -1, -1, -1, 0.25]);
    expect(groups(uniform).map((g) => g.count)).toEqual([4, 1, 1, 1, 4]);
  });

  it('inserts and removes', () => {
    expect(inserted([0, 1, 2], 1)).toEqual([0, 1, 1, 2]);
    expect(inserted([0, 1, 2], 3)).toEqual([0, 1, 2, 3]);
    expect(removed([0, 1, 2], 1)).toEqual([0, 2]);
  });

  it('changes the degree over the same breakpoints', async () => {
    expect(withDegree({ degree: 3, knots: uniform }, 1).knots).toEqual([0, 0, 0.25, 0.5, 0.75, 1, 1]);
    expect(withDegree({ degree: 1, knots: [0, 0, 1, 2, 2] }, 3).knots).toEqual([0, 0, 0, 0, 1, 2, 2, 2, 2]);
    expect(withDegree({ degree: 2, knots: [-2, -1, 0, 1, 2, 3, 4] }, 3).knots).toEqual([-3, -2, -1, 0, 1, 2, 3, 4, 5]);
    const lab = await load();
    for (const [, degree, knots] of families) {
      const before = lab.setKnots(degree, knots).domain;
      for (let to = 1; to <= 15; ++to) {
        const { degree: p, knots: other } = withDegree({ degree, knots }, to);
        expect(lab.setKnots(p, other).domain).toEqual(before);
      }
    }
  });

  it('reads lists of numbers and writes them so that they come back', () => {
    const odd = [0, 1 / 3, 1e-17, 6.02e23];
    expect(parseKnots(knotText(odd))).toEqual(odd);
    expect(parseKnots('0 0\t1;2,\n3')).toEqual([0, 0, 1, 2, 3]);
    expect(parseKnots('0, x, 1')).toEqual({ at: 1, text: 'x' });
  });

  it('finds the command that takes a surface there', () => {
    const surface = { degree: 3, knots: uniform };
    expect(change('u', surface, { degree: 3, knots: [...uniform] }).kind).toBe('same');
    expect(change('u', surface, { degree: 3, knots: moved(uniform, 5, 5, 0.6) })).toMatchObject({ kind: 'command', command: { do: 'knots', direction: 'u' } });
    expect(change('v', surface, { degree: 3, knots: inserted(inserted(uniform, 0.5), 0.1) }))
      .toMatchObject({ command: { do: 'refine', knots_v: [0.1, 0.5] } });
    const torn = [0.5, 0.5, 0.5].reduce<number[]>(inserted, uniform);
    const impossible: [number[], RegExp][] = [[removed(uniform, 5), /missing/], [inserted(moved(uniform, 5, 5, 0.6), 0.1), /moved and inserted/],
      [moved(uniform, 0, 3, -1), /\[0, 1\], has to stay/], [inserted(uniform, 2), /inside the domain/], [torn, /torn at 0.5/]];
    for (const [knots, why] of impossible) {
      expect(change('u', surface, { degree: 3, knots })).toMatchObject({ kind: 'impossible', why: expect.stringMatching(why) as string });
    }
    expect(change('u', surface, { degree: 2, knots: uniform }).kind).toBe('impossible');
  });

  it('knows its jumps by name', async () => {
    const lab = await load();
    lab.setKnots(1, [0, 0, 1, 2, 2]);
    expect(lab.jumps(1)).toEqual([
      { knot: 0, multiplicity: 1, lowest: 1, jumps: [1] },
      { knot: 1, multiplicity: 1, lowest: 1, jumps: [-2] },
      { knot: 2, multiplicity: 1, lowest: 1, jumps: [1] },
    ] satisfies Jumps[]);
  });
});
