import { clay } from '../engine/clay';
import { parseLength, parseNumber, unitInWords } from '../document/units';
import type { NewCommand } from '@knead/generated';
import type { Command, Vector3 } from '../engine/session_types';
import type { App } from './app';
import { field, h, select, toggle } from './dom';
import { numberInput } from './number_input';
import { note, panel, row } from './panel';

const shapes = [['plane', 'Sheet'], ['cylinder', 'Cylinder'], ['sphere', 'Sphere'], ['torus', 'Torus'], ['revolution', 'Revolution'], ['points', 'Control points'],
  ['line', 'Curve: line'], ['circle', 'Curve: circle'], ['helix', 'Curve: helix'], ['box', 'Volume: box'], ['solid', 'Volume: cylinder']] as const;
type Shape = (typeof shapes)[number][0];
/** The shapes that are curves or volumes. */
const forms = { line: 'curve', circle: 'curve', helix: 'curve', box: 'volume', solid: 'volume' } as const;
const isForm = (shape: Shape): shape is keyof typeof forms => shape in forms;
const units = ['mm', 'cm', 'm', 'inch', 'foot', 'um', 'dm', 'km', 'yard', 'mile', 'mil', 'microinch'] as const satisfies readonly NewCommand['unit'][];

/** Numbers in a text, separated by spaces, commas or semicolons; null if one is not a number. */
export function numbers(text: string): number[] | null {
  const all = text.split(/[\s,;]+/).filter(Boolean).map((t) => parseNumber(t));
  return all.includes(null) ? null : (all as number[]);
}

/** Lines of `count` numbers each. */
export function tuples<T extends number[]>(text: string, count: T['length']): T[] | null {
  const all = numbers(text);
  if (!all || all.length % count !== 0) return null;
  return Array.from({ length: all.length / count }, (_, k) => all.slice(count * k, count * (k + 1)) as T);
}

interface Patch {
  shape: Shape;
  size: [number, number];
  radius: number;
  height: number;
  minor: number;
  degree: [number, number];
  net: [number, number];
  position: [number, number, number];
  unit: string;
  knots: [string, string];
  weights: string;
  points: string;
  profile: string;
  held: boolean;
}

/** The command for what the panel shows; an error text if there is none. */
export function newCommand(p: Patch): NewCommand | string {
  const command: NewCommand = { do: 'new', name: p.shape === 'points' ? 'patch' : p.shape === 'plane' ? 'sheet' : p.shape, unit: p.unit as NewCommand['unit'] };
  if (p.position.some((x) => x !== 0)) command.position = p.position;
  if (isForm(p.shape)) {
    const kind = forms[p.shape], form = p.shape === 'solid' ? 'cylinder' : p.shape;
    Object.assign(command, { shape: kind, form, name: form });
    if (form === 'line' || form === 'box') command.size = [p.size[0]];
    else command.radius = p.radius;
    if (form === 'helix' || form === 'cylinder') command.height = p.height;
    if (form !== 'circle') command.net = [kind === 'curve' ? 4 * p.net[0] : p.net[0]];
    return command;
  }
  if (p.shape === 'points') {
    const points = tuples<Vector3>(p.points, 3);
    if (!points) return 'the points are not lines of three numbers';
    if (points.length !== p.net[0] * p.net[1]) return `${points.length} points are given, the net of ${p.net.join(' × ')} needs ${p.net[0] * p.net[1]}`;
    command.points = points;
  } else command.shape = p.shape;
  if (p.shape === 'plane') command.size = p.size;
  if (p.shape === 'cylinder' || p.shape === 'sphere' || p.shape === 'torus') command.radius = p.radius;
  if (p.shape === 'cylinder') command.height = p.height;
  if (p.shape === 'torus') command.minor = p.minor;
  if (p.shape === 'revolution') {
    const profile = tuples<[number, number]>(p.profile, 2);
    if (!profile) return 'the profile is not lines of two numbers, r and z';
    command.profile = profile;
    command.degree = p.degree;
  }
  if (p.shape !== 'plane' && p.shape !== 'points') return command;
  command.degree = p.degree;
  command.net = p.net;
  for (const [k, name] of (['knots_u', 'knots_v'] as const).entries()) {
    if (p.knots[k]!.trim() === '') continue;
    const knots = numbers(p.knots[k]!);
    if (!knots) return `the knots ${name.at(-1)} are not a list of numbers`;
    command[name] = knots;
  }
  if (p.weights.trim() !== '') {
    const weights = numbers(p.weights);
    if (!weights) return 'the weights are not a list of numbers';
    command.weights = weights;
  }
  return command;
}

