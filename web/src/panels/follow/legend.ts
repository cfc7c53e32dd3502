import { ramp } from '../../document/deviations';
import { format } from '../../document/units';
import type { App } from '../app';
import { h } from '../dom';
import type { FollowData } from './follow_data';

/** What the colours of data mean: a card in the corner of the scene. */
export function deviationLegend(app: App, following: FollowData): HTMLElement {
  const element = h('section', { class: 'deviation-legend', hidden: true, aria: { label: 'Meaning of the colours of data' } });
  let drawn = '';
  app.onChange.push(() => {
    element.hidden = !following.shown || !following.deviations;
    const now = JSON.stringify([following.ends, following.stale, app.viewer.unit, following.done !== null, following.part]);
    if (element.hidden || now === drawn) return;
    drawn = now;
    const { ends } = following, unit = app.viewer.unit === 'unknown' ? '' : app.viewer.unit;
    element.replaceChildren(h('b', {}, `Data above the faces${unit ? `, ${unit}` : ''}`), following.stale ? h('small', {}, 'compared before the last change') : '',
      Object.assign(h('i', { class: 'legend-bar' }), { style: `background: ${ramp}` }),
      h('div', { class: 'legend-ticks' }, h('span', {}, `−${format(ends)}`), h('span', {}, '0'), h('span', {}, format(ends))),
      h('p', {}, 'Dark grey: left out'));
  });
  return element;
}
