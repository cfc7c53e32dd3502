import { format, unitInWords } from '../document/units';
import { type DisplayInfo, unitIn } from '../engine/displays';
import { toleranceOf } from '../view/display';
import { limitsOf, nothingToShow } from '../view/limits';
import { justOutside } from '../view/surface_shader';
import type { App } from './app';
import { h } from './dom';

const signed = (x: number): string => (x === 0 ? '0' : `${x < 0 ? '−' : ''}${format(Math.abs(x))}`);

/** The limits follow from the values again. */
export function autoLimitsAgain(app: App): void {
  const { colour } = app.display;
  if (colour) app.setDisplay({ autoLimits: true, limits: limitsOf(colour, app.frame?.range ?? null) });
}

/** What the colours of the surface mean: a card in the corner of the scene. */
export function legendCard(app: App): HTMLElement {
  const title = h('b', {});
  const bar = h('i', { class: 'legend-bar' });
  const handles = [endHandle(app, bar, 0), endHandle(app, bar, 1)] as const;
  const nothing = h('p', { class: 'note', hidden: true });
  const track = h('div', { class: 'legend-track', title: 'Drag the ends; a double click lets them follow from the values' }, bar, ...handles);
  track.addEventListener('dblclick', () => autoLimitsAgain(app));
  const ticks = h('div', { class: 'legend-ticks' });
  const beyond = [h('span', {}), h('span', {})] as const;
  const auto = h('button', { class: 'button small', type: 'button', title: 'Ends that follow from the values', onclick: () => autoLimitsAgain(app) }, 'Auto');
  const compare = h('button', { class: 'button small', type: 'button', title: 'Hold to see the shape as it was opened (C)' }, 'Hold: as opened');
  compare.addEventListener('pointerdown', () => app.compare(true));
  for (const end of ['pointerup', 'pointerleave', 'pointercancel', 'blur'] as const) compare.addEventListener(end, () => app.compare(false));
  compare.addEventListener('keydown', (e) => {
    if (e.key === 'Enter' || e.key === ' ') app.compare(true);
  });
  compare.addEventListener('keyup', () => app.compare(false));
  const element = h('section', { class: 'legend-card', hidden: true, aria: { label: 'Meaning of the colours' } },
    title, nothing, track, ticks, h('div', { class: 'legend-beyond' }, ...beyond), auto, compare);
  app.onChange.push(() => {
    const { colour, limits: [lower, upper], stripes, autoLimits } = app.display;
    element.hidden = colour === null || stripes !== 'none';
    if (!colour || stripes !== 'none') return;
    title.textContent = `${colour.title}, ${unitIn(colour.unit, unitInWords(app.viewer.unit))}`;
    bar.style.background = gradient(colour, toleranceOf(app.display), [lower, upper]);
    const why = app.frame && !app.frame.late ? nothingToShow(colour, app.frame.range, app.frame.state) : null;
    nothing.textContent = why ?? '';
    nothing.hidden = why === null;
    track.hidden = ticks.hidden = why !== null;
    const shares = [0, 0.25, 0.5, 0.75, 1];
    const at = (x: number) => (colour.palette === 'rising' ? lower + x * (upper - lower) : x < 0.5 ? (1 - 2 * x) * lower : (2 * x - 1) * upper);
    ticks.replaceChildren(...shares.map((x) => h('span', {}, signed(at(x)))));
    handles.forEach((handle, end) => {
      const value = end === 0 ? lower : upper;
      handle.setAttribute('aria-valuenow', String(value));
      handle.setAttribute('aria-valuetext', `${signed(value)} ${unitIn(colour.unit, unitInWords(app.viewer.unit))}`);
    });
    const range = app.frame?.range;
    const slack = 1e-6 * (upper - lower);
    beyond[0].textContent = range && range.least < lower - slack ? `◂ down to ${signed(range.least)}` : '';
    beyond[1].textContent = range && range.greatest > upper + slack ? `up to ${signed(range.greatest)} ▸` : '';
    auto.hidden = autoLimits;
    compare.hidden = !colour.compares;
  });
  return element;
}

