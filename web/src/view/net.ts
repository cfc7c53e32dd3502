/** Index sets of control nets and of knot spans; i along u and j along v, flat indices i n + j. */

/** Spans [from, to) in either direction. */
export interface Block {
  u: [number, number];
  v: [number, number];
}

/** Of the domain, in fractions: from and to along u, then along v. */
type Region = [[number, number], [number, number]];

export const gridIndices = (m: number, n: number): number[] => Array.from({ length: m * n }, (_, k) => k);

/** The shortest way for a command to name points: whole rows if there are only such. `chosen` is sorted. */
export function wholeRows(chosen: readonly number[], m: number, n: number): { rows_u: number[] } | { rows_v: number[] } | { which: number[] } {
  const rows = [...new Set(chosen.map((k) => Math.floor(k / n)))];
  if (rows.length * n === chosen.length) return { rows_u: rows };
  const columns = [...new Set(chosen.map((k) => k % n))].sort((a, b) => a - b);
  if (columns.length * m === chosen.length) return { rows_v: columns };
  return { which: [...chosen] };
}

/** Few rectangles that cover exactly the marked cells of an m × n grid: each as wide, then as high, as possible. */
export function blocks(marked: ArrayLike<number | boolean>, m: number, n: number): Block[] {
  const left = Array.from({ length: m * n }, (_, k) => Boolean(marked[k]));
  const found: Block[] = [];
  for (let i = 0; i < m; ++i) {
    for (let j = 0; j < n; ++j) {
      if (!left[i * n + j]) continue;
      let width = 1;
      while (j + width < n && left[i * n + j + width]) ++width;
      const whole = (row: number) => left.slice(row * n + j, row * n + j + width).every(Boolean);
      let height = 1;
      while (i + height < m && whole(i + height)) ++height;
      for (let k = i; k < i + height; ++k) left.fill(false, k * n + j, k * n + j + width);
      found.push({ u: [i, i + height], v: [j, j + width] });
    }
  }
  return found;
}

const short = (x: number) => Number(x.toPrecision(6));

/**
 * A region in fractions of the domain for a block of spans. `inside`: slightly smaller than the spans, for commands that round
 * outward to whole spans, so that single precision cannot reach into the next one.
 */
export function region({ u, v }: Block, linesS: readonly number[], linesT: readonly number[], inside: boolean): Region {
  const between = (lines: readonly number[], [from, to]: [number, number]): [number, number] => {
    const [a, b] = [lines[from]!, lines[to]!];
    const inset = inside ? 0.1 : 0;
    return [short(a + inset * (lines[from + 1]! - a)), short(b - inset * (b - lines[to - 1]!))];
  };
  return [between(linesS, u), between(linesT, v)];
}

/** Marks the spans that a region touches, to which the session rounds it. */
export function mark(into: Uint8Array, [[s0, s1], [t0, t1]]: Region, linesS: readonly number[], linesT: readonly number[]): void {
  const touched = (lines: readonly number[], from: number, to: number) =>
    lines.slice(1).map((end, k) => end > from + 1e-6 && lines[k]! < to - 1e-6);
  const rows = touched(linesS, s0, s1);
  const columns = touched(linesT, t0, t1);
  rows.forEach((a, i) => columns.forEach((b, j) => {
    if (a && b) into[i * columns.length + j] = 1;
  }));
}
