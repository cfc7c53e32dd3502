import * as THREE from 'three';

import { knotText, readKnots } from '@studio/panels/panel_surface';
import { newCommand, tuples } from '@studio/panels/panel_create';
import { zoneOf } from '@studio/panels/view_cube';
import { orbit, pan, pixelSize, type View, zoom } from '@studio/view/camera';
import { directionOf, namedViews, sideFrom, sideNames, sides } from '@studio/view/directions';
import { conventions, motionOf } from '@studio/view/conventions';
import { roundStep, roundStepAbove } from '@studio/view/ground';
import { blocks, mark, region, wholeRows } from '@studio/view/net';
import { roundLimit } from '@studio/view/limits';

const press = (button: number, more: Partial<Record<'shiftKey' | 'ctrlKey' | 'altKey', boolean>> = {}) =>
  ({ button, shiftKey: false, ctrlKey: false, altKey: false, ...more });

describe('mouse conventions', () => {
  it.each([
    ['knead', press(2), 'orbit'], ['knead', press(1), 'pan'], ['knead', press(2, { shiftKey: true }), 'pan'], ['knead', press(0), 'orbit'],
    ['blender', press(1), 'orbit'], ['blender', press(1, { shiftKey: true }), 'pan'], ['blender', press(1, { ctrlKey: true }), 'zoom'],
    ['blender', press(2), null], ['blender', press(0), null], ['blender', press(0, { altKey: true }), 'orbit'],
    ['rhino', press(2), 'orbit'], ['rhino', press(2, { shiftKey: true }), 'pan'], ['rhino', press(2, { ctrlKey: true }), 'zoom'],
    ['fusion', press(1), 'pan'], ['fusion', press(1, { shiftKey: true }), 'orbit'], ['fusion', press(2), null],
  ] as const)('%s: %o is %s', (convention, event, motion) => expect(motionOf(convention, event, false)).toBe(motion));

  it('never turn a view away from its axis', () => {
    for (const convention of conventions) {
      for (const button of [0, 1, 2]) {
        for (const shiftKey of [false, true]) expect(motionOf(convention, press(button, { shiftKey }), true)).not.toBe('orbit');
      }
    }
  });
});

function perspective(): View {
  const camera = new THREE.PerspectiveCamera(35, 1.5, 0.1, 1000);
  camera.up.set(0, 0, 1);
  camera.position.set(30, -50, 40);
  const target = new THREE.Vector3(1, 2, 3);
  camera.lookAt(target);
  camera.updateMatrixWorld();
  return { camera, target };
}

function axial(): View {
  const camera = new THREE.OrthographicCamera(-15, 15, 10, -10, -100, 100);
  camera.up.set(0, 1, 0);
  camera.position.set(0, 0, 20);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  return { camera, target: new THREE.Vector3() };
}

const seen = (view: View, point: THREE.Vector3) => point.clone().project(view.camera);

describe('motions of the camera', () => {
  const point = new THREE.Vector3(4, -3, 5);

  it('turn about the pivot, which stays where it is on the screen, and keep upright', () => {
    const view = perspective();
    const before = seen(view, point);
    orbit(view, 0.7, -0.3, point);
    expect(seen(view, point).distanceTo(before)).toBeLessThan(1e-6);
    const right = new THREE.Vector3(1, 0, 0).applyQuaternion(view.camera.quaternion);
    expect(Math.abs(right.z)).toBeLessThan(1e-12);
  });

  it('do not tip over the vertical', () => {
    const view = perspective();
    for (let k = 0; k < 20; ++k) orbit(view, 0, -0.4, point);
    expect(view.camera.getWorldDirection(new THREE.Vector3()).z).toBeLessThan(-0.999);
    expect(new THREE.Vector3(0, 1, 0).applyQuaternion(view.camera.quaternion).z).toBeGreaterThan(0);
  });

  it.each([['perspective', perspective], ['along an axis', axial]])('pan so that the point follows the pointer: %s', (_, make) => {
    const view = make();
    const [height, dx, dy] = [600, 37, -21];
    const width = view.camera instanceof THREE.PerspectiveCamera ? 900 : 900;
    const before = seen(view, point);
    pan(view, dx, dy, point, height);
    const after = seen(view, point);
    expect(((after.x - before.x) / 2) * width).toBeCloseTo(dx, 6);
    expect(((before.y - after.y) / 2) * height).toBeCloseTo(dy, 6);
  });

  it.each([['perspective', perspective], ['along an axis', axial]])('zoom to the point under the pointer: %s', (_, make) => {
    const view = make();
    const before = seen(view, point);
    const size = pixelSize(view, point, 600);
    zoom(view, 2, point);
    const after = seen(view, point);
    expect(Math.hypot(after.x - before.x, after.y - before.y)).toBeLessThan(1e-6);
    expect(pixelSize(view, point, 600)).toBeCloseTo(size / 2, 9);
  });
});

