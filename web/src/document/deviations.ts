import type { DataDeviation } from '@knead/generated';
import type { Picture } from '../engine/session_types';
import { format } from './units';

/** Why points have no partner, by the numbers that the engine gives. */
export const pointStates = ['used', 'far', 'beside', 'turned'] as const;

/** How far data are from the model, as numbers: three of each point, but for distances and states. */
export interface Deviations {
  info: DataDeviation;
  places: Float64Array;
  feet: Float64Array;
  normals: Float64Array;
  wanted: Float64Array;
  distances: Float64Array;
  states: Uint8Array;
}

export function deviationsOf(info: DataDeviation): Deviations {
  const numbers = (bytes: Uint8Array) => new Float64Array(bytes.buffer as ArrayBuffer, bytes.byteOffset, bytes.length / 8); // which the engine gives alone
  const { places, feet, normals, wanted, distances, states } = info;
  return { info, places: numbers(places), feet: numbers(feet), normals: numbers(normals), wanted: numbers(wanted), distances: numbers(distances), states };
}

/** Where points are shown at a scale: those with a partner where the data lead it, the others where they are. */
export function placesAt({ places, feet, wanted, states }: Deviations, scale: number): Float64Array {
  return Float64Array.from(places, (x, k) => (states[Math.floor(k / 3)] === 0 ? feet[k]! + scale * wanted[k]! : x));
}

/**
 * How far the model is from where the data lead at a scale, along its normals; NaN without a partner. `after`: what was left by a
 * morph at the scale `made`, of which the share `part` is shown. All of it is linear.
 */
export function distancesAt(before: Deviations, scale: number, after: Float64Array | null, made: number, part: number): Float64Array {
  return Float64Array.from(before.distances, (d, k) => {
    if (before.states[k] !== 0) return NaN;
    return after ? scale * ((1 - part) * d + (part * after[k]!) / made) : scale * d;
  });
}

/** The distances after a morph at the points of the data before it. `numbers`: of these, where each point of the later data comes from. */
export function sorted(later: Deviations, numbers: Uint32Array, points: number): Float64Array {
  const result = new Float64Array(points).fill(NaN);
  numbers.forEach((number, k) => {
    if (later.states[k] === 0) result[number] = later.distances[k]!;
  });
  return result;
}

const mostTargets = 200_000;

/** Where data have led at a scale, as a scan with the normals that the faces had there: a line for each, and its number. */
export function targetsOf({ feet, wanted, normals, states }: Deviations, scale: number): { text: string; numbers: Uint32Array } {
  const used = Uint32Array.from(states.keys()).filter((k) => states[k] === 0);
  const step = Math.ceil(used.length / mostTargets);
  const numbers = used.filter((_, k) => k % step === 0);
  const lines = Array.from(numbers, (k) => [0, 1, 2].map((d) => feet[3 * k + d]! + scale * wanted[3 * k + d]!).concat([0, 1, 2].map((d) => normals[3 * k + d]!)).join(' '));
  return { text: `${lines.join('\n')}\n`, numbers };
}

/** What a share of the sizes does not exceed. */
export function share(distances: Float64Array, part: number): number {
  const sizes = distances.filter((d) => !Number.isNaN(d)).map(Math.abs).sort();
  return sizes.length === 0 ? 0 : sizes[Math.ceil(part * sizes.length) - 1]!;
}

export interface Measures {
  rms: number;
  of95: number;
  largest: number;
}
export function measuresOf(distances: Float64Array): Measures {
  const known = distances.filter((d) => !Number.isNaN(d));
  return { rms: Math.sqrt(known.reduce((sum, d) => sum + d * d, 0) / Math.max(1, known.length)), of95: share(known, 0.95), largest: known.reduce((most, d) => Math.max(most, Math.abs(d)), 0) };
}

/** Rounded up to two digits: a limit for the eye. */
export function shortAbove(value: number): number {
  if (!(value > 0)) return 0;
  const step = 10 ** (Math.floor(Math.log10(value)) - 1);
  return Number((Math.ceil(value / step - 1e-9) * step).toPrecision(2));
}

