import type { App } from '../app';
import type { Command, Field } from '../engine/session_types';
import type { Display } from '../view/display';
import { field, format, h, numberInput, select, slider, toggle } from './dom';
import { note, panel, row } from './panel';
import { parseLength } from './units';

interface Preset {
  name: string;
  about: string;
  alpha: number;
  beta: number;
  lambda: number;
}

export const presets: Preset[] = [
  { name: 'Clay', about: 'gives way where it is pressed and nowhere else', alpha: 0.1, beta: 0.001, lambda: 100 },
  { name: 'Rubber', about: 'stretches far and wants back', alpha: 1, beta: 0.01, lambda: 5 },
  { name: 'Sheet metal', about: 'resists bending: wide, fair dents', alpha: 0.05, beta: 0.05, lambda: 20 },
  { name: 'Cloth', about: 'hardly resists bending', alpha: 1, beta: 0.0002, lambda: 5 },
  { name: 'Membrane', about: 'stretch alone: a soap film', alpha: 1, beta: 0, lambda: 1 },
];

export function materialPanel(app: App): HTMLElement {
  const chosen = () => app.state?.surfaces[app.state.selection[0] ?? -1];
  return panel(app, 'Material', () => {
    const s = chosen();
    return s ? [s.alpha, s.beta, s.mass, s.damping, s.rest, app.state!.evolve] : null;
  }, () => {
    const s = chosen();
    if (!s) return [note('Select a surface.')];
    const set = (change: Record<string, unknown>) =>
      void app.execute([{ do: 'material', alpha: s.alpha.map((x) => x ?? 1), beta: s.beta.map((x) => x ?? 0.01), ...change }]);
    const one = (values: (number | null)[]) => (values[0] === values[2] ? values[0]! : null);
    const fits = (p: Preset) => one(s.alpha) === p.alpha && one(s.beta) === p.beta;
    return [
      row(...presets.map((p) => toggle(p.name, fits(p), () => void app.execute([
        { do: 'material', alpha: [p.alpha, 0, p.alpha], beta: [p.beta, p.beta, p.beta] },
        { ...app.state!.evolve, do: 'evolve', lambda: p.lambda, ...(app.state!.evolve.mode === 'static' ? { mode: 'acm' } : {}) } as Command,
      ]), p.about))),
      field('Stretch α', numberInput('Stretch', one(s.alpha), (a) => set({ alpha: [a, 0, a] })), 'Resistance to stretch (Eq. 4.8)'),
      field('Bend β', numberInput('Bend', one(s.beta), (b) => set({ beta: [b, b, b] })), 'Resistance to bending (Eq. 4.8)'),
      app.state!.evolve.mode === 'dynamic' ? field('Mass', numberInput('Mass', s.mass, (mass) => set({ mass }))) : null,
      app.state!.evolve.mode === 'dynamic' ? field('Damping', numberInput('Damping', s.damping, (damping) => set({ damping }))) : null,
      row(
        toggle('Keeps its shape', s.rest === 'shape', (on) => void app.execute([{ do: 'rest', mode: on ? 'shape' : 'none' }]),
          'At rest in its own shape; otherwise, as in the thesis, it shrinks without forces'),
        h('button', { class: 'button small', type: 'button', title: 'The present shape becomes the rest shape',
          onclick: () => void app.execute([{ do: 'rest', mode: s.rest }]) }, 'Set as rest'),
      ),
    ];
  });
}

