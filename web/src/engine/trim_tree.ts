import type { Trim, TrimTree } from './context';

/** Where in a square its reference lies: nowhere that loops would run along. */
export const reference = [0.38196601125, 0.43701602445] as const;
const fewSegments = 6;
export const deepest = 14;
const margin = 0.125; // of a leaf: as far around it segments count, for the width of edges

type Segment = readonly [number, number, number, number];
type Place = readonly [number, number];

const cross = (ax: number, ay: number, bx: number, by: number) => ax * by - ay * bx;

/** Whether a segment lies between two points, by rules under which a closed loop is crossed evenly. */
export function between([ax, ay, bx, by]: Segment, [px, py]: Place, [qx, qy]: Place): boolean {
  const [dx, dy] = [qx - px, qy - py];
  if (cross(dx, dy, ax - px, ay - py) >= 0 === cross(dx, dy, bx - px, by - py) >= 0) return false;
  return cross(bx - ax, by - ay, px - ax, py - ay) >= 0 !== cross(bx - ax, by - ay, qx - ax, qy - ay) >= 0;
}

/** Whether a segment meets a square with some room around it. */
function meets([ax, ay, bx, by]: Segment, x: number, y: number, size: number): boolean {
  const room = margin * size;
  const [x0, x1, y0, y1] = [x - room, x + size + room, y - room, y + size + room];
  if (Math.max(ax, bx) < x0 || Math.min(ax, bx) > x1 || Math.max(ay, by) < y0 || Math.min(ay, by) > y1) return false;
  // The corners of the square on one side of the line: it misses.
  const side = (px: number, py: number) => cross(bx - ax, by - ay, px - ax, py - ay);
  const sides = [side(x0, y0), side(x1, y0), side(x0, y1), side(x1, y1)];
  return !(sides.every((v) => v > 0) || sides.every((v) => v < 0));
}

/** Whether some face shows a point of the domain: an odd number of its loops enclose it. */
export function shown(trim: Trim, s: number, t: number): boolean {
  if (!trim) return true;
  return trim.faces.some((loops) => {
    let odd = false;
    for (const loop of loops) {
      for (let k = 0, l = loop.length - 2; k < loop.length; l = k, k += 2) {
        const [t0, t1] = [loop[k + 1]!, loop[l + 1]!];
        if (t0 > t !== t1 > t && s < loop[k]! + (loop[l]! - loop[k]!) * ((t - t0) / (t1 - t0))) odd = !odd;
      }
    }
    return odd;
  });
}

/** Null: all of the surface shows. Cost: n log n in the segments. */
export function trimTree(trim: Trim): TrimTree | null {
  if (!trim) return null;
  const all: Segment[] = [];
  for (const loop of trim.faces.flat()) {
    for (let k = 0, l = loop.length - 2; k < loop.length; l = k, k += 2) {
      // In single precision, as they are drawn with.
      const [ax, ay, bx, by] = [loop[l]!, loop[l + 1]!, loop[k]!, loop[k + 1]!].map(Math.fround) as [number, number, number, number];
      if (ax !== bx || ay !== by) all.push([ax, ay, bx, by]);
    }
  }
  const nodes: number[] = [0, 0, 0, 0];
  const segments: number[] = [];
  const divide = (node: number, x: number, y: number, size: number, depth: number, inside: readonly Segment[], here: Place, shows: boolean) => {
    if (inside.length <= fewSegments || depth === deepest) {
      nodes.splice(4 * node, 4, segments.length / 4, inside.length, shows ? 1 : 0, 0);
      for (const s of inside) segments.push(...s);
      return;
    }
    const first = nodes.length / 4;
    nodes.splice(4 * node, 4, first, -1, 0, 0);
    for (let k = 0; k < 16; ++k) nodes.push(0);
    const half = size / 2;
    for (let k = 0; k < 4; ++k) {
      const [cx, cy] = [x + (k & 1) * half, y + (k >> 1) * half];
      const there: Place = [cx + reference[0] * half, cy + reference[1] * half];
      const turns = inside.reduce((count, s) => count + (between(s, here, there) ? 1 : 0), 0);
      divide(first + k, cx, cy, half, depth + 1, inside.filter((s) => meets(s, cx, cy, half)), there, shows !== (turns % 2 === 1));
    }
  };
  const root: Place = reference;
  divide(0, 0, 0, 1, 0, all.filter((s) => meets(s, 0, 0, 1)), root, shown(trim, ...root));
  return { nodes: new Float32Array(nodes), segments: new Float32Array(segments) };
}

/** As the shader decides it, for a point of the domain. */
export function showsAt({ nodes, segments }: TrimTree, s: number, t: number): boolean {
  let [node, x, y, size] = [0, 0, 0, 1];
  while (nodes[4 * node + 1]! < 0) {
    size /= 2;
    const [right, up] = [s >= x + size ? 1 : 0, t >= y + size ? 1 : 0];
    x += right * size;
    y += up * size;
    node = nodes[4 * node]! + right + 2 * up;
  }
  let shows = nodes[4 * node + 2] === 1;
  const here: Place = [x + reference[0] * size, y + reference[1] * size];
  for (let k = 0, at = 4 * nodes[4 * node]!; k < nodes[4 * node + 1]!; ++k, at += 4) {
    if (between([segments[at]!, segments[at + 1]!, segments[at + 2]!, segments[at + 3]!], here, [s, t])) shows = !shows;
  }
  return shows;
}