/** The bar: the colours of the surface (view/surface_shader.ts). */
function gradient(colour: DisplayInfo, tolerance: number, [lower, upper]: [number, number]): string {
  if (colour.palette === 'rising') return 'linear-gradient(90deg, #f2f0db, #ed9940 50%, #8c1a40)';
  const [blue, grey, red] = ['#2b61bd', '#dedede', '#c73b30'];
  if (tolerance === 0) return `linear-gradient(90deg, ${blue}, ${grey} 50%, ${red})`;
  const place = (x: number) => `${(50 + 50 * Math.max(-1, Math.min(1, x))).toFixed(2)}%`;
  const [from, to] = [place(tolerance / lower), place(tolerance / upper)];
  const near = (end: string) => `color-mix(in srgb, ${end} ${100 * justOutside}%, ${grey})`;
  return `linear-gradient(90deg, ${blue}, ${near(blue)} ${from}, ${grey} ${from} ${to}, ${near(red)} ${to}, ${red})`;
}

/** One end of the bar, 0 the lower, that is dragged or moved by arrow keys. */
function endHandle(app: App, bar: HTMLElement, end: 0 | 1): HTMLElement {
  const handle = h('span', { class: `legend-end ${end === 0 ? 'lower' : 'upper'}`, tabIndex: 0, role: 'slider',
    aria: { label: `${end === 0 ? 'Lower' : 'Upper'} end of the colours` } });
  let from: { limits: [number, number]; left: number; width: number } | null = null;
  handle.addEventListener('pointerdown', (event) => {
    const { left, width } = bar.getBoundingClientRect();
    from = { limits: [...app.display.limits], left, width };
    handle.setPointerCapture(event.pointerId);
    event.preventDefault();
    handle.focus();
  });
  handle.addEventListener('pointermove', (event) => {
    if (!from) return;
    const place = (event.clientX - from.left) / from.width; // 0 and 1 at the ends of the bar
    setEnd(app, end, from.limits, place);
    const shift = Math.max(-16, Math.min(from.width / 2 - 6, end === 0 ? event.clientX - from.left : from.left + from.width - event.clientX));
    bar.style[end === 0 ? 'marginLeft' : 'marginRight'] = handle.style[end === 0 ? 'left' : 'right'] = `${shift}px`;
  });
  for (const name of ['pointerup', 'pointercancel'] as const) {
    handle.addEventListener(name, () => {
      from = null;
      bar.style.margin = handle.style.left = handle.style.right = '';
    });
  }
  handle.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: -0.05, ArrowDown: -0.05, ArrowRight: 0.05, ArrowUp: 0.05 }[event.key];
    if (step === undefined) return;
    setEnd(app, end, app.display.limits, end + step);
    event.preventDefault();
    event.stopPropagation();
  });
  return handle;
}

/** Puts an end of the colours where `place` lies on a bar with these limits. Colours about 0 without limits of their own stay symmetric. */
function setEnd(app: App, end: 0 | 1, [lower, upper]: [number, number], place: number): void {
  const { colour } = app.display;
  if (!colour) return;
  const short = (x: number) => Number(x.toPrecision(3));
  let limits: [number, number];
  if (colour.palette === 'rising') {
    const value = lower + place * (upper - lower);
    const least = 0.01 * (upper - lower);
    limits = end === 0 ? [short(Math.min(value, upper - least)), upper] : [lower, short(Math.max(value, lower + least))];
  } else {
    const times = Math.max(0.01, end === 0 ? 1 - 2 * place : 2 * place - 1);
    const both = colour.limits === null;
    limits = [end === 0 || both ? short(times * lower) : lower, end === 1 || both ? short(times * upper) : upper];
  }
  app.setDisplay({ limits, autoLimits: false });
}
