import * as THREE from 'three';

import { type BodyHit, nearestChord } from './near';
import { scenePoint } from './surface_pick';
import type { Viewer } from './viewer';
import type { Viewport } from './viewport';

/** The curve or volume under the pointer, where no surface is before it. */
export function pickBody(viewer: Viewer, viewport: Viewport, event: { clientX: number; clientY: number }, reach = 9): BodyHit | null {
  const hit = nearestChord(viewer.bodies.drawn, event.clientX, event.clientY, reach, ({ picture, standing }) => viewer.places(viewport, picture.lines, standing));
  if (!hit) return null;
  const surface = viewer.pick(viewport, event), eye = viewport.sceneRay(event, new THREE.Raycaster()).ray.origin;
  return surface && scenePoint(surface).distanceTo(eye) < 0.999 * scenePoint(hit).distanceTo(eye) ? null : hit;
}
