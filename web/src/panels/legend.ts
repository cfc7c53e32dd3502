import { format } from '../document/units';
import type { App } from './app';
import { h } from './dom';
import { fieldNames } from './panel_display';

/** What the colours of the surface mean: a card in the corner of the scene. */
export function legendCard(app: App): HTMLElement {
  const title = h('b', {});
  const bar = h('i', { class: 'legend-bar' });
  const ticks = h('div', { class: 'legend-ticks' });
  const compare = h('button', { class: 'button small', type: 'button', title: 'Hold to see the shape as it was opened (C)' }, 'Hold: as opened');
  compare.addEventListener('pointerdown', () => app.compare(true));
  for (const end of ['pointerup', 'pointerleave', 'pointercancel', 'blur'] as const) compare.addEventListener(end, () => app.compare(false));
  compare.addEventListener('keydown', (e) => {
    if (e.key === 'Enter' || e.key === ' ') app.compare(true);
  });
  compare.addEventListener('keyup', () => app.compare(false));
  const element = h('section', { class: 'legend-card', hidden: true, aria: { label: 'Meaning of the colours' } }, title, bar, ticks, compare);
  app.onChange.push(() => {
    const { field, limit, zebra } = app.display;
    const shown = field !== 'none' && !zebra;
    element.hidden = !shown;
    if (!shown) return;
    const unit = app.viewer.unit;
    const units = { none: '', deviation: unit, gap: unit, mean: `1/${unit}`, gaussian: `1/${unit}²`, energy: 'normalised' }[field];
    title.textContent = `${fieldNames.find(([f]) => f === field)![1]}, ${units}`;
    const positive = field === 'energy';
    bar.classList.toggle('positive', positive);
    const values = positive ? [0, 0.25, 0.5, 0.75, 1] : [-1, -0.5, 0, 0.5, 1];
    ticks.replaceChildren(...values.map((x) => h('span', {}, x === 0 ? '0' : `${x < 0 ? '−' : ''}${format(Math.abs(x) * limit)}`)));
    compare.hidden = field !== 'deviation';
  });
  return element;
}
