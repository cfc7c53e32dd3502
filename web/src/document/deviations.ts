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

// A scan has a million points: what goes over all of them are loops, which make nothing for each.

/** Where points are shown at a scale, from an origin: those with a partner where the data lead it, the others where they are. */
export function placesAt({ places, feet, wanted, states }: Deviations, scale: number, origin: readonly number[] = [0, 0, 0]): Float32Array {
  const result = new Float32Array(places.length);
  for (let k = 0; k < states.length; ++k) {
    for (let d = 0; d < 3; ++d) {
      const at = 3 * k + d;
      result[at] = (states[k] === 0 ? feet[at]! + scale * wanted[at]! : places[at]!) - origin[d]!;
    }
  }
  return result;
}

/**
 * How far the model is from where the data lead at a scale, along its normals; NaN without a partner. `after`: what was left by a
 * morph at the scale `made`, of which the share `part` is shown. All of it is linear.
 */
export function distancesAt({ distances, states }: Deviations, scale: number, after: Float64Array | null, made: number, part: number): Float64Array {
  const result = new Float64Array(distances.length);
  for (let k = 0; k < result.length; ++k) {
    const d = distances[k]!;
    result[k] = states[k] !== 0 ? NaN : scale * (after ? (1 - part) * d + (part * after[k]!) / made : d);
  }
  return result;
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

/** Where data have led at a scale, as a scan (PLY) with the normals that the faces had there; and the numbers of its points. */
export function targetsOf({ feet, wanted, normals, states }: Deviations, scale: number): { scan: Uint8Array; numbers: Uint32Array } {
  const used = Uint32Array.from(states.keys()).filter((k) => states[k] === 0);
  const step = Math.ceil(used.length / mostTargets);
  const numbers = used.filter((_, k) => k % step === 0);
  const rows = new Float64Array(6 * numbers.length);
  numbers.forEach((number, k) => {
    for (let d = 0; d < 3; ++d) {
      rows[6 * k + d] = feet[3 * number + d]! + scale * wanted[3 * number + d]!;
      rows[6 * k + 3 + d] = normals[3 * number + d]!;
    }
  });
  const head = new TextEncoder().encode(['ply', 'format binary_little_endian 1.0', `element vertex ${numbers.length}`,
    ...['x', 'y', 'z', 'nx', 'ny', 'nz'].map((name) => `property double ${name}`), 'end_header', ''].join('\n'));
  const scan = new Uint8Array(head.length + rows.byteLength);
  scan.set(head);
  scan.set(new Uint8Array(rows.buffer), head.length);
  return { scan, numbers };
}

/** The number that stands at a place of the order; the numbers change theirs (Hoare's quickselect). */
function selected(numbers: Float64Array, place: number): number {
  for (let low = 0, high = numbers.length - 1; low < high;) {
    const pivot = numbers[(low + high) >> 1]!;
    let [i, j] = [low, high];
    while (i <= j) {
      while (numbers[i]! < pivot) ++i;
      while (numbers[j]! > pivot) --j;
      if (i > j) break;
      const swapped = numbers[i]!;
      numbers[i++] = numbers[j]!;
      numbers[j--] = swapped;
    }
    if (place <= j) high = j;
    else if (place >= i) low = i;
    else break;
  }
  return numbers[place]!;
}

/** What a share of the sizes does not exceed. */
export function share(distances: Float64Array, part: number): number {
  const sizes = new Float64Array(distances.length);
  let count = 0;
  for (let k = 0; k < distances.length; ++k) {
    if (!Number.isNaN(distances[k]!)) sizes[count++] = Math.abs(distances[k]!);
  }
  return count === 0 ? 0 : selected(sizes.subarray(0, count), Math.ceil(part * count) - 1);
}

export interface Measures {
  rms: number;
  of95: number;
  largest: number;
}
export function measuresOf(distances: Float64Array): Measures {
  let [count, squares, largest] = [0, 0, 0];
  for (let k = 0; k < distances.length; ++k) {
    const d = distances[k]!;
    if (Number.isNaN(d)) continue;
    ++count;
    squares += d * d;
    largest = Math.max(largest, Math.abs(d));
  }
  return { rms: Math.sqrt(squares / Math.max(1, count)), of95: share(distances, 0.95), largest };
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

const steps = 128; // of colours, either way
const leftOut = [0.5, 0.5, 0.5] as const; // points without a partner

/** Three bytes for each distance, as they look on the screen. */
export function coloursAt(distances: Float64Array, limit: number): Uint8Array {
  const table = new Uint8Array(3 * (2 * steps + 2));
  for (let k = 0; k <= 2 * steps + 1; ++k) table.set((k > 2 * steps ? leftOut : colourAt(k - steps, steps)).map((x) => Math.round(255 * x)), 3 * k);
  const result = new Uint8Array(3 * distances.length);
  for (let k = 0; k < distances.length; ++k) {
    const d = distances[k]!, share = limit > 0 ? Math.max(-1, Math.min(1, d / limit)) : Math.sign(d);
    const row = 3 * (Number.isNaN(d) ? 2 * steps + 1 : Math.round(steps * (share + 1)));
    result[3 * k] = table[row]!;
    result[3 * k + 1] = table[row + 1]!;
    result[3 * k + 2] = table[row + 2]!;
  }
  return result;
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
