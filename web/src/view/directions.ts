import * as THREE from 'three';

/** Where a view along an axis looks from. */
export type Side = 'top' | 'bottom' | 'front' | 'back' | 'right' | 'left';
/** A view with a name; `perspective` is the one that the page begins with. */
export type NamedView = Side | 'isometric' | 'perspective';

/** Per side the direction from the target to the eye, and what is upwards on the screen. */
export const sides: Readonly<Record<Side, { from: THREE.Vector3; up: THREE.Vector3 }>> = {
  top: { from: new THREE.Vector3(0, 0, 1), up: new THREE.Vector3(0, 1, 0) },
  bottom: { from: new THREE.Vector3(0, 0, -1), up: new THREE.Vector3(0, -1, 0) },
  front: { from: new THREE.Vector3(0, -1, 0), up: new THREE.Vector3(0, 0, 1) },
  back: { from: new THREE.Vector3(0, 1, 0), up: new THREE.Vector3(0, 0, 1) },
  right: { from: new THREE.Vector3(1, 0, 0), up: new THREE.Vector3(0, 0, 1) },
  left: { from: new THREE.Vector3(-1, 0, 0), up: new THREE.Vector3(0, 0, 1) },
};
export const sideNames = Object.keys(sides) as Side[];
/** The order in which menus list them. */
export const namedViews: readonly NamedView[] = ['front', 'back', 'left', 'right', 'top', 'bottom', 'isometric'];

export const isSide = (view: NamedView): view is Side => view in sides;

const oblique = new THREE.Vector3(0.55, -0.85, 0.62).normalize();
const isometric = new THREE.Vector3(1, -1, 1).normalize();

/** The direction from the target to the eye, of length 1. */
export function directionOf(view: NamedView): THREE.Vector3 {
  return (view === 'perspective' ? oblique : view === 'isometric' ? isometric : sides[view].from).clone();
}

/** The side that is looked at from exactly this direction, if one is. */
export function sideFrom(direction: THREE.Vector3): Side | null {
  return sideNames.find((side) => sides[side].from.dot(direction) > (1 - 1e-12) * direction.length()) ?? null;
}
