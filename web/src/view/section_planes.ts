import type { SectionPlane } from '../engine/session_types';
import { planeOf, still } from './placing';
import type { Viewer } from './viewer';

const most = 60; // section curves with combs

/** Multiples of a step between two ends, at most `most` of them: those nearest to the middle. */
export function stepsBetween(lower: number, upper: number, step: number): number[] {
  const [first, last] = [Math.ceil(lower / step), Math.floor(upper / step)];
  const all = Math.max(0, last - first + 1);
  const skipped = Math.max(0, Math.floor((all - most) / 2));
  return Array.from({ length: Math.min(all, most) }, (_, k) => (first + skipped + k) * step);
}

/** The planes of the section curves, and that of the section view, in the coordinates of the part that is worked on. */
export function sectionPlanes(viewer: Viewer): SectionPlane[] {
  const { display, section, origin } = viewer;
  const planes: SectionPlane[] = [];
  if (display.sections !== 'none') {
    const axis = 'xyz'.indexOf(display.sections);
    const { centre, radius } = viewer.bounds();
    const middle = centre.getComponent(axis) + origin[axis]!;
    for (const offset of stepsBetween(middle - radius, middle + radius, viewer.sectionSpacing)) {
      planes.push([Number(axis === 0), Number(axis === 1), Number(axis === 2), offset]);
    }
  }
  if (section.on) {
    const [x, y, z] = section.normal.toArray();
    planes.push([x, y, z, section.offset + x * origin[0]! + y * origin[1]! + z * origin[2]!]);
  }
  const { workplace } = viewer;
  if (workplace === still) return planes;
  return planes.map(([x, y, z, offset]): SectionPlane => {
    const inScene = offset - x * origin[0]! - y * origin[1]! - z * origin[2]!;
    const [a, b, c, d] = planeOf([x, y, z, -inScene], workplace);
    const length = Math.hypot(a, b, c);
    return [a / length, b / length, c / length, (-d + a * origin[0]! + b * origin[1]! + c * origin[2]!) / length];
  });
}
