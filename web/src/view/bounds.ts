import * as THREE from 'three';

import type { Trim } from '../engine/context';
import type { Picture } from '../engine/session_types';

export interface Bounds {
  centre: THREE.Vector3;
  radius: number;
  /** Along z. */
  lowest: number;
  /** What is to be within the view; without it a sheet of that size. */
  box?: THREE.Box3;
}

/** The sphere round boxes; a small one about the origin where there are none. */
export function boundsOf(boxes: (THREE.Box3 | null)[]): Bounds {
  const box = new THREE.Box3();
  for (const other of boxes) if (other) box.union(other);
  if (box.isEmpty()) box.set(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
  const sphere = box.getBoundingSphere(new THREE.Sphere());
  return { centre: sphere.center, radius: Math.max(sphere.radius, 1e-9), lowest: box.min.z, box };
}

/** The box of what the trims leave of a surface, to a line of its picture. */
export function seenBox(picture: Picture | null, trim: Trim): THREE.Box3 | null {
  if (!picture) return null;
  const { positions, s, t } = picture;
  const loops = trim?.faces.flat() ?? [];
  const [rows, columns] = [within(s, loops, 0), within(t, loops, 1)];
  const box = new THREE.Box3();
  for (let k = rows[0]; k <= rows[1]; ++k) {
    for (let l = columns[0]; l <= columns[1]; ++l) box.expandByPoint(new THREE.Vector3().fromArray(positions, 3 * (k * t.length + l)));
  }
  return box;
}

/** First and last line at fractions that loops reach; all lines where there are no loops. `d`: which of s and t. */
function within(lines: Float32Array, loops: number[][], d: 0 | 1): [number, number] {
  let [lower, upper] = loops.length > 0 ? [Infinity, -Infinity] : [0, 1];
  for (const loop of loops) {
    for (let k = d; k < loop.length; k += 2) [lower, upper] = [Math.min(lower, loop[k]!), Math.max(upper, loop[k]!)];
  }
  const last = lines.length - 1;
  const first = lines.findIndex((x) => x >= lower - 1e-6);
  let end = last;
  while (end > 0 && lines[end]! > upper + 1e-6) --end;
  return [Math.max(0, Math.min(first < 0 ? last : first, end)), Math.min(last, Math.max(first, end))];
}