describe('the view cube', () => {
  const zones = sideNames.flatMap((face) => [-1, 0, 1].flatMap((row) => [-1, 0, 1].map((column) => zoneOf(face, column, row))));

  it('has 26 zones, each with a name and a direction of its own, alike on every face that meets there', () => {
    const key = (v: THREE.Vector3) => v.toArray().map((x) => Math.round(1e6 * x)).join();
    const byName = new Map<string, Set<string>>();
    for (const { name, direction } of zones) byName.set(name, (byName.get(name) ?? new Set()).add(key(direction)));
    expect(byName.size).toBe(26);
    for (const [name, directions] of byName) expect(directions.size, name).toBe(1);
    expect(new Set([...byName.values()].flatMap((s) => [...s])).size).toBe(26);
    // How often a zone is met says what it is: 6 faces once, 12 edges twice, 8 corners three times.
    const counts = [...byName.keys()].map((name) => zones.filter((z) => z.name === name).length);
    expect([1, 2, 3].map((n) => counts.filter((c) => c === n).length)).toEqual([6, 12, 8]);
    expect(zones.every(({ direction }) => Math.abs(direction.length() - 1) < 1e-12)).toBe(true);
  });

  it('shows each face as it is seen from outside', () => {
    expect(zoneOf('front', 1, 0).name).toBe('Front right');
    expect(zoneOf('back', 1, 1).name).toBe('Top back left');
    expect(zoneOf('top', -1, 1).name).toBe('Top back left');
    expect(zoneOf('bottom', 1, 1).name).toBe('Bottom front right');
  });
});

describe('named views', () => {
  it('look along the axes, and isometric alike at all three', () => {
    expect(namedViews.length).toBe(7);
    for (const side of sideNames) {
      expect(sideFrom(directionOf(side))).toBe(side);
      expect(sides[side].up.dot(sides[side].from)).toBe(0);
    }
    const { x, y, z } = directionOf('isometric');
    expect([x, -y, z]).toEqual([x, x, x]);
    expect(sideFrom(directionOf('isometric'))).toBeNull();
  });

  it('are left again by the mouse from straight above and below', () => {
    for (const side of ['top', 'bottom'] as const) {
      const view = perspective();
      view.camera.up.copy(sides[side].up);
      view.camera.position.copy(view.target).addScaledVector(sides[side].from, 60);
      view.camera.lookAt(view.target);
      view.camera.updateMatrixWorld();
      const right = new THREE.Vector3(1, 0, 0).applyQuaternion(view.camera.quaternion);
      orbit(view, 0, side === 'top' ? 0.5 : -0.5, view.target);
      expect(view.camera.getWorldDirection(new THREE.Vector3()).angleTo(sides[side].from.clone().negate())).toBeCloseTo(0.5, 6);
      expect(new THREE.Vector3(1, 0, 0).applyQuaternion(view.camera.quaternion).distanceTo(right)).toBeLessThan(1e-6);
    }
  });
});

