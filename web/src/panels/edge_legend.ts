import { figureOf, limitOf, mostOf, ramp, shown, suffix, worstBy } from '../document/edge_checks';
import { format } from '../document/units';
import type { App } from './app';
import { h } from './dom';
import type { EdgeCheckup } from './edge_checkup';

const titles = { gap: 'Gap of edges', angle: 'Angle at smooth edges', curvature: 'Curvature difference at edges' };

/** What the colours of edges mean: a card in the corner of the scene. */
export function edgeLegend(app: App, checkup: EdgeCheckup): HTMLElement {
  const element = h('section', { class: 'edge-legend', hidden: true, aria: { label: 'Meaning of the colours of edges' } });
  let drawn = '';
  app.onChange.push(() => {
    const { report, colour, shown: open } = checkup;
    element.hidden = !open || !report || !colour || report.edges.length === 0;
    const now = JSON.stringify([checkup.version, colour, checkup.stale]);
    if (element.hidden || now === drawn) return;
    drawn = now;
    const limit = limitOf(report!, colour!), most = mostOf(report!, colour!), { loud } = checkup;
    const unit = suffix(colour!, report!.unit);
    element.replaceChildren(h('b', {}, titles[colour!]), checkup.stale ? h('small', {}, 'measured before the last change') : '',
      ...(loud === 0 ? [h('p', {}, `None above ${format(limit)}${unit}`)] : [
        Object.assign(h('i', { class: 'legend-bar' }), { style: `background: linear-gradient(90deg, ${ramp.join(', ')})` }),
        h('div', { class: 'legend-ticks' }, h('span', {}, `${format(limit)}${unit}`), h('span', {}, `${format(most)}${unit}`)),
        h('p', {}, `${loud} of ${report!.edges.length} above the ${report!.thresholds[colour!] === null ? 'tolerance' : 'limit'}; grey: within it`)]));
  });
  return element;
}

/** The worst values beside their places. The table says the same. */
export function edgeLabels(app: App, checkup: EdgeCheckup): HTMLElement {
  const { viewer } = app;
  const element = h('div', { class: 'reading-labels edge-labels', aria: { hidden: 'true' } });
  let labels: { point: number[]; matrix: { matrix: import('three').Matrix4 }; label: HTMLElement }[] = [];
  let drawn = '';
  app.onChange.push(() => {
    const { report, colour, shown: open } = checkup;
    const now = JSON.stringify([open, checkup.version, colour, viewer.origin]);
    if (now === drawn) return;
    drawn = now;
    const worst = open && report && colour ? worstBy(report, colour) : [];
    labels = worst.map((e) => ({
      point: figureOf(e, colour!)!.at.point.map((x, d) => x - viewer.origin[d]!), matrix: viewer.placing.working(e.faces[0] ?? ''),
      label: h('span', { class: 'reading-label' }, `${shown(report!, e, colour!)}${suffix(colour!, report!.unit)}`),
    }));
    element.replaceChildren(...labels.map(({ label }) => label));
    viewer.redraw();
  });
  viewer.onDrawn.push(() => {
    const stage = viewer.element.getBoundingClientRect();
    for (const { point, matrix, label } of labels) {
      const [x, y] = viewer.places(viewer.main, point, matrix);
      label.hidden = Number.isNaN(x);
      label.style.left = `${Math.round(x! - stage.left)}px`;
      label.style.top = `${Math.round(y! - stage.top)}px`;
    }
  });
  return element;
}
