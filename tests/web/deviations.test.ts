import type { DataDeviation } from '@knead/generated';
import { blended, colourAt, coloursAt, coverage, type Deviations, distancesAt, histogram, measuresOf, placesAt, sampledAt, share, shortAbove, sorted, targetsOf } from '@studio/document/deviations';

/** Three points over z = 0, of which the middle one has no partner. */
const three: Deviations = {
  info: { used: 2, left_out: 1, beyond_border: 0, turned_away: 0, reach: 0.5 } as DataDeviation,
  places: Float64Array.of(0, 0, 2, 5, 5, 9, 1, 0, -1), feet: Float64Array.of(0, 0, 0, 0, 0, 0, 1, 0, 0),
  normals: Float64Array.of(0, 0, 1, 0, 0, 0, 0, 0, 1), wanted: Float64Array.of(0, 0, 2, 0, 0, 0, 0, 0, -1), distances: Float64Array.of(2, 0, -1), states: Uint8Array.of(0, 1, 0),
};

describe('points of data', () => {
  it('lie where displacements lead, and stay without a partner', () => {
    expect([...placesAt(three, 1)]).toEqual([...three.places]);
    expect([...placesAt(three, -2)]).toEqual([0, 0, -4, 5, 5, 9, 1, 0, 2]);
    expect([...placesAt(three, 1, [1, 2, 3])]).toEqual([-1, -2, -1, 4, 3, 6, 0, -2, -4]);
  });

  it('have distances that are linear in the scale and in the share of a morph', () => {
    expect([...distancesAt(three, 2, null, 1, 1)]).toEqual([4, NaN, -2]);
    const left = Float64Array.of(0.2, NaN, 0);
    expect([...distancesAt(three, 1, left, 1, 1)]).toEqual([0.2, NaN, 0]);
    expect([...distancesAt(three, 1, left, 1, 0)]).toEqual([2, NaN, -1]);
    expect(distancesAt(three, 1, left, 1, 0.5)[0]).toBeCloseTo(1.1, 14);
    expect(distancesAt(three, -2, left, 1, 1)[0]).toBeCloseTo(-0.4, 14);
    expect(distancesAt(three, -2, left, -2, 1)[0]).toBeCloseTo(0.2, 14); // as measured
  });

  it('are a scan of where they lead, and what is left of it goes back to them', () => {
    const { scan, numbers } = targetsOf(three, 2);
    expect(new TextDecoder().decode(scan)).toMatch(/^ply\nformat binary_little_endian 1\.0\nelement vertex 2\n(property double \w+\n){6}end_header\n/);
    expect([...new Float64Array(scan.slice(-96).buffer)]).toEqual([0, 0, 4, 0, 0, 1, 1, 0, -2, 0, 0, 1]);
    expect([...numbers]).toEqual([0, 2]);
    const later = { distances: Float64Array.of(0.5, 0.25), states: Uint8Array.of(0, 2) } as Deviations;
    expect([...sorted(later, numbers, 3)]).toEqual([0.5, NaN, NaN]);
  });

  it('are counted in words', () => {
    expect(coverage(three, ' mm')).toBe('2 of 3 points compared; left out: 1 farther than 0.5 mm.');
    expect(coverage({ ...three, info: { ...three.info, left_out: 0 } }, '')).toBe('2 of 3 points compared.');
  });
});

describe('distances', () => {
  const distances = Float64Array.of(-3, -1, -0.5, NaN, 0, 0.5, 1, 1.2);

  it('have an rms, a share and a largest', () => {
    expect(measuresOf(Float64Array.of(3, -4, NaN))).toEqual({ rms: Math.sqrt(12.5), of95: 4, largest: 4 });
    expect(share(Float64Array.from({ length: 100 }, (_, k) => -(k + 1)), 0.95)).toBe(95);
    expect(share(Float64Array.of(10, 9, 1), 0.5)).toBe(9); // by size, not by their digits
    expect(measuresOf(new Float64Array())).toEqual({ rms: 0, of95: 0, largest: 0 });
  });

  it('are as large as sorting them says', () => {
    for (const length of [1, 2, 7, 1000]) {
      const many = Float64Array.from({ length }, (_, k) => ((k * 7919) % 101) - 50); // many are equal
      const sizes = many.map(Math.abs).sort();
      for (const part of [0.01, 0.3, 0.5, 0.95, 1]) expect(share(many, part)).toBe(sizes[Math.ceil(part * length) - 1]);
    }
  });

  it('are counted within limits and beyond', () => {
    const { counts, below, inside, above, extent } = histogram(distances, 1, 6);
    expect([below, inside, above]).toEqual([1, 5, 1]);
    expect(counts).toEqual([1, 1, 1, 1, 1, 2]);
    expect(extent).toBe(1.5);
    expect(histogram(Float64Array.of(0, 0), 0, 6)).toMatchObject({ below: 0, inside: 2, above: 0 });
  });

  it('end at a limit that is short', () => {
    expect([0.0312, 1, 9.91, 123, 0].map(shortAbove)).toEqual([0.032, 1, 10, 130, 0]);
  });

  it('have colours either way of grey, and no others beyond the limit', () => {
    expect(colourAt(0, 1)).toEqual([0xde / 255, 0xde / 255, 0xde / 255]);
    expect(colourAt(5, 1)).toEqual(colourAt(1, 1));
    expect(colourAt(1, 1)[0]).toBeGreaterThan(colourAt(1, 1)[2]);
    expect(colourAt(-1, 1)[2]).toBeGreaterThan(colourAt(-1, 1)[0]);
    expect(colourAt(0.5, 1)[0]).toBeCloseTo((0xde + 0xc7) / 2 / 255, 12);
    const bytes = coloursAt(Float64Array.of(-9, -1, 0, 0.5, 1, 9, NaN), 1);
    [-1, -1, 0, 0.5, 1, 1].forEach((d, k) => expect([...bytes.subarray(3 * k, 3 * k + 3)]).toEqual(colourAt(d, 1).map((x) => Math.round(255 * x))));
    expect([...bytes.subarray(18)]).toEqual([128, 128, 128]);
    expect([...coloursAt(Float64Array.of(1), 0)]).toEqual(colourAt(1, 1).map((x) => Math.round(255 * x)));
  });
});

describe('a surface between two', () => {
  const plane = (s: number[], t: number[], z: (u: number, v: number) => number) => ({
    s: Float32Array.from(s), t: Float32Array.from(t), normals: new Float32Array(3 * s.length * t.length),
    positions: Float32Array.from(s.flatMap((u) => t.flatMap((v) => [u, v, z(u, v)]))),
  });

  it('is drawn on the other grid, where what is linear stays', () => {
    const coarse = plane([0, 0.5, 1], [0, 1], (u, v) => 2 * u - v), fine = plane([0, 0.1, 0.5, 0.7, 1], [0, 0.25, 1], (u, v) => 2 * u - v);
    sampledAt(coarse, 'positions', fine).forEach((x, k) => expect(x).toBeCloseTo(fine.positions[k]!, 6));
    expect(sampledAt(fine, 'positions', fine)).toEqual(fine.positions);
  });

  it('is a linear blend', () => {
    const [a, b] = [Float32Array.of(0, 2), Float32Array.of(1, 4)];
    expect([...blended(a, b, 0.5)]).toEqual([0.5, 3]);
    expect([...blended(a, b, -1)]).toEqual([-1, 0]);
    expect(blended(a, b, 1)).toEqual(b);
  });
});
