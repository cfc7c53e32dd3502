import { dataEndings, type DataKind } from '../../document/data_files';
import { coverage, type Histogram, histogram, measuresOf, ramp } from '../../document/deviations';
import { format, parseLength, parseNumber } from '../../document/units';
import type { App } from '../app';
import { placeNames } from '../assembly_tree';
import { field, h, select, slider, title, toggle } from '../dom';
import { morphHelp } from '../help/generated';
import { FollowData } from './follow_data';
import { deviationLegend } from './legend';
import { numberInput } from '../number_input';
import { note, panel, row } from '../panel';

const kinds: [DataKind, string][] = [['scan', 'Scan'], ['vectors', 'Displacements'], ['pair', 'Mesh before and after']];
const units: [string, string][] = [['', 'As the file'], ...['mm', 'cm', 'm', 'inch', 'foot'].map((u): [string, string] => [u, u])];
const none = Infinity; // what the engine takes
const most = 2; // of the scale, either way

const unitAfter = (unit: string): string => (unit === '' || unit === 'unknown' ? '' : ` ${unit}`);

/** Puts the panel into the place of its door, open or closed as that is, and its legend into the scene. */
export function showFollowing(app: App, door: HTMLDetailsElement): FollowData {
  const following = new FollowData(app);
  const element = followPanel(app, following), focused = door.contains(document.activeElement);
  element.open = door.open;
  door.replaceWith(element);
  if (focused) element.querySelector('summary')!.focus();
  document.querySelector('.edge-legend')!.after(deviationLegend(app, following));
  Object.assign(window, { following }); // for tests and the curious
  app.changed();
  return following;
}

/** Data that the faces follow: what they are, how far the model is from them, how it follows. */
function followPanel(app: App, following: FollowData): HTMLDetailsElement {
  const picker = h('input', { type: 'file', accept: dataEndings.join(','), hidden: true, multiple: true, aria: { label: 'Data to follow' } });
  picker.addEventListener('change', () => {
    const files = [...(picker.files ?? [])];
    picker.value = '';
    void app.attempt(async () => {
      for (const file of files) await following.add(file);
    });
  });
  const live = h('p', { class: 'note verdict', role: 'status', data: { state: '' } }), figures = h('div', { class: 'follow-figures' });
  const key = () => [following.files.map(({ name }) => name), following.kind, following.settings, following.deviations !== null, following.failed, following.busy,
    following.morphing, following.waits, following.stale, following.done?.scale, following.done?.left != null, app.viewer.unit, selectedFaces(app)];
  const element = panel(app, 'Follow data', key, () => [
    live,
    row(h('button', { class: 'button small', type: 'button', disabled: following.morphing, onclick: () => picker.click() }, following.waits ? 'Choose the mesh after …' : 'Choose data …'),
      following.stale || following.failed ? h('button', { class: 'button small', type: 'button', disabled: following.busy, onclick: () => void following.measure() }, 'Compare again') : null),
    picker,
    ...(following.files.length > 0 ? dataFields(app, following) : []),
    ...(following.deviations ? [figures, ...followFields(app, following, element)] : []),
  ], false, (a) => (a.state?.surfaces.length ?? 0) > 0 || a.viewer.context.pieces.length > 0) as HTMLDetailsElement;
  const look = () => (following.shown = element.open && !element.hidden);
  let told = '';
  const update = () => {
    look();
    if (!following.shown) return;
    const state = stateOf(following), words = inWords(app, following);
    if (live.textContent !== words) live.textContent = words;
    live.dataset.state = state;
    const now = [following.version, following.done !== null, app.viewer.unit].join();
    if (now === told || !following.deviations) return;
    told = now;
    figures.replaceChildren(...figuresOf(app, following));
  };
  element.addEventListener('toggle', () => {
    look();
    app.changed();
  });
  app.onChange.push(update);
  following.reveal = () => {
    element.open = true;
    requestAnimationFrame(() => element.scrollIntoView({ block: 'start' }));
  };
  return element;
}

