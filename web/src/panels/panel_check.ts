import type { EdgeMeasures } from '@knead/generated';
import { type EdgeClass, type EdgeOrder, figureOf, isFault, limitOf, type Measure, measures, ordered, reportJson, shown, verdict } from '../document/edge_checks';
import { download } from '../document/download';
import { format, parseLength, parseNumber } from '../document/units';
import type { App } from './app';
import { field, h, select } from './dom';
import type { EdgeCheckup } from './edge_checkup';
import { numberInput } from './number_input';
import { panel, row } from './panel';

const columns: [EdgeOrder, string, string][] = [
  ['id', 'Edge', 'In the order of the file'],
  ['gap', 'Gap', 'Between the faces that meet there, or between them and the curve of the edge: the widest along it'],
  ['angle', 'Angle', 'Between the normals of the faces, the largest along the edge; 0° is smooth'],
  ['curvature', 'Curv.', 'Difference of the curvatures across the edge over their sum, percent, where the faces are tangent'],
];
const classes: [EdgeClass, string][] = [['none', 'Not judged'], ['a', 'A: 0.01 mm, 0.1°'], ['b', 'B: 0.02 mm, 0.2°'], ['c', 'C: 0.05 mm, 0.5°'], ['own', 'Own limits']];
const names: Record<Measure, string> = { gap: 'Gap', angle: 'Angle', curvature: 'Curvature' };
const none = Infinity; // no limit
const most: Record<Measure, number> = { gap: none, angle: 5, curvature: 100 }; // limits
const listed = 200; // rows, until more are asked for

/** How the faces of the whole document meet at its edges: verdict, table and limits. A click on a row leads to the edge. */
export function checkPanel(app: App, checkup: EdgeCheckup): HTMLElement {
  let all = false;
  let scrolled = 0;
  let typing = false; // what comes from the engine meanwhile must not take the field away
  let last: unknown[] = [];
  const key = () => (typing ? last : (last = [checkup.version, checkup.stale, all, app.viewer.unit]));
  const more = () => {
    all = true;
    checkup.set({});
  };
  const table = (rows: readonly EdgeMeasures[]): HTMLElement => {
    const head = columns.map(([by, text, about]) => h('th', { scope: 'col', aria: { sort: checkup.order === by ? (by === 'id' ? 'ascending' : 'descending') : 'none' } },
      h('button', { type: 'button', title: about, aria: { label: `Sort by ${by === 'id' ? 'edge' : by}` }, onclick: () =>
        checkup.set({ order: checkup.order === by ? 'worst' : by }) }, text)));
    const element = h('div', { class: 'edges-frame', tabIndex: 0, role: 'region', aria: { label: 'Table of edges' } },
      h('table', { class: 'edges', aria: { label: 'Edges of the document' } }, h('thead', {}, h('tr', {}, ...head)),
        h('tbody', {}, ...rows.slice(0, all ? rows.length : listed).map((e) => rowOf(checkup, e)))));
    element.addEventListener('scroll', () => (scrolled = element.scrollTop));
    requestAnimationFrame(() => (element.scrollTop = scrolled));
    return element;
  };
  const element = panel(app, 'Edges', key, () => {
    const { report } = checkup;
    const parts: (Node | null)[] = [h('p', { class: 'note verdict', aria: { live: 'polite' }, data: { verdict: verdictOf(checkup) } },
      checkup.failed ? `The edges cannot be measured: ${checkup.failed}` : report ? verdict(report, checkup.judging.grade, checkup.worse) : 'Measuring the edges of the document …')];
    if (checkup.stale || checkup.failed) {
      parts.push(row(h('span', { class: 'note stale' }, checkup.failed ? '' : 'Measured before the last change.'),
        h('button', { class: 'button small', type: 'button', disabled: checkup.busy, onclick: () => void checkup.measure() }, 'Measure again')));
    }
    parts.push(...limitFields(app, checkup));
    if (!report || report.edges.length === 0) return parts;
    const rows = ordered(report, checkup.order, checkup.kind);
    const kinds: [string, string][] = [['all', `All ${report.edges.length}`], ...report.counts.map(({ kind, count }): [string, string] => [kind, `${kind} ${count}`])];
    const colours: [Measure | 'none', string][] = [['none', 'Nothing'], ...measures.map((m): [Measure, string] => [m, names[m]])];
    parts.push(
      field('Kind', select('Kind of edges', kinds, checkup.kind, (kind) => checkup.set({ kind }))),
      field('Colour by', select('Colour edges by', colours, checkup.colour ?? 'none', (to) => checkup.set({ colour: to === 'none' ? null : to })), 'In the view, from the limit to the largest value'),
      table(rows),
      rows.length > listed && !all ? h('button', { class: 'button small', type: 'button', onclick: more }, `Show all ${rows.length} rows`) : null,
      row(h('button', { class: 'button small', type: 'button', title: 'As knead check --json writes it', onclick: () =>
        download(reportJson(report), `${app.documents.name.replace(/\.[^.]*$/, '')}-edges.json`, 'application/json') }, 'Download report')));
    return parts;
  }, false, (a) => (a.state?.surfaces.length ?? 0) > 0 || a.viewer.context.pieces.length > 0);
  const look = () => (checkup.shown = (element as HTMLDetailsElement).open && !element.hidden);
  element.addEventListener('toggle', () => {
    look();
    app.changed();
  });
  element.addEventListener('input', ({ target }) => (typing = target instanceof HTMLInputElement));
  element.addEventListener('focusout', () => {
    if (!typing) return;
    typing = false;
    app.changed();
  });
  app.onChange.push(look);
  return element;
}

