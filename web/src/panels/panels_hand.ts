import * as THREE from 'three';

import { format, parseLength, unitInWords } from '../document/units';
import { materials, type PointsCommand } from '@knead/generated';
import { unitOf } from '../engine/session_state';
import type { SizeUnit } from '../tools/brush_size';
import { brushModes, paintModes } from '../tools/modes';
import type { App } from './app';
import { field, h, select, slider, title, toggle } from './dom';
import { numberInput } from './number_input';
import { note, panel, row } from './panel';
import { surfaceBrushFields } from './panel_brushes';
import { shapeTitles } from './panels_scene';

/** What the pointer does: a panel for brushes and paint, one for control points. */

const length = (app: App) => (text: string) => parseLength(text, unitOf(app.state));
const small = (label: string, title: string, onclick: () => void) => h('button', { class: 'button small', type: 'button', title, onclick }, label);

/** A field of several numbers. */
function wide(label: string, control: HTMLElement, tip?: string): HTMLElement {
  const element = field(label, control, tip);
  element.classList.add('wide');
  return element;
}

export function brushPanel(app: App): HTMLElement {
  const key = (a: App) => [a.hand.mode, a.hand.brush.settings, a.hand.size.unit, a.hand.surfaceBrush.settings, a.state?.surfaces.map((s) => s.masked), a.hand.paint.settings, a.hand.placing, unitOf(a.state), a.state?.surfaces.map((s) => s.id)];
  return panel(app, 'Brush', key, () => {
    const { mode } = app.hand;
    const brush = brushModes.includes(mode);
    return [
      radiusField(app),
      brush && mode !== 'grab' ? depthField(app) : null,
      ...(brush ? brushFields(app) : []),
      ...(mode === 'brush' ? surfaceBrushFields(app) : []),
      ...(mode === 'place' ? placeFields(app) : []),
      ...(mode === 'material' ? materialFields(app) : []),
      mode === 'freeze' ? note('Drag over what may not move: whole knot spans, hatched. Alt thaws.') : null,
      mode === 'pin' ? note('Drag over control points to pin them, or click the surface to pin that point. Alt frees.') : null,
    ];
  }, true, (a) => brushModes.includes(a.hand.mode) || a.hand.mode === 'brush' || paintModes.includes(a.hand.mode) || a.hand.mode === 'place');
}

function radiusField(app: App): HTMLElement {
  const { brush: { settings }, size } = app.hand;
  return field('Radius', row(
    slider('Brush radius', Math.log(settings.radius / app.diagonal), [Math.log(0.005), Math.log(0.5)], (v) => {
      settings.radius = Math.exp(v) * app.diagonal;
      app.changed();
    }),
    numberInput('Brush radius in units', Number(size.value.toPrecision(4)), (v) => {
      if (!(v > 0)) return 'A radius is larger than 0';
      size.value = v;
      return app.changed();
    }, size.unit === 'length' ? length(app) : undefined),
    select<SizeUnit>('Unit of the brush radius', [['length', unitInWords(unitOf(app.state))], ['screen', 'px'], ['face', '%']], size.unit, (unit) => {
      size.unit = unit;
      app.changed();
    }),
  ), 'Of the file, pixels of the screen, or a share of the diagonal of the selected faces, which it keeps. Shift-wheel over the surface, or the wheel while pressing; Ctrl-drag to the side; [ and ]');
}

function depthField(app: App): HTMLElement {
  const { settings } = app.hand.brush;
  const smooth = app.hand.mode === 'smooth';
  return field(smooth ? 'Strength' : 'Depth', row(
    slider('Brush depth', settings.strength, [0.02, 1], (v) => {
      settings.strength = v;
      app.changed();
    }),
    h('output', { class: 'number' }, `${Math.round(100 * settings.strength)} %`),
  ), smooth ? 'How much of a bump goes at each place; Alt-wheel' : 'How far the ball goes in, in radii; Alt-wheel, or Ctrl-drag up and down');
}