const stateOf = ({ failed, busy, morphing, deviations, done }: FollowData): string =>
  (failed ? 'failed' : busy || morphing ? 'busy' : done ? 'followed' : deviations ? 'compared' : '');

function inWords(app: App, following: FollowData): string {
  const { files, deviations, done } = following;
  if (files.length === 0) return 'Drop a scan, displacements, or a mesh before and after on the page, or choose it: the faces follow.';
  if (following.failed) return `The data cannot be compared: ${following.failed}`;
  if (following.waits) return `${files[0]!.name} is the mesh before. Drop or choose the mesh after, with the same points.`;
  if (following.morphing) return 'The faces follow the data …';
  if (!deviations) return 'Comparing the data with the model …';
  const stale = following.stale ? ' Compared before the last change.' : '';
  const after = done ? ` The faces have followed${done.scale === 1 ? '' : ` ${format(done.scale)} times the displacement`}; undo takes it back.` : '';
  return `${files.map(({ name }) => name).join(' and ')}: ${coverage(deviations, unitAfter(app.viewer.unit))}${alignment(app, following)}${after}${stale}`;
}

function alignment(app: App, { deviations }: FollowData): string {
  const found = deviations?.info.alignment;
  if (!found) return '';
  return ` Aligned by ${format(found.angle)}° and ${format(Math.hypot(...found.shift))}${unitAfter(app.viewer.unit)}.`;
}

/** A name, or several with commas; it takes effect when the field is left, or at Enter. */
function named(label: string, value: string, placeholder: string, change: (value: string) => void): HTMLInputElement {
  const input = h('input', { class: 'number', type: 'text', value, placeholder, spellcheck: false, autocomplete: 'off', aria: { label } });
  input.addEventListener('change', () => change(input.value.trim()));
  input.addEventListener('keydown', (e) => e.stopPropagation());
  return input;
}

const said = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);
let more = false; // the further fields are open

/** What the data are, and how the faces follow them. */
function dataFields(app: App, following: FollowData): (Node | null)[] {
  const { settings, kind, files } = following;
  const is = (ending: RegExp) => kind === 'vectors' && ending.test(files[0]!.name);
  const further = h('details', { class: 'more', open: more }, h('summary', {}, 'More'), ...moreFields(app, following).filter((f): f is HTMLElement => f !== null));
  further.addEventListener('toggle', () => (more = further.open));
  return [
    field('Data are', select('What the data are', kinds, kind, (to) => following.be(to)), 'A scan says where faces should lie, displacements where points go'),
    field('Unit', select('Unit of the data', units, settings.unit, (to) => following.set({ unit: to })), said(morphHelp.unit)),
    kind === 'scan' ? row(toggle('Align', settings.align, (align) => following.set({ align }), said(morphHelp.align))) : null,
    is(/\.vt[kup]$/i) ? field('Field', named('Vector field', settings.field, 'the only one', (to) => following.set({ field: to })), said(morphHelp.field)) : null,
    is(/\.csv$/i) ? field('Columns', named('Columns of the table', settings.columns, 'x,y,z,dx,dy,dz', (to) => following.set({ columns: to })), said(morphHelp.columns)) : null,
    ...placeFields(app, following),
    further,
  ];
}

/** Of every part that stands in several places: which of them the data are about. */
function placeFields(app: App, following: FollowData): Node[] {
  const parts = [...(app.viewer.placing.assembly?.parts.entries() ?? [])].filter(([, { places, surfaces }]) => places.length > 1 && surfaces.length > 0);
  if (parts.length === 0) return [];
  const { place } = following.settings;
  return [
    note('Parts that stand in several places: where are their data?'),
    ...parts.map(([k, part]) => field(part.name || 'A part', select(`Place of ${part.name || `part ${k + 1}`}`,
      [['', 'Not said'], ...placeNames(part).map((name): [string, string] => [name, name])], place[k] ?? '',
      (to) => following.set({ place: { ...place, [k]: to } })), said(morphHelp.place))),
  ];
}

