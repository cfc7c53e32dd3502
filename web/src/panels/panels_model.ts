import { type EvolveCommand, type LoadCommand, type MaterialCommand, materials, type SurfaceInfo } from '@knead/generated';
import type { Command } from '../engine/session_types';
import type { App } from './app';
import { field, h, title, toggle } from './dom';
import { modelFields, shellFields } from './model_fields';
import { numberInput } from './number_input';
import { note, panel, row } from './panel';
import { energyChart } from './plot';

export function materialPanel(app: App): HTMLElement {
  const chosen = () => app.state?.surfaces[app.state.selection[0] ?? -1];
  return panel(app, 'Material', () => {
    const s = chosen();
    return s ? [s.alpha, s.beta, s.mass, s.damping, s.preset, s.plasticity, s.yield, s.locality, s.lengths, s.rest, s.shell, s.fundamental, app.state!.evolve] : null;
  }, () => {
    const s = chosen();
    if (!s) return [note('Select a surface.')];
    const set = (change: Partial<MaterialCommand>) => app.offer([{ do: 'material', ...change }]);
    const one = (values: (number | null)[]) => (values[0] === values[2] ? values[0]! : null);
    const chosenMaterial = materials.find((m) => m.name === s.preset);
    const shell = shellFields(app, s);
    if (shell) return [...modelFields(app, s), ...shell, restRow(app, s)];
    const counted = s.lengths === 'radii' ? 'in radii of the tool' : 'in units of the file';
    return [
      ...modelFields(app, s),
      row(...materials.map(({ name, help }) => toggle(title(name), name === s.preset, () => void app.execute([
        { do: 'material', preset: name },
        ...(app.state!.evolve.mode === 'static' ? [{ ...app.state!.evolve, mode: 'acm' } as const] : []),
      ]), help))),
      note(chosenMaterial ? `${title(chosenMaterial.name)}: ${chosenMaterial.help}.` : s.alpha.includes(null) || s.beta.includes(null)
        ? 'Varies over the surface: it was painted.' : 'A material of your own.'),
      field('Plasticity', numberInput('Plasticity of the material', s.plasticity, (plasticity) => set({ plasticity })), 'Share of a stroke that stays, 0 to 1'),
      field('Yield', numberInput('Yield', s.yield, (y) => set({ yield: y, lengths: s.lengths })), `Up to this displacement nothing stays, ${counted}`),
      field('Locality', numberInput('Locality', s.locality, (locality) => set({ locality, lengths: s.lengths })), `How far a dent is felt, ${counted}; 0: as far as λ lets it`),
      field('Stretch α', numberInput('Stretch', one(s.alpha), (a) => set({ alpha: [a, 0, a] })), 'Resistance to stretch (Eq. 4.8)'),
      field('Bend β', numberInput('Bend', one(s.beta), (b) => set({ beta: [b, b, b] })), 'Resistance to bending (Eq. 4.8)'),
      field('Mass', numberInput('Mass', s.mass, (mass) => set({ mass })), 'Per area: for swinging, and for gravity'),
      field('Damping', numberInput('Damping', s.damping, (damping) => set({ damping })), 'Force per velocity and area: for swinging'),
      restRow(app, s),
    ];
  });
}

/** What the surface is at rest in. */
function restRow(app: App, s: SurfaceInfo): HTMLElement {
  return row(
    toggle('Keeps its shape', s.rest === 'shape', (on) => void app.execute([{ do: 'rest', mode: on ? 'shape' : 'none' }]),
      'At rest in its own shape; otherwise, as in the thesis, it shrinks without forces'),
    h('button', { class: 'button small', type: 'button', title: 'The present shape becomes the rest shape',
      onclick: () => void app.execute([{ do: 'rest', mode: s.rest }]) }, 'Keep this shape'),
  );
}

const button = (label: string, title: string, onclick: () => void) => h('button', { class: 'button small', type: 'button', title, onclick }, label);

export function evolutionPanel(app: App): HTMLElement {
  const chart = energyChart(app);
  return panel(app, 'Evolution', (a) => [a.state?.evolve, a.state?.load, a.state?.refine], () => {
    const { state } = app;
    if (!state) return [];
    const evolve = (change: Partial<EvolveCommand>) => app.offer([{ ...state.evolve, ...change }]);
    const mode = (name: EvolveCommand['mode']) => void app.execute([{ ...state.evolve, mode: name }]);
    const load = (change: Partial<LoadCommand>) => app.offer([{ ...state.load, ...change }]);
    const { gravity } = state.load;
    return [
      row(
        toggle('Settle', state.evolve.mode === 'acm', () => mode('acm'), 'Settles towards the balance (Eq. 4.22)'),
        toggle('Balance', state.evolve.mode === 'static', () => mode('static'), 'The balance at once'),
        toggle('Swing', state.evolve.mode === 'dynamic', () => mode('dynamic'), 'Mass and damping (Eq. 5.39)'),
      ),
      state.evolve.mode === 'acm' ? field('λ', numberInput('Lambda', state.evolve.lambda, (lambda) => evolve({ lambda })), 'Inverse step size: larger is stiffer clay') : null,
      state.evolve.mode === 'dynamic' ? field('Time step', numberInput('Time step', state.evolve.time_step, (time_step) => evolve({ time_step }))) : null,
      field('Gravity z', numberInput('Gravity z', gravity[2] ?? 0, (z) => load({ gravity: [gravity[0] ?? 0, gravity[1] ?? 0, z] }))),
      field('Pressure', numberInput('Pressure', state.load.pressure, (pressure) => load({ pressure })), 'Along the normal'),
      row(
        button('Play', 'Play or pause (Space)', () => app.togglePlay()),
        button('Step', 'One step (.)', () => void app.execute([{ do: 'step' }])),
        button('Run to rest', 'Steps until nothing moves (R)', () => app.togglePlay(true)),
      ),
      chart,
      row(toggle('Refine automatically', state.refine === 'auto', (on) => void app.execute([{ do: 'refine', permission: on ? 'auto' : 'never' }]),
        'Steps may halve spans under a tool that the net is too coarse for')),
    ];
  }, false);
}

export function historyPanel(app: App): HTMLElement {
  return panel(app, 'History', (a) => (a.playing() || a.hand.active ? null : [a.state?.notes, a.state?.last?.note, a.changes]), () => {
    if (app.playing() || app.hand.active) return [note('…')];
    const list = h('ol', { class: 'history' });
    void app.client.query('journal').then((text) => {
      const commands = JSON.parse(text) as Command[];
      list.replaceChildren(...commands.slice(-40).reverse().map((c) => {
        const { do: name, ...rest } = c;
        const details = Object.entries(rest).map(([k, v]) => `${k} ${typeof v === 'string' ? v : JSON.stringify(v)}`).join(', ');
        return h('li', { title: details }, h('b', {}, name), ` ${details.length > 60 ? `${details.slice(0, 60)}…` : details}`);
      }));
    }, () => {});
    const notes = [...(app.state?.notes ?? []).map((n) => n.text), app.state?.last?.note ?? ''].filter(Boolean);
    return [notes.length > 0 ? note(notes.join('\n')) : null, list];
  }, false);
}