function brushFields(app: App): (Node | null)[] {
  const { settings } = app.hand.brush;
  return [
    row(toggle('Pen pressure', settings.pressure, (pressure) => {
      settings.pressure = pressure;
      app.changed();
    }, 'A pen that is pressed lightly goes less deep')),
    app.hand.mode === 'push' || app.hand.mode === 'pull' ? note('Alt: reverse. Shift: smooth. Esc: cancel the stroke.') : null,
  ];
}

function placeFields(app: App): (Node | null)[] {
  const { placing } = app.hand;
  const others = app.state?.surfaces.filter((_, k) => !app.state!.selection.includes(k)) ?? [];
  return [
    field('Shape', select('Shape of the new tool', shapeTitles.filter(([s]) => s !== 'surface' || others.length > 0), placing.shape as 'sphere', (shape) => {
      placing.shape = shape;
      placing.surface = shape === 'surface' ? (placing.surface ?? others[0]?.id) : undefined;
      app.changed();
    })),
    placing.shape === 'surface' ? field('Surface', select('Surface that is the tool', others.map((s) => [s.id, s.name || s.id] as const), placing.surface ?? '', (id) => {
      placing.surface = id;
      app.changed();
    })) : null,
    note(placing.shape === 'surface' ? 'Click anywhere: the tool is that surface, where it lies.' : 'Click the surface; the tool is put on the side you look from.'),
  ];
}

function materialFields(app: App): (Node | null)[] {
  const { settings } = app.hand.paint;
  const set = (change: Partial<typeof settings>) => {
    Object.assign(settings, change);
    app.changed();
  };
  return [
    row(...materials.map((m) => toggle(title(m.name), settings.alpha === m.alpha && settings.beta === m.beta, () => set({ alpha: m.alpha, beta: m.beta }), m.help))),
    field('Stretch α', numberInput('Stretch to paint', settings.alpha, (alpha) => set({ alpha: Math.max(0, alpha) }))),
    field('Bend β', numberInput('Bend to paint', settings.beta, (beta) => set({ beta: Math.max(0, beta) }))),
    field('Softness', slider('Softness of the paint', settings.softness, [0, 1], (softness) => set({ softness })), 'Share of the radius over which the paint fades'),
    note('Drag over what is to be of this material. Alt paints clay.'),
  ];
}