function moreFields(app: App, following: FollowData): (HTMLElement | null)[] {
  const { unit } = app.viewer;
  const { settings, kind } = following;
  const length = (text: string) => (text.trim() === '' ? none : parseLength(text, unit));
  const optional = (name: 'reach' | 'noise' | 'tolerance', absent: string) => field(title(name), numberInput(title(name), settings[name], (x) => {
    if (!(x > 0)) return 'A length above 0, or nothing';
    return void following.set({ [name]: x === none ? null : x });
  }, length, absent), said(morphHelp[name]));
  const refine = numberInput('Refine up to, times', settings.refine, (x) => {
    if (x !== none && !(x >= 1 && x <= 1000)) return 'A number from 1 to 1000, or nothing';
    return void following.set({ refine: x === none ? null : x });
  }, (text) => (text.trim() === '' ? none : parseNumber(text)), '8');
  return [
    optional('reach', '1 % of the model'),
    optional('noise', kind === 'scan' ? 'estimated' : 'none'),
    optional('tolerance', kind === 'scan' ? 'the noise' : '1e-5 of the size'),
    field('Refine ×', refine, said(morphHelp.refine)),
    kind === 'scan' ? null : row(toggle('Along normals', settings.normal, (normal) => following.set({ normal }), said(morphHelp.along))),
    facesField(app, following, 'faces', 'Moving', 'All faces'),
    facesField(app, following, 'keep', 'Fixed', 'None'),
  ];
}

/** Faces that alone move, or stay: those that are selected when the button is pressed. */
function facesField(app: App, following: FollowData, name: 'faces' | 'keep', label: string, absent: string): HTMLElement {
  const chosen = following.settings[name], ids = selectedFaces(app);
  const names = chosen.map((id) => app.state?.surfaces.find((s) => s.id === id)?.name || id);
  const take = h('button', { class: 'button small', type: 'button', disabled: ids.length === 0 || ids.join() === chosen.join(), title: said(morphHelp[name]),
    aria: { label: `${label}: those that are selected` }, onclick: () => following.set({ [name]: ids }) }, 'Take selected');
  const clear = h('button', { class: 'button small', type: 'button', aria: { label: `${label}: ${absent.toLowerCase()}` }, onclick: () => following.set({ [name]: [] }) }, 'Clear');
  const words = chosen.length === 0 ? absent : chosen.length > 3 ? `${names.slice(0, 2).join(', ')} and ${chosen.length - 2} more` : names.join(', ');
  return h('div', { class: 'field', title: said(morphHelp[name]) }, h('span', { class: 'field-label' }, label),
    row(h('small', { data: { faces: name } }, words), take, chosen.length > 0 ? clear : null));
}

const selectedFaces = ({ state }: App): string[] => (state?.body === null ? state.selection.map((k) => state.surfaces[k]!.id) : []);

