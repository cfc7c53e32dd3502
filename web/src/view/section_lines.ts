import type { Context, Trim } from '../engine/context';
import type { Picture } from '../engine/session_types';
import { shown } from '../engine/trim_tree';

/** Where a plane meets what is drawn: pure functions of buffers. A plane is (a, b, c, d): a x + b y + c z + d = 0. */
export type PlaneNumbers = readonly [number, number, number, number];

/** One end of a piece of a cut: place, and fractions of the domain. */
interface End {
  p: [number, number, number];
  s: number;
  t: number;
}

const mix = (a: number, b: number, x: number) => a + x * (b - a);

/** The piece of a triangle in the plane, from the values of the plane at its corners; null where it does not cross. */
function crossing(values: readonly number[], at: (corner: number, towards: number, share: number) => void): boolean {
  const inside = values.map((v) => v >= 0);
  if (inside[0] === inside[1] && inside[1] === inside[2]) return false;
  const alone = inside[0] === inside[1] ? 2 : inside[0] === inside[2] ? 1 : 0;
  for (const other of [(alone + 1) % 3, (alone + 2) % 3]) at(alone, other, values[alone]! / (values[alone]! - values[other]!));
  return true;
}

/** The cut of a drawn surface, of what its trims leave of it: two points of 3 numbers per piece. */
export function cutOfPicture(picture: Picture, plane: PlaneNumbers, trim: Trim): number[] {
  const { counts: [m, n], positions, s, t } = picture;
  const [a, b, c, d] = plane;
  const values = new Float64Array(m * n);
  for (let k = 0; k < values.length; ++k) values[k] = a * positions[3 * k]! + b * positions[3 * k + 1]! + c * positions[3 * k + 2]! + d;
  const result: number[] = [];
  const piece = (corners: readonly number[]) => {
    const ends: End[] = [];
    crossing(corners.map((k) => values[k]!), (from, to, share) => {
      const [k, l] = [corners[from]!, corners[to]!];
      const along = (x: 0 | 1 | 2) => mix(positions[3 * k + x]!, positions[3 * l + x]!, share);
      ends.push({ p: [along(0), along(1), along(2)], s: mix(s[Math.floor(k / n)]!, s[Math.floor(l / n)]!, share), t: mix(t[k % n]!, t[l % n]!, share) });
    });
    if (ends.length === 2) visiblePieces(ends[0]!, ends[1]!, trim, result);
  };
  for (let i = 0; i + 1 < m; ++i) {
    for (let j = 0; j + 1 < n; ++j) {
      const k = i * n + j;
      const below = Number(values[k]! >= 0) + Number(values[k + 1]! >= 0) + Number(values[k + n]! >= 0) + Number(values[k + n + 1]! >= 0);
      if (below === 0 || below === 4) continue;
      piece([k, k + n, k + n + 1]);
      piece([k, k + n + 1, k + 1]);
    }
  }
  return result;
}

/** The cut of the grey faces. */
export function cutOfContext({ positions, indices }: Pick<Context, 'positions' | 'indices'>, plane: PlaneNumbers): number[] {
  const [a, b, c, d] = plane;
  const result: number[] = [];
  const value = (k: number) => a * positions[3 * k]! + b * positions[3 * k + 1]! + c * positions[3 * k + 2]! + d;
  for (let at = 0; at < indices.length; at += 3) {
    const corners = [indices[at]!, indices[at + 1]!, indices[at + 2]!];
    crossing(corners.map(value), (from, to, share) => {
      for (let x = 0; x < 3; ++x) result.push(mix(positions[3 * corners[from]! + x]!, positions[3 * corners[to]! + x]!, share));
    });
  }
  return result;
}

/** Appends the parts of a piece that the trims leave: it is divided where loops cross it. */
function visiblePieces(a: End, b: End, trim: Trim, into: number[]): void {
  if (!trim) {
    into.push(...a.p, ...b.p);
    return;
  }
  const cuts = [0, 1];
  const [ds, dt] = [b.s - a.s, b.t - a.t];
  for (const loop of trim.faces.flat()) {
    for (let k = 0, l = loop.length - 2; k < loop.length; l = k, k += 2) {
      const [es, et] = [loop[k]! - loop[l]!, loop[k + 1]! - loop[l + 1]!];
      const area = ds * et - dt * es;
      if (area === 0) continue;
      const [fs, ft] = [loop[l]! - a.s, loop[l + 1]! - a.t];
      const [along, across] = [(fs * et - ft * es) / area, (fs * dt - ft * ds) / area];
      if (along > 0 && along < 1 && across >= 0 && across <= 1) cuts.push(along);
    }
  }
  cuts.sort((x, y) => x - y);
  const at = (x: number) => a.p.map((p, d) => mix(p, b.p[d]!, x));
  for (let k = 0; k + 1 < cuts.length; ++k) {
    const middle = (cuts[k]! + cuts[k + 1]!) / 2;
    if (shown(trim, mix(a.s, b.s, middle), mix(a.t, b.t, middle))) into.push(...at(cuts[k]!), ...at(cuts[k + 1]!));
  }
}
