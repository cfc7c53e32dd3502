import type { Rhino, RhinoNurbs, RhinoPointList } from './module';

/** A surface in Knead's terms: full knot vectors, Cartesian control points, point (i, j) at i n + j. */
export interface Patch {
  degree: [number, number];
  net: [number, number];
  knots_u: number[];
  knots_v: number[];
  points: [number, number, number][];
  weights: number[] | null;
}

/**
 * openNURBS leaves out the first and the last knot of the n + p + 1 of a knot vector: no basis function depends on them
 * inside the domain, from knot p to knot n. Any value outside it gives exactly the same surface; Knead uses
 * those of openNURBS (`superfluousKnot`): the repeated end of a clamped vector, the next knot of a periodic one.
 */
function fullKnots(list: { toList(): number[]; superfluousKnot(start: boolean): number }): number[] {
  const knots = list.toList();
  const first = Math.min(list.superfluousKnot(true), knots[0]!), last = Math.max(list.superfluousKnot(false), knots.at(-1)!);
  return [first, ...knots, last];
}

export function patchOf(nurbs: RhinoNurbs): Patch {
  const list = nurbs.points();
  const net: [number, number] = [list.countU, list.countV];
  const points: Patch['points'] = [], weights: number[] = [];
  for (let i = 0; i < net[0]; ++i) {
    for (let j = 0; j < net[1]; ++j) {
      const [x, y, z, w] = list.get(i, j);
      points.push(nurbs.isRational ? [x / w, y / w, z / w] : [x, y, z]);
      weights.push(w);
    }
  }
  return { degree: [nurbs.orderU - 1, nurbs.orderV - 1], net, knots_u: fullKnots(nurbs.knotsU()), knots_v: fullKnots(nurbs.knotsV()),
    points, weights: nurbs.isRational ? weights : null };
}

const homogeneous = (patch: Patch, k: number): number[] => {
  const w = patch.weights?.[k] ?? 1;
  return [...patch.points[k]!.map((x) => x * w), w];
};

/** Sets the control points of `to` that differ between the shapes `before` and `now`; the others keep their bits. */
export function movePoints(to: RhinoPointList, before: Patch, now: Patch): void {
  now.points.forEach((point, k) => {
    const same = point.every((x, axis) => Object.is(x, before.points[k]![axis])) && before.weights?.[k] === now.weights?.[k];
    if (!same) to.set(Math.floor(k / now.net[1]), k % now.net[1], homogeneous(now, k));
  });
}

export function nurbsOf(rhino: Rhino, patch: Patch): RhinoNurbs {
  const nurbs = rhino.NurbsSurface.create(3, patch.weights !== null, patch.degree[0] + 1, patch.degree[1] + 1, ...patch.net);
  const u = nurbs.knotsU(), v = nurbs.knotsV(), list = nurbs.points();
  patch.knots_u.slice(1, -1).forEach((knot, k) => u.set(k, knot));
  patch.knots_v.slice(1, -1).forEach((knot, k) => v.set(k, knot));
  for (let k = 0; k < patch.points.length; ++k) list.set(Math.floor(k / patch.net[1]), k % patch.net[1], homogeneous(patch, k));
  return nurbs;
}

const sameNumbers = (a: number[], b: number[]) => a.length === b.length && a.every((x, k) => Object.is(x, b[k]));

/** The same degree, knots and number of control points: only positions and weights may differ. */
export const sameSpace = (a: Patch, b: Patch): boolean =>
  sameNumbers(a.degree, b.degree) && sameNumbers(a.knots_u, b.knots_u) && sameNumbers(a.knots_v, b.knots_v) &&
  (a.weights === null) === (b.weights === null);

export const samePatch = (a: Patch, b: Patch): boolean =>
  sameSpace(a, b) && sameNumbers(a.points.flat(), b.points.flat()) && sameNumbers(a.weights ?? [], b.weights ?? []);
