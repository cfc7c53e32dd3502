import { format } from '../document/units';
import { unitIn } from '../engine/displays';
import type { App } from './app';
import { h } from './dom';

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
    const { colour, limits: [lower, upper], stripes } = app.display;
    element.hidden = colour === null || stripes !== 'none';
    if (!colour || stripes !== 'none') return;
    title.textContent = `${colour.title}, ${unitIn(colour.unit, app.viewer.unit)}`;
    bar.classList.toggle('rising', colour.palette === 'rising');
    const shares = colour.palette === 'rising' ? [0, 0.25, 0.5, 0.75, 1] : [-1, -0.5, 0, 0.5, 1];
    const values = shares.map((x) => (x < 0 ? -x * lower : x * upper));
    ticks.replaceChildren(...values.map((x) => h('span', {}, x === 0 ? '0' : `${x < 0 ? '−' : ''}${format(Math.abs(x))}`)));
    compare.hidden = !colour.compares;
  });
  return element;
}
