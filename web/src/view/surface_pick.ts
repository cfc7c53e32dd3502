import * as THREE from 'three';

import type { Trim } from '../engine/context';
import { shown } from '../engine/trim_tree';
import type { GridPicker } from './picking';
import { type Standing, still } from './placing';

/** A point of a surface, in the coordinates of its part, relative to the session's origin. */
export interface Hit {
  surface: number;
  point: THREE.Vector3;
  normal: THREE.Vector3; // towards the viewer
  fractions: [number, number];
  /** Where the surface that was hit stands. */
  standing: Standing;
}

/** Where it is in the scene. */
export const scenePoint = ({ point, standing }: Pick<Hit, 'point' | 'standing'>): THREE.Vector3 => point.clone().applyMatrix4(standing.matrix);

/** A drawn surface: what rays meet, what its trims leave of it, and where it stands. */
export interface Pickable {
  picker: GridPicker | null;
  trim: Trim;
  standings: readonly Standing[];
}

/** The nearest surface on a ray of the scene, up to a distance, with that distance. */
export function nearestOn(ray: THREE.Ray, far: number, surfaces: Iterable<Pickable>): (Hit & { distance: number }) | null {
  let best: (Hit & { distance: number }) | null = null;
  const own = new THREE.Ray();
  const at = new THREE.Vector3();
  let surface = 0;
  for (const { picker, trim, standings } of surfaces) {
    for (const standing of picker ? standings : []) {
      const local = standing === still ? ray : own.copy(ray).applyMatrix4(standing.inverse);
      const hit = picker!.hit(local, trim ? (s, t) => shown(trim, s, t) : undefined);
      if (!hit) continue;
      const distance = standing === still ? hit.distance : at.copy(hit.point).applyMatrix4(standing.matrix).distanceTo(ray.origin);
      if (distance <= far && (!best || distance < best.distance)) best = { surface, ...hit, distance, standing };
    }
    ++surface;
  }
  return best;
}