export function createPanel(app: App): HTMLElement {
  const patch: Patch = {
    shape: 'plane', size: [200, 200], radius: 50, height: 150, minor: 15, degree: [3, 3], net: [12, 12], position: [0, 0, 0], unit: 'mm',
    knots: ['', ''], weights: '', points: '', profile: '50 0\n60 40\n30 80\n40 120', held: true,
  };
  let version = 0;
  const again = () => {
    ++version;
    app.changed();
  };
  const make = async (fresh: boolean) => {
    const command = newCommand(patch);
    if (typeof command === 'string') {
      app.notify({ kind: 'error', text: command[0]!.toUpperCase() + command.slice(1), remedy: 'correct it in the panel “Create”' });
      return;
    }
    const all: Command[] = [command, ...(patch.held && patch.shape === 'plane' ? [{ do: 'hold' as const, rows: Math.min(2, Math.floor((Math.min(...patch.net) - 2) / 2)) }] : []),
      ...(isForm(patch.shape) ? [] : clay)];
    if (fresh) await app.documents.openScene(command.name!, all);
    else if (await app.execute(all)) app.viewer.fit();
  };
  const length = (text: string) => parseLength(text, patch.unit);
  const number = (label: string, value: number, set: (v: number) => void, parse = length) => numberInput(label, value, (v) => {
    set(v);
    again();
  }, parse);
  const whole = (label: string, of: [number, number], k: 0 | 1, least: number) =>
    number(label, of[k], (v) => (of[k] = Math.max(least, Math.round(v))), parseNumber as typeof length);
  const list = (label: string, value: string, placeholder: string, set: (text: string) => void, rows = 2) => {
    const area = h('textarea', { class: 'number', rows, value, placeholder, spellcheck: false, aria: { label } });
    area.addEventListener('change', () => set(area.value));
    area.addEventListener('keydown', (e) => e.stopPropagation());
    return area;
  };
  return panel(app, 'Create', (a) => [version, a.state?.fresh], () => {
    const p = patch;
    const flat = p.shape === 'plane' || p.shape === 'points';
    return [
      field('Shape', select('Shape to create', shapes, p.shape, (shape) => {
        p.shape = shape;
        again();
      })),
      p.shape === 'line' || p.shape === 'box' ? field('Length', number('Length to create', p.size[0], (v) => (p.size[0] = v))) : null,
      p.shape === 'plane' ? field('Size', row(number('Width', p.size[0], (v) => (p.size[0] = v)), number('Depth', p.size[1], (v) => (p.size[1] = v)))) : null,
      ['cylinder', 'sphere', 'torus', 'circle', 'helix', 'solid'].includes(p.shape) ? field('Radius', number('Radius to create', p.radius, (v) => (p.radius = v))) : null,
      ['cylinder', 'helix', 'solid'].includes(p.shape) ? field('Height', number('Height to create', p.height, (v) => (p.height = v))) : null,
      p.shape === 'torus' ? field('Tube', number('Tube to create', p.minor, (v) => (p.minor = v))) : null,
      p.shape === 'revolution' ? field('Profile', list('Profile', p.profile, 'r z, a line each', (t) => (p.profile = t), 4), 'Control points (r, z), turned about z') : null,
      flat || p.shape === 'revolution' ? field('Degree', row(flat ? whole('Degree u', p.degree, 0, 1) : null, whole('Degree v', p.degree, 1, 1)), 'In u and v') : null,
      flat ? field('Net', row(whole('Net u', p.net, 0, 2), whole('Net v', p.net, 1, 2)), 'Control points in u and v') : null,
      isForm(p.shape) && p.shape !== 'circle' ? field('Net', whole('Net u', p.net, 0, 4), 'Control points each way; of a curve four times as many') : null,
      p.shape === 'points' ? field('Points', list('Points', p.points, 'x y z, a line each, v running first', (t) => (p.points = t), 5)) : null,
      field('Position', row(...([0, 1, 2] as const).map((k) => number(`Position ${'xyz'[k]} to create`, p.position[k], (v) => (p.position[k] = v))))),
      field('Unit', select('Unit', units.map((u) => [u, unitInWords(u)] as const), p.unit as (typeof units)[number], (unit) => {
        p.unit = unit;
        again();
      })),
      flat ? h('details', { class: 'more' }, h('summary', {}, 'Knots and weights'),
        field('Knots u', list('Knots u to create', p.knots[0], 'clamped, uniform', (t) => (p.knots[0] = t)), 'The whole knot vector; the net follows from it'),
        field('Knots v', list('Knots v to create', p.knots[1], 'clamped, uniform', (t) => (p.knots[1] = t))),
        field('Weights', list('Weights to create', p.weights, '1 everywhere', (t) => (p.weights = t)), 'One for each control point, v running first')) : null,
      p.shape === 'plane' ? row(toggle('Hold its edges', p.held, (held) => {
        p.held = held;
        again();
      })) : null,
      row(
        h('button', { class: 'button small', type: 'button', title: 'In a new document', onclick: () => void make(true) }, 'Create'),
        app.state?.fresh ? h('button', { class: 'button small', type: 'button', title: 'Into this document', onclick: () => void make(false) }, 'Add to this document') : null,
      ),
      app.state && !app.state.fresh ? note('A file that was opened keeps its surfaces: what is created begins a new document.') : null,
    ];
  }, false);
}