/** Limits, scale, and what is done with them. */
function followFields(app: App, following: FollowData, element: HTMLElement): (Node | null)[] {
  const { done, morphing } = following;
  const scale = slider('Scale of the displacements', following.scale, [-most, most], (x) => take(Math.round(20 * x) / 20));
  const typed = numberInput('Scale, a number', following.scale, (x) => {
    if (Math.abs(x) > 100) return 'A scale from −100 to 100';
    return void take(x);
  });
  const share = slider('Before to after', following.part, [0, 1], (part) => {
    following.show({ part });
    share.setAttribute('aria-valuetext', part === 0 ? 'before' : part === 1 ? 'after' : `${Math.round(100 * part)} % of the way`);
  });
  const button = h('button', { class: 'button small', type: 'button', onclick: () => void following.morph() });
  const label = () => {
    const other = done !== null && following.scale !== done.scale;
    button.textContent = other ? 'Morph again at this scale' : 'Morph';
    button.disabled = morphing || following.busy || following.scale === 0 || following.stale || (done !== null && !other);
  };
  const take = (x: number) => {
    following.show({ scale: x });
    scale.value = String(x);
    scale.setAttribute('aria-valuetext', format(x));
    if (document.activeElement !== typed) typed.value = format(x);
    label();
  };
  label();
  const limit = numberInput('Limits of the colours', following.limit, (x) => {
    if (!(x > 0)) return 'A length above 0, or nothing';
    return void following.show({ limit: x === none ? null : x });
  }, (text) => (text.trim() === '' ? none : parseLength(text, app.viewer.unit)), '95 % of the points');
  const check = () => {
    const edges = element.parentElement!.querySelector<HTMLDetailsElement>('.panel[data-panel=Edges]')!;
    edges.open = true;
    edges.querySelector('summary')!.focus();
    edges.scrollIntoView({ block: 'start' });
  };
  return [
    field('Limits ±', limit, 'Where the colours end'),
    field('Scale', row(scale, typed), '1: where the data lead; −1 compensates; more is over-bending'),
    row(button, done ? h('button', { class: 'button small', type: 'button', title: 'How the faces meet at their edges', onclick: check }, 'Check edges') : null),
    done ? field('Compare', row(h('small', {}, 'before'), share, h('small', {}, 'after')), 'Slides the faces between before and after: the document stays as it is') : null,
  ];
}

/** Figures, the histogram and its limits, as they are at the present scale and share. */
function figuresOf(app: App, following: FollowData): Node[] {
  const { distances, ends, done } = following;
  const unit = unitAfter(app.viewer.unit);
  const { rms, of95, largest } = measuresOf(distances);
  const bars = histogram(distances, ends);
  const total = bars.below + bars.inside + bars.above, percent = (n: number) => `${format((100 * n) / Math.max(1, total))} %`;
  const said = `${bars.inside.toLocaleString('en')} within ±${format(ends)}${unit} (${percent(bars.inside)}), ${bars.below.toLocaleString('en')} below, ${bars.above.toLocaleString('en')} above`;
  const when = done && following.part < 1 ? (following.part === 0 ? 'Before' : 'On the way') : done ? 'After' : 'Distance';
  return [
    note(`${when}: rms ${format(rms)}${unit}, 95 % ${format(of95)}${unit}, largest ${format(largest)}${unit}.`),
    bins(bars, ends, said, unit),
    note(`${said}.`),
  ];
}

const svg = <K extends keyof SVGElementTagNameMap>(tag: K, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElementTagNameMap[K] => {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
};

function bins({ counts, extent }: Histogram, limit: number, said: string, unit: string): HTMLElement {
  const [width, height] = [240, 64], highest = Math.max(1, ...counts), wide = width / counts.length;
  const at = (x: number) => (extent > 0 ? (width * (x + extent)) / (2 * extent) : width / 2);
  const picture = svg('svg', { viewBox: `0 0 ${width} ${height}`, class: 'follow-bins', role: 'img', 'aria-label': `Histogram of the distances: ${said}` },
    ...counts.map((n, k) => svg('rect', { x: k * wide + 0.5, width: wide - 1, y: height * (1 - n / highest), height: (height * n) / highest,
      class: Math.abs((k + 0.5) * wide - width / 2) < (at(limit) - at(-limit)) / 2 ? 'inside' : 'outside' })),
    ...[-limit, 0, limit].map((x) => svg('line', { x1: at(x), x2: at(x), y1: 0, y2: height, class: x === 0 ? 'zero' : 'limit' })));
  const strip = Object.assign(h('i', { class: 'legend-bar' }), { style: `background: ${ramp}` });
  return h('div', { class: 'follow-histogram' }, picture, strip,
    h('div', { class: 'legend-ticks' }, h('span', {}, `−${format(limit)}`), h('span', {}, '0'), h('span', {}, `${format(limit)}${unit}`)));
}