function verdictOf({ report, failed }: EdgeCheckup): string {
  if (!report || failed || measures.every((m) => report.thresholds[m] === null)) return '';
  return report.passed ? 'passed' : 'failed';
}

/** A class or limits of one's own; and, where the file has no unit, what its lengths are. */
function limitFields(app: App, checkup: EdgeCheckup): (Node | null)[] {
  const { judging, report } = checkup;
  const { unit } = app.viewer;
  const number = (measure: Measure, value: number | null) => field(measure === 'gap' ? `Gap, ${unit || 'length'}` : measure === 'angle' ? 'Angle, °' : 'Curv., %',
    numberInput(`Limit of ${names[measure].toLowerCase()}`, value, (x) => {
      if (x < 0 || (x > most[measure] && x < none)) return `A limit from 0${most[measure] < none ? ` to ${most[measure]}` : ''}, or nothing`;
      return void checkup.judge({ [measure]: x === none ? null : x });
    }, (text) => (text.trim() === '' ? none : measure === 'gap' ? parseLength(text, unit) : parseNumber(text)), 'none'));
  const choose = (grade: EdgeClass) => checkup.judge(grade === 'own' && report
    ? { grade, gap: judging.gap ?? limitOf(report, 'gap'), angle: judging.angle ?? limitOf(report, 'angle') } : { grade });
  const unknown = (unit === '' || unit === 'unknown') && ['a', 'b', 'c'].includes(judging.grade);
  return [
    field('Limits', select('Limits of edges', classes, judging.grade, choose)),
    unknown ? field('Lengths in', select('Unit of lengths', ['mm', 'cm', 'm', 'inch', 'foot'].map((u) => [u, u] as [string, string]), judging.unit, (to) => checkup.judge({ unit: to })), 'The file does not say its unit') : null,
    ...(judging.grade === 'own' ? [number('gap', judging.gap), number('angle', judging.angle)] : []),
    judging.grade === 'none' ? null : number('curvature', judging.curvature),
  ];
}

function rowOf(checkup: EdgeCheckup, e: EdgeMeasures): HTMLElement {
  const report = checkup.report!;
  const faces = e.faces.length > 0 ? `${e.faces.length > 1 ? 'between' : 'of'} ${e.faces.join(', ')}` : '';
  const cells = measures.map((m) => {
    const figure = figureOf(e, m), wrong = isFault(report, e, m), worse = checkup.isWorse(e.id, m);
    const at = figure ? `at (${figure.at.point.map(format).join(', ')})` : '';
    return h('td', { class: wrong ? 'wrong' : '', title: [at, worse ? 'worse than as opened' : ''].filter(Boolean).join(', ') },
      `${shown(report, e, m)}${figure && m !== 'gap' ? { angle: '°', curvature: '%' }[m] : ''}`, worse && h('span', { class: 'worse', role: 'img', aria: { label: 'worse than as opened' } }, '▲'));
  });
  const label = [`Edge ${e.id}`, e.kind, faces].filter(Boolean).join(', ');
  return h('tr', { class: e.id === checkup.chosen ? 'on' : '', data: { edge: e.id } },
    h('th', { scope: 'row' }, h('button', { type: 'button', title: e.reason || `${label}: zoom to it`, aria: { label, pressed: String(e.id === checkup.chosen) },
      onclick: () => checkup.mark(e) }, e.id, h('small', {}, e.kind))),
    ...cells);
}
