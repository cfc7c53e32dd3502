import * as THREE from 'three';

import { axisOf, pressureOf } from '@studio/tools/pen';

/** Pens, as the browser reports them. */

const pen = (fields: Partial<PointerEvent>) => ({ pointerType: 'pen', pressure: 0.5, tiltX: 0, tiltY: 0, ...fields }) as PointerEvent;
const camera = (from: [number, number, number], up: [number, number, number]) => {
  const made = new THREE.PerspectiveCamera();
  made.position.set(...from);
  made.up.set(...up);
  made.lookAt(0, 0, 0);
  return made;
};
const above = camera([0, 0, 10], [0, 1, 0]);
const upwards = new THREE.Vector3(0, 0, 1);

const close = (a: number[], b: number[]) => a.forEach((x, k) => expect(x).toBeCloseTo(b[k]!, 9));

describe('a pen', () => {
  it('presses as hard as it says, and mice and fingers do not', () => {
    expect(pressureOf(pen({ pressure: 0.4 }))).toBe(0.4);
    expect(pressureOf(pen({ pressure: 0 }))).toBeGreaterThan(0);
    expect(pressureOf(pen({ pointerType: 'mouse' }))).toBeNull();
    expect(pressureOf(pen({ pointerType: 'touch' }))).toBeNull();
  });

  it('that is upright has no axis of its own', () => {
    expect(axisOf(pen({}), above, upwards)).toEqual([0, 0, 0]);
    expect(axisOf(pen({ altitudeAngle: Math.PI / 2, azimuthAngle: 0 }), above, upwards)).toEqual([0, 0, 0]);
  });

  it('leans the normal as it leans over the screen', () => {
    const half = Math.SQRT1_2;
    close(axisOf(pen({ tiltX: 45 }), above, upwards), [half, 0, half]);
    close(axisOf(pen({ tiltY: 45 }), above, upwards), [0, -half, half]); // towards the user, downwards on the screen
    // Seen from the side, in the direction y: the screen's right is x, and the normal is seen along the screen.
    close(axisOf(pen({ tiltX: 45 }), camera([0, -10, 0], [0, 0, 1]), new THREE.Vector3(0, -1, 0)), [half, -half, 0]);
  });

  it('is the same by its two kinds of angles', () => {
    const byTilt = axisOf(pen({ tiltX: 30, tiltY: 20 }), above, upwards);
    const x = Math.tan(Math.PI / 6), y = Math.tan(Math.PI / 9);
    const byAltitude = axisOf(pen({ altitudeAngle: Math.atan2(1, Math.hypot(x, y)), azimuthAngle: Math.atan2(y, x) }), above, upwards);
    close(byTilt, byAltitude);
  });
});