export function evolutionPanel(app: App): HTMLElement {
  return panel(app, 'Evolution', (a) => [a.state?.evolve, a.state?.load, a.state?.refine], () => {
    const { state } = app;
    if (!state) return [];
    const evolve = (change: Record<string, unknown>) => void app.execute([{ ...state.evolve, ...change } as Command]);
    const load = (change: Record<string, unknown>) => void app.execute([{ ...state.load, ...change } as Command]);
    const gravity = state.load.gravity as number[];
    return [
      row(
        toggle('Sink', state.evolve.mode === 'acm', () => evolve({ mode: 'acm' }), 'Sinks towards the balance (Eq. 4.22)'),
        toggle('Balance', state.evolve.mode === 'static', () => evolve({ mode: 'static' }), 'The balance at once'),
        toggle('Swing', state.evolve.mode === 'dynamic', () => evolve({ mode: 'dynamic' }), 'Mass and damping (Eq. 5.39)'),
      ),
      state.evolve.mode === 'acm' ? field('λ', numberInput('Lambda', state.evolve.lambda, (lambda) => evolve({ lambda })), 'Inverse step size: larger is stiffer clay') : null,
      state.evolve.mode === 'dynamic' ? field('Time step', numberInput('Time step', state.evolve.time_step, (time_step) => evolve({ time_step }))) : null,
      field('Gravity z', numberInput('Gravity z', gravity[2] ?? 0, (z) => load({ gravity: [gravity[0] ?? 0, gravity[1] ?? 0, z] }))),
      field('Pressure', numberInput('Pressure', state.load.pressure as number, (pressure) => load({ pressure })), 'Along the normal'),
      row(toggle('Refine as needed', state.refine === 'auto', (on) => void app.execute([{ do: 'refine', permission: on ? 'auto' : 'never' }]),
        'Steps may halve spans under a tool that the net is too coarse for')),
    ];
  }, false);
}

const fieldNames: readonly (readonly [Field, string])[] = [
  ['none', 'Plain'], ['deviation', 'Deviation'], ['mean', 'Mean curvature'], ['gaussian', 'Gaussian curvature'], ['gap', 'Distance to tools'],
];

export function displayPanel(app: App): HTMLElement {
  return panel(app, 'Display', (a) => [{ ...a.display, limit: a.display.field === 'none' ? 0 : format(a.display.limit) }], () => {
    const d = app.display;
    const chip = (name: keyof Display, label: string, tip?: string) =>
      toggle(label, d[name] as boolean, (on) => app.setDisplay({ [name]: on }), tip);
    return [
      row(chip('isocurves', 'Isocurves'), chip('knotLines', 'Knot lines'), chip('points', 'Points', 'Control points; held ones in orange'),
        chip('net', 'Net', 'Control net'), chip('normals', 'Normals'), chip('zebra', 'Zebra', 'Reflection stripes: kinks show curvature that jumps'),
        chip('grid', 'Grid'), chip('surface', 'Surface')),
      field('Colour', select('Colour by', fieldNames, d.field, (f) => app.setDisplay({ field: f, zebra: false }))),
      d.field !== 'none' ? field('± limit', row(
        numberInput('Limit of the colours', d.limit, (limit) => app.setDisplay({ limit: Math.abs(limit) || d.limit, autoLimit: false }),
          (t) => parseLength(t, app.state?.surfaces[0]?.unit ?? 'mm')),
        toggle('Auto', d.autoLimit, (autoLimit) => app.setDisplay({ autoLimit })))) : null,
      d.points ? field('Point size', slider('Point size', d.pointSize, [2, 14], (pointSize) => app.setDisplay({ pointSize }))) : null,
      field('Detail', select('Detail', [['48', 'Coarse'], ['96', 'Normal'], ['192', 'Fine']], String(d.detail) as '96',
        (v) => app.setDisplay({ detail: Number(v) })), 'Lines of the picture per direction; the surface itself is exact'),
    ];
  });
}

export function historyPanel(app: App): HTMLElement {
  return panel(app, 'History', (a) => (a.playing() || a.hand.active ? null : [a.state?.notes, a.state?.last?.note, a.changes]), () => {
    if (app.playing() || app.hand.active) return [note('…')];
    const list = h('ol', { class: 'history' });
    void app.client.journal().then((text) => {
      const { commands } = JSON.parse(text) as { commands: Command[] };
      list.replaceChildren(...commands.slice(-40).reverse().map((c) => {
        const { do: name, ...rest } = c;
        const details = Object.entries(rest).map(([k, v]) => `${k} ${typeof v === 'string' ? v : JSON.stringify(v)}`).join(', ');
        return h('li', { title: details }, h('b', {}, name), ` ${details.length > 60 ? `${details.slice(0, 60)}…` : details}`);
      }));
    }, () => {});
    const notes = [...(app.state?.notes ?? []), app.state?.last?.note ?? ''].filter(Boolean);
    return [notes.length > 0 ? note(notes.join('\n')) : null, list];
  }, false);
}
