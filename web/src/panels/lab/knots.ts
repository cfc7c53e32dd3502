import type { Command } from '../../engine/session_types';

/** Editing of knot vectors as lists of numbers. Knots are placed only where the user puts them: nothing is rescaled. */

export type Direction = 'u' | 'v';

export interface Direct {
  degree: number;
  knots: number[];
}

/** A knot that occurs `count` times, at the indices `first` … `first + count − 1`. */
export interface Group {
  value: number;
  first: number;
  count: number;
}

export function groups(knots: readonly number[]): Group[] {
  const all: Group[] = [];
  knots.forEach((value, k) => {
    const last = all.at(-1);
    if (last && last.value === value) ++last.count;
    else all.push({ value, first: k, count: 1 });
  });
  return all;
}

/** How far the indices first … last can move together without passing a neighbour. */
export function limits(knots: readonly number[], first: number, last: number): [number, number] {
  return [first > 0 ? knots[first - 1]! : -Infinity, last + 1 < knots.length ? knots[last + 1]! : Infinity];
}

/**
 * The knots first … last at `to`, kept between their neighbours; within `snap` of one they take its value exactly, and
 * become a knot of higher multiplicity.
 */
export function moved(knots: readonly number[], first: number, last: number, to: number, snap = 0): number[] {
  const [low, high] = limits(knots, first, last);
  let value = Math.min(high, Math.max(low, to));
  if (value - low <= snap) value = low;
  else if (high - value <= snap) value = high;
  return knots.map((x, k) => (k >= first && k <= last ? value : x));
}

export function inserted(knots: readonly number[], value: number): number[] {
  const at = knots.findIndex((x) => x > value);
  return at < 0 ? [...knots, value] : [...knots.slice(0, at), value, ...knots.slice(at)];
}

export function removed(knots: readonly number[], index: number): number[] {
  return knots.filter((_, k) => k !== index);
}

/**
 * The same breakpoints for another degree: clamped ends stay clamped, knots inside keep their multiplicity as far as the
 * degree permits it, ends that are not clamped gain or lose knots at their own distance.
 */
export function withDegree({ degree, knots }: Direct, to: number): Direct {
  const n = knots.length - degree - 1;
  const low = knots[degree]!;
  const high = knots[n]!;
  const inside = groups(knots).filter((g) => g.value > low && g.value < high)
    .flatMap((g) => Array<number>(Math.min(g.count, to + 1)).fill(g.value));
  const end = (own: number[], edge: number, sign: number): number[] => {
    // own: the knots at this end from the domain outwards, the edge first.
    if (own.every((x) => x === edge)) return Array<number>(to + 1).fill(edge);
    const step = Math.max(...own.slice(1).map((x, k) => Math.abs(x - own[k]!)));
    while (own.length < to + 1) own.push(own.at(-1)! + sign * step);
    return own.slice(0, to + 1);
  };
  const before = end(knots.slice(0, degree + 1).reverse(), low, -1).reverse();
  const after = end(knots.slice(n), high, 1);
  return { degree: to, knots: [...before, ...inside, ...after] };
}

/** Numbers separated by commas or white space; otherwise the first entry that is not a number. */
export function parseKnots(text: string): number[] | { at: number; text: string } {
  const words = text.split(/[\s,;]+/).filter((w) => w !== '');
  const numbers = words.map(Number);
  const bad = numbers.findIndex((x) => !Number.isFinite(x));
  return bad < 0 ? numbers : { at: bad, text: words[bad]! };
}

/** The shortest text that reads back as the same number; one knot per word. */
export const knotText = (knots: readonly number[]): string => knots.map(String).join(', ');

/** What `to` has and `from` does not, if `from` loses nothing. */
function additions(from: readonly number[], to: readonly number[]): number[] | null {
  const more: number[] = [];
  let k = 0;
  for (const x of to) {
    if (k < from.length && from[k] === x) ++k;
    else more.push(x);
  }
  return k === from.length ? more : null;
}

/** What turns a surface's knots into these: a command, nothing to do, or the reason why it is impossible. */
export type Change = { kind: 'same' } | { kind: 'command'; command: Command; about: string } | { kind: 'impossible'; why: string };

export function change(direction: Direction, surface: Direct, wanted: Direct): Change {
  if (wanted.degree !== surface.degree) {
    return { kind: 'impossible', why: `the surface has degree ${surface.degree} in ${direction}` };
  }
  const from = surface.knots;
  const to = wanted.knots;
  const p = surface.degree;
  if (from.length === to.length && from.every((x, k) => x === to[k])) return { kind: 'same' };
  const [low, high] = [from[p]!, from[from.length - p - 1]!];
  if (to[p] !== low || to[to.length - p - 1] !== high) {
    return { kind: 'impossible', why: `the domain of the surface, [${low}, ${high}], has to stay: trimming and painted materials live in it` };
  }
  const torn = groups(to).find((g) => g.count > p && g.value > low && g.value < high);
  if (torn) return { kind: 'impossible', why: `the surface would be torn at ${torn.value}, which stands ${torn.count} times` };
  if (from.length === to.length) {
    return { kind: 'command', command: { do: 'knots', direction, knots: [...to] }, about: 'the same control points on these knots: the shape changes' };
  }
  if (to.length < from.length) return { kind: 'impossible', why: 'knots are missing: the net would lose control points' };
  const more = additions(from, to);
  if (!more) return { kind: 'impossible', why: 'knots were moved and inserted: apply one before the other' };
  if (more.some((x) => x <= low || x >= high)) {
    return { kind: 'impossible', why: 'knots can be inserted inside the domain only' };
  }
  const plural = more.length === 1 ? 'one more knot' : `${more.length} more knots`;
  return { kind: 'command', command: { do: 'refine', [`knots_${direction}`]: more }, about: `${plural}: the shape stays` };
}
