import { parseLength } from '../document/units';
import type { MaskCommand } from '@knead/generated';
import { unitOf } from '../engine/session_state';
import { heightsOf } from '../tools/stamp_image';
import { brushKinds } from '../tools/surface_brush';
import type { App } from './app';
import { field, h, select, slider, title, toggle } from './dom';
import { numberInput } from './number_input';
import { note, row } from './panel';
import { shapeTitles } from './panels_scene';

/** The panel of the mode `brush`: the picker of kinds, how strong it is, where it is repeated, and the mask. */
export function surfaceBrushFields(app: App): (Node | null)[] {
  const { settings } = app.hand.surfaceBrush;
  const set = (change: Partial<typeof settings>) => {
    Object.assign(settings, change);
    app.changed();
  };
  const about = brushKinds.find(([kind]) => kind === settings.kind)![1];
  const masking = settings.kind === 'mask' || settings.kind === 'unmask';
  const moving = settings.kind === 'grab' || settings.kind === 'twist' || settings.kind === 'scale', stamping = settings.kind === 'stamp';
  return [
    row(...brushKinds.map(([kind, help]) => toggle(title(kind), settings.kind === kind, () => {
      set({ kind });
      if (kind === 'mask' || kind === 'unmask') showMask(app);
    }, help))),
    ...(settings.kind === 'stamp' ? stampFields(app) : []),
    masking || moving ? null : field('Strength', row(
      slider('Brush strength', settings.strength, [0.02, 1], (strength) => set({ strength })),
      h('output', { class: 'number' }, `${Math.round(100 * settings.strength)} %`),
    ), 'How high it goes, 100 % half its radius; of flatten, smooth and pinch how far. Alt-wheel'),
    moving || stamping ? null : field('Stabiliser', slider('Stabiliser', settings.steady, [0, 2], (steady) => set({ steady: steady < 0.05 ? 0 : steady })),
      'The brush is drawn behind the pointer by a rope of so many radii'),
    ...penFields(app, moving || stamping),
    ...repeatFields(app),
    ...maskFields(app),
    note(`${about}. ${settings.kind === 'smooth' ? '' : 'Shift: smooth. '}Esc: cancel the stroke.`),
  ];
}

/** What a pen does; brushes about a place have no pressure. */
function penFields(app: App, aboutPlace: boolean): Node[] {
  const { settings } = app.hand.surfaceBrush;
  const set = (change: Partial<typeof settings>) => {
    Object.assign(settings, change);
    app.changed();
  };
  return [field('Pen', row(
    aboutPlace ? null : select('Pressure of the pen', [['depth', 'Pressure: depth'], ['size', 'Pressure: size'], ['both', 'Pressure: both'], ['none', 'Pressure: off']] as const,
      settings.presses, (presses) => set({ presses })),
    toggle('Tilt', settings.tilt, (tilt) => set({ tilt }), 'A pen that leans leans what the brush does, up to 60° from the normal'),
  ), 'What the pressure and the tilt of a pen do; a mouse is a pen that is upright and pressed fully')];
}

/** What a stamp presses. */
function stampFields(app: App): Node[] {
  const { settings } = app.hand.surfaceBrush;
  const { stamp } = settings;
  const set = (change: typeof stamp) => {
    settings.stamp = change;
    app.changed();
  };
  const picker = h('input', { type: 'file', accept: 'image/png,image/jpeg,image/webp', hidden: true, aria: { label: 'Image of the stamp' } });
  picker.addEventListener('change', () => {
    const file = picker.files?.[0];
    if (file) void app.attempt(async () => set({ image: file.name, pattern: await heightsOf(file) }));
  });
  const shapes = shapeTitles.filter(([name]) => name !== 'surface' && name !== 'plane').map(([name, text]) => [name, text] as const);
  const image = 'image' in stamp ? [['image', stamp.image] as const] : [];
  return [field('Stamp', row(
    select('Stamp', [...shapes, ...image], 'shape' in stamp ? stamp.shape : 'image', (name) => {
      if (name !== 'image') set({ shape: name });
    }),
    h('button', { class: 'button small', type: 'button', title: 'The lightness of an image as heights', onclick: () => picker.click() }, 'Image…'), picker,
  ), 'The shape of a tool as it is seen from above, or an image: white is highest')];
}

/** The colours show the mask where they show nothing else. */
function showMask(app: App): void {
  if (!app.display.colour) app.setDisplay({ colour: app.client.displays.find((d) => d.name === 'mask') ?? null, stripes: 'none', autoLimits: true });
}

function repeatFields(app: App): (Node | null)[] {
  const { surfaceBrush } = app.hand;
  const { settings } = surfaceBrush;
  const unit = unitOf(app.state);
  const set = (change: Partial<typeof settings>) => {
    Object.assign(settings, change);
    app.changed();
  };
  return [
    field('Mirror', row(
      select('Mirror across', [['off', 'Off'], ['x', 'across x'], ['y', 'across y'], ['z', 'across z']] as const, settings.mirror?.axis ?? 'off',
        (axis) => set({ mirror: axis === 'off' ? null : { axis, at: surfaceBrush.middle()['xyz'.indexOf(axis)]! } })),
      settings.mirror ? numberInput('Place of the mirror', settings.mirror.at, (at) => set({ mirror: { axis: settings.mirror!.axis, at } }),
        (text) => parseLength(text, unit)) : null,
    ), 'Every stroke is repeated on the other side of a plane'),
    field('Radial copies', numberInput('Radial copies', settings.radial, (radial) => set({ radial: Math.min(64, Math.max(1, Math.round(radial))) })),
      'Strokes around the axis z through the middle of what is selected'),
  ];
}

function maskFields(app: App): (Node | null)[] {
  const { settings } = app.hand.surfaceBrush;
  const masked = app.state?.surfaces.some((s, k) => s.masked && app.state!.selection.includes(k)) ?? false;
  if (!masked && settings.kind !== 'mask' && settings.kind !== 'unmask') return [];
  const act = (change: MaskCommand['change'], tip: string) => h('button', {
    class: 'button small', type: 'button', title: tip,
    onclick: () => void app.execute([{ do: 'mask', change, ...(change === 'clear' || change === 'invert' ? {} : { radius: app.hand.brush.settings.radius / 4 }) }]),
  }, title(change));
  return [field('Mask', row(act('invert', 'What is masked is free, and the other way around'), act('blur', 'A softer border'), act('grow', 'A quarter of the radius more'),
    act('shrink', 'A quarter of the radius less'), act('clear', 'Nothing is masked')), 'What brushes and strokes leave alone')];
}