/** Control points: which are chosen, their positions, the displacement, their weights. */
export function pointsPanel(app: App): HTMLElement {
  const key = (a: App) => [[...a.hand.points.chosen], a.hand.points.lock, a.hand.points.net, a.hand.points.kind, a.hand.points.lattice, a.hand.points.pulled, a.changes, unitOf(a.state)];
  return panel(app, 'Control points', key, () => {
    const { points } = app.hand;
    const [m, n] = points.net;
    const count = points.chosen.size;
    const all = [...points.chosen];
    const plain = points.kind === 'surface', block = points.lattice !== null;
    const choosing = row(
      small('All', 'Choose all control points', () => points.choose(Array.from({ length: m * n }, (_, k) => k))),
      plain ? small('Row u', 'The rows along u that hold the chosen points', () => points.chooseRows('u')) : null,
      plain ? small('Row v', 'The rows along v that hold the chosen points', () => points.chooseRows('v')) : null,
      small('None', 'Choose none', () => points.choose([])),
      ...latticeFields(app),
    );
    if (block) {
      return [note('Drag the points of the block: the selected surfaces follow. It stays as it was pulled, until something else changes the surfaces.'), choosing];
    }
    if (count === 0) {
      return [note(plain ? 'Click a point; Shift adds, a box takes many, a double click its row. Drag what is chosen; X, Y, Z or N while dragging keep to an axis or the normal.' : 'Click a point; Shift adds, a box takes many. Drag what is chosen; X, Y or Z while dragging keep to an axis.'), choosing];
    }
    const { places } = points;
    const place = places ? all.reduce((sum, k) => sum.add(new THREE.Vector3().fromArray(places, 3 * k)), new THREE.Vector3())
      .divideScalar(count).add(new THREE.Vector3(...app.viewer.origin)) : new THREE.Vector3();
    const run = (command: Partial<PointsCommand>) => void app.execute([{ do: 'points', ...points.which(), ...command }]);
    const along = (axis: number) => (value: number) =>
      app.offer([{ do: 'points', ...points.which(), by: new THREE.Vector3().setComponent(axis, value - place.getComponent(axis)).toArray() }]);
    const by = [0, 0, 0, 0];
    const delta = ['x', 'y', 'z', 'normal'].map((name, k) => numberInput(`Move by ${name}`, 0, (v) => void (by[k] = v), length(app)));
    return [
      plain ? note(count === 1 ? `Point ${Math.floor(all[0]! / n)}, ${all[0]! % n} of ${m} × ${n}` : `${count} of ${m} × ${n} points, their middle at`)
        : note(`${count === 1 ? `Point ${all[0]} of` : `${count} points of`} the ${points.kind}`),
      wide('At', row(...['x', 'y', 'z'].map((name, k) => numberInput(`Position ${name}`, place.getComponent(k), along(k), length(app))))),
      wide('Move', row(...delta.slice(0, 3)), 'Along x, y, z'),
      plain ? field('Normal', row(delta[3]!, small('Move', 'Move the chosen points by these lengths', () => {
        const normal = points.normalAt(place.clone().sub(new THREE.Vector3(...app.viewer.origin)));
        run({ by: new THREE.Vector3().fromArray(by).addScaledVector(normal, by[3]!).toArray() });
      })), 'Along the normal of the surface') : row(small('Move', 'Move the chosen points by these lengths', () => run({ by: [by[0]!, by[1]!, by[2]!] }))),
      ...(plain ? weightFields(app, all) : []),
      row(...(plain ? (['x', 'y', 'z', 'normal'] as const) : (['x', 'y', 'z'] as const)).map((lock) => toggle(lock === 'normal' ? 'Normal' : lock.toUpperCase(), points.lock === lock,
        () => points.setLock(lock), 'The next drag goes along this only'))),
      choosing,
    ];
  }, true, (a) => a.hand.mode === 'points');
}

/** The block round the selected surfaces, and how many points it has along x, y, z. */
function latticeFields(app: App): (Node | null)[] {
  const { points } = app.hand;
  if (points.kind !== 'surface' && points.kind !== 'lattice') return [];
  const { lattice } = points;
  const set = (k: 0 | 1 | 2) => (value: number) => {
    const net = [...lattice!.net] as [number, number, number];
    net[k] = Math.min(12, Math.max(4, Math.round(value)));
    app.showLattice({ ...lattice!, net, anew: false });
  };
  return [
    toggle('Lattice', lattice !== null, (on) => app.showLattice(on ? { net: [4, 4, 4], margin: 0.1 } : null), 'A block of space round the selected surfaces: dragging its points deforms what is in it'),
    lattice && points.pulled ? small('Fit anew', 'Put the block round the surfaces as they are now', () => app.showLattice({ ...lattice, anew: true })) : null,
    lattice ? field('Points', row(...([0, 1, 2] as const).map((k) => numberInput(`Points of the lattice along ${'xyz'[k]}`, lattice.net[k], set(k)))), 'Of the block along x, y, z: 4 to 12') : null,
  ];
}

function weightFields(app: App, chosen: number[]): (Node | null)[] {
  const { points } = app.hand;
  const input = numberInput('Weight', null, (weight) => app.offer([{ do: 'weights', ...points.which(), weight }]), undefined, '1');
  const surface = points.surface!;
  void app.surfaceData(surface).then(({ weights }) => {
    const values = chosen.map((k) => weights[k] ?? 1);
    const same = values.every((w) => w === values[0]);
    input.value = same ? format(values[0]!) : '';
    input.placeholder = same ? '' : 'several';
  }, () => {});
  return [field('Weight', row(input, small('Half', 'Half the weights: the surface leaves these points', () => void app.execute([{ do: 'weights', ...points.which(), by: 0.5 }])),
    small('Double', 'Double the weights: the surface draws near to these points', () => void app.execute([{ do: 'weights', ...points.which(), by: 2 }]))),
    'Larger draws the surface to the point; 1 everywhere is a plain B-spline')];
}
