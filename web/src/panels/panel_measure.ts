import { cannotFollow, digits, inWords, type MeasureKind, measureKinds, pinning, type Reading, readingText, valuesOf } from '../document/readings';
import { unitInWords } from '../document/units';
import type { Command } from '../engine/session_types';
import { still } from '../view/placing';
import type { App } from './app';
import { h, iconButton, toggle } from './dom';
import { note, panel, row } from './panel';

const kinds: Record<MeasureKind, [string, string]> = {
  distance: ['Distance', 'Between two points'],
  angle: ['Angle', 'Of three points, at the second one'],
  normals: ['Normals', 'The angle between the normals at two points'],
  radius: ['Radius', 'The smallest and the largest radius of curvature at a point'],
};

const unitOf = (app: App) => unitInWords(app.viewer.unit || 'mm');
/** Of everything, so that a reading does not depend on what is selected. */
const sizeOf = (app: App) => 2 * app.viewer.bounds().radius;

/** What is measured, as a list; clicks in the mode `measure` add to it. */
export function measurePanel(app: App): HTMLElement {
  const { measure } = app.hand;
  const key = (a: App) => [a.hand.mode === 'measure', measure.kind, measure.picked.length, measure.readings, unitOf(a)];
  return panel(app, 'Measure', key, () => {
    const readings = measure.readings;
    const left = measureKinds[measure.kind] - measure.picked.length;
    const chips = Object.entries(kinds).map(([kind, [label, about]]) =>
      toggle(label, measure.kind === kind, () => measure.choose(kind as MeasureKind), about));
    return [
      row(...chips),
      app.hand.mode === 'measure' ? note(`Click ${left === 1 ? 'a point' : `${left} points`} ${measure.picked.length > 0 ? ': Esc begins again' : ''}.`) : null,
      readings.length === 0 ? null : h('ul', { class: 'readings' }, ...readings.map((r) => item(app, r))),
      readings.length < 2 ? null : row(h('button', { class: 'button small', type: 'button', title: 'All readings as text',
        onclick: () => copy(app, readings.map((r) => readingText(r, unitOf(app), sizeOf(app))).join('\n')) }, 'Copy all')),
    ];
  }, true, (a) => a.hand.mode === 'measure' || measure.readings.length > 0);
}

function item(app: App, reading: Reading): HTMLElement {
  const values = valuesOf(reading, unitOf(app), sizeOf(app));
  const pin = iconButton('pin', reading.pinned ? `${reading.name} follows the surface` : cannotFollow(reading) ?? `Pin ${reading.name}: it follows the surface`, () => void pinDown(app, reading));
  pin.classList.toggle('on', reading.pinned);
  pin.disabled = reading.pinned || cannotFollow(reading) !== null;
  return h('li', { data: { reading: reading.name } },
    h('div', { class: 'reading-head' }, h('b', {}, reading.name), pin,
      iconButton('copy', `Copy ${reading.name} as text`, () => copy(app, readingText(reading, unitOf(app), sizeOf(app)))),
      iconButton('trash', `Remove ${reading.name}`, () => void remove(app, reading))),
    h('dl', {}, ...values.flatMap(({ label, value, text, unit }) =>
      [h('dt', {}, label), h('dd', {}, value === null ? text : `${digits(value)}${unit === '°' ? '°' : ` ${unit}`}`)])));
}

/** From now on the session measures at its points. */
async function pinDown(app: App, reading: Reading): Promise<void> {
  const ids = app.state!.surfaces.map((s) => s.id);
  if ((await app.execute(pinning(reading, ids))) === null) return;
  app.hand.measure.drop(reading);
  app.changed();
}

async function remove(app: App, reading: Reading): Promise<void> {
  if (reading.pinned) await app.execute(reading.names.map((measurement): Command => ({ do: 'remove', measurement })));
  else app.hand.measure.drop(reading);
  app.changed();
}

function copy(app: App, text: string): void {
  void navigator.clipboard.writeText(text).then(
    () => app.notify({ kind: 'info', text: 'Copied.' }),
    () => app.notify({ kind: 'error', text: 'The browser keeps its clipboard to itself.', remedy: 'Mark the numbers in the panel, and copy them.' }));
}

/** The first number of each reading beside its points. */
export function readingLabels(app: App): HTMLElement {
  const { viewer } = app;
  const element = h('div', { class: 'reading-labels', aria: { hidden: 'true' } }); // the panel says the same
  let shown: { place: number[]; label: HTMLElement }[] = [];
  let drawn = '';
  app.onChange.push(() => {
    const readings = app.hand.measure.readings;
    app.hand.measure.refresh();
    const now = JSON.stringify([readings, viewer.origin, unitOf(app)]);
    if (now === drawn) return;
    drawn = now;
    shown = readings.map((r) => {
      const middle = r.kind === 'angle' ? r.points[1]!.point : [0, 1, 2].map((d) => r.points.reduce((sum, p) => sum + p.point[d]!, 0) / r.points.length);
      const first = valuesOf(r, unitOf(app), sizeOf(app))[0]!;
      return { place: middle.map((x, d) => x - viewer.origin[d]!), label: h('span', { class: 'reading-label' }, inWords(first, 6).replace('smallest radius', 'R')) };
    });
    element.replaceChildren(...shown.map(({ label }) => label));
    viewer.redraw();
  });
  viewer.onDrawn.push(() => {
    const stage = viewer.element.getBoundingClientRect();
    for (const { place, label } of shown) {
      const [x, y] = viewer.places(viewer.main, place, still);
      label.hidden = Number.isNaN(x);
      label.style.left = `${Math.round(x! - stage.left)}px`;
      label.style.top = `${Math.round(y! - stage.top)}px`;
    }
  });
  return element;
}