describe('painted spans', () => {
  it('become few rectangles that cover them exactly', () => {
    const cells = [0, 1, 1, 0, /**/ 1, 1, 1, 0, /**/ 0, 0, 0, 1];
    const found = blocks(cells, 3, 4);
    const covered = new Array<number>(12).fill(0);
    for (const { u, v } of found) for (let i = u[0]; i < u[1]; ++i) for (let j = v[0]; j < v[1]; ++j) ++covered[i * 4 + j];
    expect(covered).toEqual(cells);
    expect(found.length).toBe(3);
    expect(blocks(new Array(12).fill(1), 3, 4)).toEqual([{ u: [0, 3], v: [0, 4] }]);
    expect(blocks(new Array(12).fill(0), 3, 4)).toEqual([]);
  });

  it('are the spans again that a region written from them is rounded to', () => {
    const s = [0, 1 / 3, 2 / 3, 1].map(Math.fround);
    const t = [0, 0.1, 0.7, 1].map(Math.fround);
    for (const block of [{ u: [0, 1], v: [1, 2] }, { u: [1, 3], v: [0, 3] }] as const) {
      const cells = new Uint8Array(9);
      mark(cells, region({ u: [...block.u], v: [...block.v] }, s, t, true), s, t);
      const expected = new Uint8Array(9);
      for (let i = block.u[0]; i < block.u[1]; ++i) for (let j = block.v[0]; j < block.v[1]; ++j) expected[i * 3 + j] = 1;
      expect(cells).toEqual(expected);
    }
  });
});

describe('what a command says of control points', () => {
  it('is whole rows where they are whole', () => {
    expect(wholeRows([4, 5, 6, 7], 3, 4)).toEqual({ rows_u: [1] });
    expect(wholeRows([1, 3, 5, 7, 9, 11], 3, 4)).toEqual({ rows_v: [1, 3] });
    expect(wholeRows([0, 5], 3, 4)).toEqual({ which: [0, 5] });
  });
});

describe('knot vectors as text', () => {
  it.each([[[0, 0, 0, 0, 0.5, 1, 1, 1, 1]], [[0, 1, 2, 3]], [[-1, -1, 0.1, 0.1, 7]]])('%j comes back', (knots) => expect(readKnots(knotText(knots))).toEqual(knots));
  it.each(['0 a 1', '0×', '1×2×3'])('%s is none', (text) => expect(readKnots(text)).toBeNull());
});

describe('a surface to create', () => {
  const patch = {
    shape: 'plane' as const, size: [2, 3] as [number, number], radius: 1, height: 1, minor: 1, degree: [3, 2] as [number, number], net: [5, 4] as [number, number],
    position: [0, 0, 1] as [number, number, number], unit: 'mm', knots: ['', ''] as [string, string], weights: '', points: '', profile: '', held: true,
  };
  it('is a command', () => expect(newCommand(patch)).toEqual(
    { do: 'new', name: 'sheet', unit: 'mm', position: [0, 0, 1], shape: 'plane', size: [2, 3], degree: [3, 2], net: [5, 4] }));
  it('names what is wrong', () => {
    expect(newCommand({ ...patch, weights: '1 two' })).toMatch(/weights/);
    expect(newCommand({ ...patch, shape: 'points', points: '0 0 0' })).toMatch(/5 × 4 needs 20/);
    expect(tuples('1 2 3 4', 3)).toBeNull();
  });
});

describe('round numbers', () => {
  it.each([[9.916, 10], [0.0101, 0.012], [1, 1], [0.55, 0.6]])('the limit above %d is %d', (x, limit) => expect(roundLimit(x)).toBeCloseTo(limit, 12));
  it('the steps of the grid are 1, 2 and 5', () => {
    for (const [x, step] of [[0.9, 1], [1, 1], [1.1, 2], [2.1, 5], [5.1, 10], [60, 100]]) {
      expect(roundStepAbove(x!)).toBeCloseTo(step!, 12);
      expect(roundStep(step!)).toBeCloseTo(step!, 12);
    }
  });
});
