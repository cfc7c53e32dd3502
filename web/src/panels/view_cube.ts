import * as THREE from 'three';

import { orbit } from '../view/camera';
import { sideNames, sides, type Side } from '../view/directions';
import type { App } from './app';
import { h, iconButton, title } from './dom';
import { toggleSection } from './section';
import { look, toggleParallel, toggleTurntable } from './views';

/** One of the 26 directions of the cube: a face, an edge or a corner, by the sides that meet there. */
export interface Zone {
  direction: THREE.Vector3;
  name: string;
}

/** What lies at (column, row), each −1, 0 or 1, of a face: right and up as it is seen from outside. */
export function zoneOf(face: Side, column: number, row: number): Zone {
  const { from, up } = sides[face];
  const right = up.clone().cross(from);
  const direction = from.clone().addScaledVector(right, column).addScaledVector(up, row);
  const met = sideNames.filter((side) => sides[side].from.dot(direction) > 0.5);
  return { direction: direction.normalize(), name: title(met.join(' ')) };
}

const matrix = (m: THREE.Matrix4) => `matrix3d(${m.elements.map((x) => Number(x.toFixed(6))).join()})`;

/** From the scene's axes to those of a page, whose y points down. */
function turned(camera: THREE.Camera): string {
  const m = new THREE.Matrix4().makeRotationFromQuaternion(camera.quaternion.clone().invert());
  for (const k of [1, 5, 9]) m.elements[k]! *= -1;
  return matrix(m);
}

function face(app: App, side: Side, half: number): HTMLElement {
  const { from, up } = sides[side];
  const place = new THREE.Matrix4().makeBasis(up.clone().cross(from), up.clone().negate(), from).setPosition(from.clone().multiplyScalar(half));
  const zones = [1, 0, -1].flatMap((row) => [-1, 0, 1].map((column) => {
    const { direction, name } = zoneOf(side, column, row);
    const middle = row === 0 && column === 0;
    // The tabulator stops at the six faces; edges and corners are met by two and three of them.
    return h('button', { type: 'button', class: middle ? 'cube-zone middle' : 'cube-zone', title: `Look from ${name.toLowerCase()}`, tabIndex: middle ? 0 : -1,
      aria: { label: `View from ${name.toLowerCase()}` }, onclick: () => look(app, direction) }, middle ? title(side) : null);
  }));
  const element = h('div', { class: 'cube-face', data: { side } }, ...zones);
  element.style.transform = matrix(place);
  return element;
}

/** The cube in the corner of the view: it turns with the camera, and a click on it turns the camera. */
export function viewCube(app: App): HTMLElement {
  const { viewer } = app;
  const half = 27; // pixels, as in view_cube.css
  const solid = h('div', { class: 'cube-solid' }, ...sideNames.map((side) => face(app, side, half)));
  const space = h('div', { class: 'cube-space' }, solid);
  const projection = iconButton('parallel', 'Parallel projection or perspective (7)', () => toggleParallel(app));
  const turntable = iconButton('turntable', 'Turntable: turns slowly until a view is touched (8)', () => toggleTurntable(app));
  const section = iconButton('section', 'Section: hides what is before a plane (X)', () => toggleSection(app));
  const element = h('nav', { class: 'view-cube', aria: { label: 'View cube' } }, space, h('div', { class: 'cube-bar' }, projection, turntable, section));
  dragged(app, space);
  viewer.onDrawn.push(() => {
    const { camera } = viewer.main;
    solid.style.transform = turned(camera);
    space.classList.toggle('parallel', viewer.main.parallel);
  });
  app.onChange.push(() => {
    for (const [button, on] of [[projection, viewer.main.parallel], [turntable, viewer.turntable.on], [section, viewer.section.on]] as const) {
      button.classList.toggle('on', on);
      button.setAttribute('aria-pressed', String(on));
    }
  });
  return element;
}

/** A drag on the cube orbits. */
function dragged(app: App, space: HTMLElement): void {
  let last: { x: number; y: number } | null = null;
  let moved = false;
  space.addEventListener('pointerdown', (e) => {
    app.viewer.turntable.on = false;
    last = { x: e.clientX, y: e.clientY };
    moved = false;
  });
  space.addEventListener('pointermove', (e) => {
    const view = app.viewer.main;
    if (!last || view.axial || (!moved && Math.hypot(e.clientX - last.x, e.clientY - last.y) < 4)) return;
    if (!moved) space.setPointerCapture(e.pointerId);
    moved = true;
    orbit(view, -0.02 * (e.clientX - last.x), -0.02 * (e.clientY - last.y), view.target);
    last = { x: e.clientX, y: e.clientY };
    view.moved();
  });
  const end = () => (last = null);
  space.addEventListener('pointerup', end);
  space.addEventListener('pointercancel', end);
  space.addEventListener('click', (e) => {
    if (moved) e.stopPropagation(); // the end of a drag
    moved = false;
  }, { capture: true });
}
