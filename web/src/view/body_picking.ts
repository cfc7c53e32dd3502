import * as THREE from 'three';

import { type BodyHit, nearestChord } from './near';
import type { Viewer } from './viewer';
import type { Viewport } from './viewport';

/** The curve or volume under the pointer, where no surface is before it. */
export function pickBody(viewer: Viewer, viewport: Viewport, event: { clientX: number; clientY: number }, reach = 9): BodyHit | null {
  const hit = nearestChord(viewer.bodies.bodies, event.clientX, event.clientY, reach, (points) => viewer.places(viewport, points));
  if (!hit) return null;
  const surface = viewer.pick(viewport, event), eye = viewport.ray(event, new THREE.Raycaster()).ray.origin;
  return surface && surface.point.distanceTo(eye) < 0.999 * hit.point.distanceTo(eye) ? null : hit;
}
