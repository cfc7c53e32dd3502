import { angleBetween, digits, inWords, type MeasuredPoint, newReading, pinnedReadings, pinning, radii, readingText, valuesOf } from '@studio/document/readings';

const at = (point: [number, number, number], more: Partial<MeasuredPoint> = {}): MeasuredPoint =>
  ({ surface: 0, at: [0.5, 0.5], point, displacement: [0, 0, 0], normal: [0, 0, 1], curvature: [0, 0], ...more });
const first = (...args: Parameters<typeof valuesOf>) => valuesOf(...args)[0]!.value;

describe('a reading', () => {
  it('of a distance is that of its points, with its parts along the axes', () => {
    const values = valuesOf({ kind: 'distance', points: [at([1, 2, 3]), at([4, 6, 15])] }, 'mm', 20);
    expect(values.map((v) => v.value)).toEqual([13, 3, 4, 12]);
    expect(values.map((v) => v.label)).toEqual(['distance', 'Δx', 'Δy', 'Δz']);
  });

  it('of an angle is at the second point, exact where it is small', () => {
    expect(first({ kind: 'angle', points: [at([1, 0, 0]), at([0, 0, 0]), at([0, 5, 0])] }, 'mm', 1)).toBe(90);
    expect(first({ kind: 'angle', points: [at([1, 0, 0]), at([0, 0, 0]), at([1, 1e-9, 0])] }, 'mm', 1)).toBeCloseTo((1e-9 * 180) / Math.PI, 20);
    expect(first({ kind: 'angle', points: [at([1, 0, 0]), at([0, 0, 0]), at([0, 0, 0])] }, 'mm', 1)).toBeNull();
    expect(angleBetween([0, 0, 1], [0, 0, -2])).toBe(180);
  });

  it('of normals is between them', () => {
    const points = [at([0, 0, 0]), at([1, 0, 0], { normal: [Math.SQRT1_2, 0, Math.SQRT1_2] })];
    expect(first({ kind: 'normals', points }, 'mm', 1)).toBeCloseTo(45, 12);
  });

  it('of radii is the smallest and the largest, and says where it is flat', () => {
    expect(radii([0.25, -2], 10)).toEqual([0.5, 4]);
    expect(radii([1e-12, -2], 10)).toEqual([0.5, Infinity]);
    const [least, most] = valuesOf({ kind: 'radius', points: [at([0, 0, 0], { curvature: [0, -0.125] })] }, 'inch', 10);
    expect([inWords(least!), inWords(most!)]).toEqual(['smallest radius 8 inch', 'largest radius flat']);
    expect(inWords(valuesOf({ kind: 'radius', points: [at([0, 0, 0], { curvature: null })] }, 'mm', 1)[0]!)).toBe('radius no normal');
  });

  it('has all digits that count, and none of rounding', () => {
    expect([0.1 + 0.2, 1 / 3, 123456.789012345, 1e-7, -0].map((x) => digits(x))).toEqual(['0.3', '0.333333333333', '123456.789012', '1e-7', '0']);
    const reading = newReading('distance', [at([0, 0, 0]), at([0, 0, 1 / 3])], []);
    expect(readingText(reading, 'mm', 1)).toBe('distance 1\n  distance 0.333333333333 mm\n  Δx 0 mm\n  Δy 0 mm\n  Δz 0.333333333333 mm');
  });
});

describe('pinned readings', () => {
  it('come back from the measurements of the session by their names', () => {
    const reading = newReading('angle', [at([1, 0, 0]), at([0, 0, 0], { surface: 1, at: [0.25, 0.75] }), at([0, 5, 0])], []);
    const commands = pinning(reading, ['#12', '#34']);
    expect(commands[1]).toEqual({ do: 'measure', name: 'angle 1/b', surface: '#34', at: [0.25, 0.75] });
    const infos = reading.points.map((p, k) => ({ ...p, name: reading.names[k]! }));
    const [back] = pinnedReadings([infos[2]!, infos[0]!, infos[1]!]);
    expect(back).toEqual({ ...reading, pinned: true, points: infos });
  });

  it('that are not whole, or of scripts, are points', () => {
    const all = pinnedReadings([{ ...at([1, 0, 0]), name: 'crown' }, { ...at([2, 0, 0]), name: 'distance 4/a' }]);
    expect(all.map((r) => [r.kind, r.name, r.names])).toEqual([['radius', 'crown', ['crown']], ['radius', 'distance 4/a', ['distance 4/a']]]);
  });

  it('have names that no other has', () => {
    const one = newReading('radius', [at([0, 0, 0])], []);
    expect(newReading('radius', [at([0, 0, 0])], [one]).name).toBe('radius 2');
    expect(newReading('distance', [at([0, 0, 0])], [one]).name).toBe('distance 1');
  });
});
