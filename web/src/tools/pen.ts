import * as THREE from 'three';

import type { Vector3 } from '../engine/session_types';

/** What a pen reports at the least while it touches: some report nothing before they are pressed. */
const least = 0.05;

/** How hard a pen is pressed, 0 to 1; null of a mouse and of fingers. */
export function pressureOf(event: PointerEvent): number | null {
  return event.pointerType === 'pen' ? Math.min(1, Math.max(least, event.pressure)) : null;
}

/** The direction of a pen over the screen: x to the right, y upwards, z towards the viewer. */
function overScreen(event: PointerEvent): THREE.Vector3 {
  const { altitudeAngle: altitude, azimuthAngle: azimuth } = event;
  if (typeof altitude === 'number' && typeof azimuth === 'number') {
    return new THREE.Vector3(Math.cos(altitude) * Math.cos(azimuth), -Math.cos(altitude) * Math.sin(azimuth), Math.sin(altitude));
  }
  const { degToRad } = THREE.MathUtils;
  return new THREE.Vector3(Math.tan(degToRad(event.tiltX)), -Math.tan(degToRad(event.tiltY)), 1).normalize();
}

/**
 * The axis of a brush that leans from the normal of the surface as the pen does from that of the screen, however the
 * surface is looked at. An upright pen acts along the normal, as a mouse does.
 */
export function axisOf(event: PointerEvent, camera: THREE.Camera, normal: THREE.Vector3): Vector3 {
  const pen = overScreen(event);
  if (Math.hypot(pen.x, pen.y) < 1e-6) return [0, 0, 0];
  const lean = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), pen);
  const { quaternion } = camera;
  return normal.clone().applyQuaternion(quaternion.clone().invert()).applyQuaternion(lean).applyQuaternion(quaternion).toArray();
}
