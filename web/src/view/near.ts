import * as THREE from 'three';

import type { BodyPicture, Vector3 } from '../engine/session_types';
import { placedBox, type Placing, type Standing } from './placing';

/** A curve or a volume in one of its places. */
export interface DrawnBody {
  body: number;
  picture: BodyPicture;
  standing: Standing;
}

/** All curves and volumes, by their pictures and ids, in all their places. */
export const drawnBodies = (pictures: readonly BodyPicture[], ids: readonly { id: string }[], placing: Placing): DrawnBody[] =>
  pictures.flatMap((picture, body) => placing.of(ids[body]!.id).map((standing) => ({ body, picture, standing })));

/** Round one of them, in the scene. */
export const boxOf = ({ picture, standing }: DrawnBody): THREE.Box3 => placedBox(new THREE.Box3().setFromArray(picture.lines), standing)!;

/** Where the pointer meets the lines of a curve or a volume. */
export interface BodyHit {
  body: number;
  standing: Standing;
  /** In the coordinates of its part. */
  point: THREE.Vector3;
  /** Fractions of the domain; of a curve the first counts. */
  at: Vector3;
}

/**
 * The nearest chord within `reach` pixels of a place on the screen. `project`: where the ends of its lines are on the screen, two
 * numbers each; NaN where they cannot be seen. Chords count by their ends, halfway points by the share along them.
 */
export function nearestChord(bodies: readonly DrawnBody[], x: number, y: number, reach: number, project: (drawn: DrawnBody) => Float32Array): BodyHit | null {
  let best: { drawn: DrawnBody; chord: number; share: number } | null = null, nearest = reach;
  for (const drawn of bodies) {
    const places = project(drawn);
    for (let k = 0; 4 * k + 3 < places.length; ++k) {
      const [ax, ay, bx, by] = [places[4 * k]!, places[4 * k + 1]!, places[4 * k + 2]!, places[4 * k + 3]!];
      const [dx, dy] = [bx - ax, by - ay], length = dx * dx + dy * dy;
      const share = length > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / length)) : 0;
      const distance = Math.hypot(ax + share * dx - x, ay + share * dy - y);
      if (distance < nearest) {
        nearest = distance;
        best = { drawn, chord: k, share };
      }
    }
  }
  if (!best) return null;
  const { drawn: { body, standing, picture: { lines, at } }, chord, share } = best;
  const mixed = (of: Float32Array, d: number) => of[6 * chord + d]! + share * (of[6 * chord + 3 + d]! - of[6 * chord + d]!);
  return { body, standing, point: new THREE.Vector3(mixed(lines, 0), mixed(lines, 1), mixed(lines, 2)), at: [mixed(at, 0), mixed(at, 1), mixed(at, 2)] };
}

/** The number of the place nearest to the pointer, two numbers each, within `reach` pixels. */
export function nearestPoint(places: Float32Array, event: { clientX: number; clientY: number }, reach: number): number | null {
  let best: number | null = null, nearest = reach;
  for (let k = 0; 2 * k < places.length; ++k) {
    const distance = Math.hypot(places[2 * k]! - event.clientX, places[2 * k + 1]! - event.clientY);
    if (distance < nearest) [nearest, best] = [distance, k];
  }
  return best;
}
