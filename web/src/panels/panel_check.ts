import { allowedGap, brokeSmooth, type CheckedEdge, type EdgeOrder, edgesInWords, gapes, ordered } from '../document/edge_checks';
import { format } from '../document/units';
import { EdgeMark } from '../tools/edge_mark';
import { continuityOf, continuityTitles, type Edge } from '../tools/held';
import type { App } from './app';
import { h } from './dom';
import { note, panel } from './panel';

const columns: [EdgeOrder, string, string][] = [
  ['id', 'Edge', 'By the number in the file'], ['gap', 'Gap', 'Between the faces that meet there, the widest along the edge'],
  ['angle', 'Angle', 'Between the normals of the faces, the largest along the edge; 0° is smooth'],
  ['curvature', 'Bend', 'By which the curvatures of the faces differ where they are smooth, the largest along the edge; 0 is continuous curvature'],
];

/** How the faces at the edges of the selected surfaces meet: a table, the worst first. A click on a row leads to the edge. */
export function checkPanel(app: App): HTMLElement {
  const mark = new EdgeMark(app.viewer);
  let edges: CheckedEdge[] | null = null;
  let failed = '';
  let of = '';
  let order: EdgeOrder = 'worst';
  let chosen: string | null = null;
  let courses = new Map<string, readonly number[]>();

  const surfaces = (a: App) => (a.viewer.waiting ? [] : (a.state?.selection ?? []).filter((k) => (a.state!.surfaces[k]?.faces ?? 0) > 0));
  const busy = (a: App) => a.hand.active || a.playing();
  /** Asks again only when something has changed, and nothing is under way. */
  const ask = async () => {
    const now = `${app.documents.sessions} ${app.changes} ${surfaces(app).join()}`;
    if (now === of || busy(app)) return;
    of = now;
    try {
      const found = await Promise.all(surfaces(app).map(async (surface) => (await app.client.query('checked_edges', { surface })).map((e) => ({ ...e, surface }))));
      if (of !== now) return;
      [edges, failed] = [found.flat(), ''];
    } catch (error) {
      if (of !== now) return;
      [edges, failed] = [[], error instanceof Error ? error.message : String(error)];
    }
    app.changed();
  };
  const unmark = () => {
    chosen = null;
    mark.hide();
  };
  const lead = async (edge: CheckedEdge) => {
    if (chosen === edge.id) unmark();
    else {
      chosen = edge.id;
      const { id } = app.state!.surfaces[edge.surface]!;
      const key = `${id} ${edge.id}`;
      if (!courses.has(key)) {
        for (const e of await app.client.query('face_edges', { surface: edge.surface }).catch(() => [])) courses.set(`${id} ${e.id}`, e.course);
      }
      if (chosen !== edge.id) return; // another click since
      mark.show(id, courses.get(key) ?? []);
      mark.zoom();
    }
    app.changed();
  };
  let session = -1;
  const element = panel(app, 'Edges', (a) => [edges, failed, order, chosen, a.state?.surfaces.map((s) => s.constraints), surfaces(a)], () => {
    if (surfaces(app).length === 0) return [note('Select a surface with faces.')];
    if (failed) return [note(`The edges cannot be checked: ${failed}`)];
    if (!edges) return [note('…')];
    const unit = app.viewer.unit;
    const allowed = allowedGap(unit);
    const list = ordered(edges, order, allowed);
    const head = columns.map(([by, text, about]) => h('th', { scope: 'col', aria: { sort: order === by ? 'descending' : 'none' } },
      h('button', { type: 'button', title: about, aria: { label: `Sort by ${text.toLowerCase()}` }, onclick: () => {
        order = order === by ? 'worst' : by;
        app.changed();
      } }, text)));
    return [
      h('p', { class: 'note', aria: { live: 'polite' } }, edgesInWords(list, unit)),
      h('table', { class: 'edges', aria: { label: 'Edges of the selected faces' } },
        h('thead', {}, h('tr', {}, ...head, h('th', { scope: 'col' }, 'Held'))),
        h('tbody', {}, ...list.map((e) => rowOf(e, allowed)))),
    ];
  }, false, (a) => (a.state?.surfaces.some((s) => s.faces > 0) ?? false));

  const rowOf = (e: CheckedEdge, allowed: number): HTMLElement => {
    const info = app.state!.surfaces[e.surface]!;
    const faces = `${e.faces.length > 1 ? 'between' : 'of'} ${e.faces.join(', ')}`;
    const was = (text: string, value: number | null) => (value === null ? '' : `As opened ${text}`);
    const gap = h('td', { class: gapes(e, allowed) ? 'wrong' : '', title: was(`${format(e.opened_gap)}`, e.opened_gap) },
      e.unknown || e.faces.length < 2 ? '–' : format(e.gap < 1e-6 * allowed ? 0 : e.gap));
    const angle = h('td', { class: brokeSmooth(e) ? 'wrong' : '', title: was(`${format(e.opened_angle ?? 0)}°`, e.opened_angle) },
      e.angle === null ? '–' : `${e.angle < 1e-6 ? '0' : format(e.angle)}°`);
    const curvature = h('td', { title: was(`${format(e.opened_curvature ?? 0)} per ${app.viewer.unit}`, e.opened_curvature) },
      e.curvature === null ? '–' : format(e.curvature < 1e-9 / app.diagonal ? 0 : e.curvature));
    return h('tr', { class: e.id === chosen ? 'on' : '', data: { edge: e.id } },
      h('th', { scope: 'row' }, h('button', { type: 'button', title: e.unknown || `Edge ${e.id} ${faces}: zoom to it`,
        aria: { label: `Edge ${e.id} ${faces}`, pressed: String(e.id === chosen) }, onclick: () => void lead(e) }, e.id, h('small', {}, e.faces.join(' ')))),
      gap, angle, curvature, h('td', {}, continuityTitles[continuityOf(info, e.id as Edge)]));
  };
  app.onChange.push(() => {
    if (session !== app.documents.sessions) {
      session = app.documents.sessions;
      courses = new Map();
      edges = null;
      unmark();
    }
    mark.refresh();
    if ((element as HTMLDetailsElement).open && !element.hidden) void ask();
    else if (chosen) unmark();
  });
  element.addEventListener('toggle', () => app.changed());
  return element;
}