export interface Histogram {
  /** From −extent to extent, in equal bins; what is beyond counts in the first and the last. */
  extent: number;
  counts: number[];
  below: number;
  inside: number;
  above: number;
}

/** Of distances that are numbers. The limits lie at bins' ends: at a third and two thirds, of bins that are a multiple of six. */
export function histogram(distances: Float64Array, limit: number, bins = 48): Histogram {
  const extent = 1.5 * limit;
  const result: Histogram = { extent, counts: Array<number>(bins).fill(0), below: 0, inside: 0, above: 0 };
  for (const d of distances) {
    if (Number.isNaN(d)) continue;
    if (d < -limit) ++result.below;
    else if (d > limit) ++result.above;
    else ++result.inside;
    const at = extent > 0 ? Math.floor(((d + extent) / (2 * extent)) * bins) : bins / 2;
    ++result.counts[Math.max(0, Math.min(bins - 1, at))]!;
  }
  return result;
}

/** Blue below, grey within nothing, red above: as the deviation of surfaces (view/surface_shader.ts). */
const ends = { below: [0x2b, 0x61, 0xbd], middle: [0xde, 0xde, 0xde], above: [0xc7, 0x3b, 0x30] } as const;
export const ramp = `linear-gradient(90deg, #2b61bd, #dedede 50%, #c73b30)`;

/** From 0 to 1; beyond the limit that of the limit. */
export function colourAt(distance: number, limit: number): [number, number, number] {
  const t = limit > 0 ? Math.max(-1, Math.min(1, distance / limit)) : Math.sign(distance);
  const end = t < 0 ? ends.below : ends.above;
  return [0, 1, 2].map((d) => (ends.middle[d]! + Math.abs(t) * (end[d]! - ends.middle[d]!)) / 255) as [number, number, number];
}

/** A grid of points over a surface, at fractions of its domain. */
export type Grid = Pick<Picture, 'positions' | 'normals' | 's' | 't'>;

/** A grid at other fractions, linear in each cell. */
export function sampledAt({ s, t, ...from }: Grid, of: 'positions' | 'normals', at: Pick<Grid, 's' | 't'>): Float32Array {
  const cells = (lines: Float32Array, places: Float32Array) => Array.from(places, (x) => {
    let k = 0;
    for (let high = lines.length - 1; high - k > 1;) {
      const middle = (k + high) >> 1;
      if (lines[middle]! <= x) k = middle;
      else high = middle;
    }
    const [a, b] = [lines[k]!, lines[k + 1] ?? lines[k]!];
    return [k, b > a ? Math.max(0, Math.min(1, (x - a) / (b - a))) : 0] as const;
  });
  const rows = cells(s, at.s), columns = cells(t, at.t), n = t.length, values = from[of];
  const result = new Float32Array(3 * rows.length * columns.length);
  let to = 0;
  for (const [k, u] of rows) {
    const below = Math.min(k + 1, s.length - 1);
    for (const [l, v] of columns) {
      const beside = Math.min(l + 1, n - 1);
      for (let d = 0; d < 3; ++d) {
        const value = (row: number, column: number) => values[3 * (row * n + column) + d]!;
        result[to++] = (1 - u) * ((1 - v) * value(k, l) + v * value(k, beside)) + u * ((1 - v) * value(below, l) + v * value(below, beside));
      }
    }
  }
  return result;
}

/** (1 − t) a + t b. */
export const blended = (a: Float32Array, b: Float32Array, t: number): Float32Array => a.map((x, k) => x + t * (b[k]! - x));

const counted = (n: number): string => n.toLocaleString('en');

/** "1,234 of 1,300 points compared; 40 farther than 0.5 mm, 26 beside the model." */
export function coverage({ info, states }: Deviations, unit: string): string {
  const far = info.left_out, rest = [
    far > 0 ? `${counted(far)} farther than ${format(info.reach)}${unit}` : '',
    info.beyond_border > 0 ? `${counted(info.beyond_border)} beside the model` : '',
    info.turned_away > 0 ? `${counted(info.turned_away)} facing another way` : '',
  ].filter(Boolean).join(', ');
  return `${counted(info.used)} of ${counted(states.length)} points compared${rest ? `; left out: ${rest}` : ''}.`;
}
