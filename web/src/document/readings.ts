import type { ReadingInfo } from '@knead/generated';
import type { Command, Vector3 } from '../engine/session_types';

/** What is measured, and at how many points. */
export const measureKinds = { radius: 1, distance: 2, angle: 3, normals: 2 } as const;
export type MeasureKind = keyof typeof measureKinds;

/**
 * What the engine says of a point of a surface, or, where `surface` is −1, of a face that does not move. In an assembly all is
 * as in the model, and `place` is which of the places of its part is meant; null where those are others than the file's lengths.
 */
export type MeasuredPoint = Omit<ReadingInfo, 'name'> & { place?: string | null };

/** A measurement. A pinned one follows its points on the surface: they are measurements of the session. */
export interface Reading {
  kind: MeasureKind;
  name: string;
  points: readonly MeasuredPoint[];
  pinned: boolean;
  /** The names of its points in the session; of one that is not pinned those that it would have. */
  names: readonly string[];
}

/** A line of a reading. Without a unit it is words. */
export interface Value {
  label: string;
  value: number | null;
  /** Where the value is none. */
  text: string;
  unit: string;
}

const letters = ['a', 'b', 'c'];
const subtract = (a: Vector3, b: Vector3): Vector3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Vector3, b: Vector3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vector3, b: Vector3): Vector3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a: Vector3) => Math.hypot(...a);

/** Degrees, exact for small angles too; null where a direction is none. */
export function angleBetween(a: Vector3, b: Vector3): number | null {
  if (norm(a) === 0 || norm(b) === 0) return null;
  return (Math.atan2(norm(cross(a, b)), dot(a, b)) * 180) / Math.PI;
}

/** The smallest and the largest radius of curvature; infinite where it is flat to rounding, on a model of this size. */
export function radii(curvature: readonly [number, number], size: number): [number, number] {
  const [a, b] = curvature.map((k) => (Math.abs(k) * size < 1e-9 ? Infinity : 1 / Math.abs(k))) as [number, number];
  return [Math.min(a, b), Math.max(a, b)];
}

/** The numbers of a reading; the first is the one that it is for. `size`: of the model. */
export function valuesOf({ kind, points }: Pick<Reading, 'kind' | 'points'>, unit: string, size: number): Value[] {
  const [a, b, c] = points;
  const length = (label: string, value: number): Value => ({ label, value: Number.isFinite(value) ? value : null, text: 'flat', unit });
  const degrees = (label: string, value: number | null): Value => ({ label, value, text: 'no normal', unit: '°' });
  if (kind === 'angle') return [degrees('angle', angleBetween(subtract(a!.point, b!.point), subtract(c!.point, b!.point)))];
  if (kind === 'normals') return [degrees('angle of normals', angleBetween(a!.normal, b!.normal))];
  if (kind === 'distance') {
    const by = subtract(b!.point, a!.point);
    return [length('distance', norm(by)), ...by.map((d, k) => length(`Δ${'xyz'[k]}`, d))];
  }
  const place = a!.point.map((x, k) => length('xyz'[k]!, x));
  if (!a!.curvature) return [{ label: 'radius', value: null, text: 'no normal', unit }, ...place];
  const [least, most] = radii(a!.curvature, size);
  return [length('smallest radius', least), length('largest radius', most), ...place];
}

/** All digits that a double of such a calculation can vouch for, or as many as fit beside a point. */
export function digits(value: number, count = 12): string {
  const text = String(Number(value.toPrecision(count)));
  return text === '-0' ? '0' : text.replace('e+', 'e');
}

export const inWords = ({ label, value, text, unit }: Value, count?: number): string =>
  `${label} ${value === null ? text : `${digits(value, count)}${unit === '°' ? '°' : ` ${unit}`}`}`;

/** For the clipboard: a name and a line per value. */
export const readingText = (reading: Reading, unit: string, size: number): string =>
  [reading.name, ...valuesOf(reading, unit, size).map((v) => `  ${inWords(v)}`)].join('\n');

const nameOf = (kind: MeasureKind, number: number) => `${kind} ${number}`;

/** The readings that the session follows; its other measurements are of one point each. */
export function pinnedReadings(all: readonly ReadingInfo[]): Reading[] {
  const groups = new Map<string, ReadingInfo[]>();
  for (const r of all) {
    const name = /^((?:radius|distance|angle|normals) \d+)\/[abc]$/.exec(r.name)?.[1] ?? r.name;
    groups.set(name, [...(groups.get(name) ?? []), r]);
  }
  return [...groups].flatMap(([name, points]): Reading[] => {
    const kind = name.split(' ')[0] as MeasureKind;
    const whole = points.length === measureKinds[kind] && points.every((p) => p.name.startsWith(`${name}/`));
    const sorted = [...points].sort((a, b) => (a.name < b.name ? -1 : 1));
    if (whole) return [{ kind, name, points: sorted, pinned: true, names: sorted.map((p) => p.name) }];
    return sorted.map((p) => ({ kind: 'radius', name: p.name, points: [p], pinned: true, names: [p.name] }));
  });
}

/** A reading of points that have been picked, under a name that no other has. */
export function newReading(kind: MeasureKind, points: readonly MeasuredPoint[], others: readonly Reading[]): Reading {
  let number = 1;
  while (others.some((r) => r.name === nameOf(kind, number))) ++number;
  const name = nameOf(kind, number);
  return { kind, name, points, pinned: false, names: points.map((_, k) => `${name}/${letters[k]}`) };
}

/** Why the session cannot follow all of its points; null where it can. It knows parts in their own coordinates, and no grey faces. */
export function cannotFollow({ points }: Reading): string | null {
  if (points.some((p) => p.surface < 0)) return 'Points of grey faces are not pinned';
  return points.some((p) => p.place === null || p.place !== points[0]!.place) ? 'Points in several places of an assembly are not pinned' : null;
}

/** What lets a reading follow the surface. `ids`: of the surfaces. */
export const pinning = ({ points, names }: Reading, ids: readonly string[]): Command[] =>
  points.map((p, k) => ({ do: 'measure', name: names[k]!, surface: ids[p.surface]!, at: p.at }));
