import { format, parseLength } from '../document/units';
import type { Field } from '../engine/session_types';
import { conventionNames, conventionText } from '../view/conventions';
import type { Display } from '../view/display';
import type { App } from './app';
import { field, h, numberInput, select, slider, toggle } from './dom';
import { note, panel, row } from './panel';

export const fieldNames: readonly (readonly [Field, string])[] = [
  ['none', 'Plain'], ['deviation', 'Deviation'], ['mean', 'Mean curvature'], ['gaussian', 'Gaussian curvature'],
  ['gap', 'Distance to tools'], ['energy', 'Energy density'],
];

const about: Partial<Record<Field, string>> = {
  deviation: 'How far each point is from where it was when opened: red along the normal, blue against it. Hold C to see it as opened.',
  mean: 'Mean of the principal curvatures. Steps show where it is not smooth.',
  gaussian: 'Product of the principal curvatures: red is domed, blue a saddle.',
  gap: 'Distance to the nearest tool; blue is inside it.',
  energy: 'Where stretch and bend store the energy of the displacement from the rest shape.',
};

export function displayPanel(app: App): HTMLElement {
  return panel(app, 'Display', (a) => [{ ...a.display, limit: a.display.field === 'none' ? 0 : format(a.display.limit) }], () => {
    const d = app.display;
    const chip = (name: keyof Display, label: string, tip?: string) =>
      toggle(label, d[name] as boolean, (on) => app.setDisplay({ [name]: on }), tip);
    return [
      row(chip('surface', 'Surface'), chip('isocurves', 'Isocurves'), chip('knotLines', 'Knot lines'),
        chip('points', 'Points', 'Control points; held ones in orange'), chip('net', 'Net', 'Control net'), chip('normals', 'Normals'),
        chip('zebra', 'Zebra', 'Reflection stripes: kinks show curvature that jumps (Z)'), chip('grid', 'Grid'),
        chip('context', 'Context', 'The other faces of the file, in grey'),
        chip('trimmed', 'Trimmed', 'Only what the faces of the file show of their surfaces; all of each can be sculpted')),
      field('Colour', select('Colour by', fieldNames, d.field, (f) => app.setDisplay({ field: f, zebra: false, autoLimit: true }))),
      d.field !== 'none' ? note(about[d.field]!) : null,
      d.field !== 'none' ? field('± limit', row(
        numberInput('Limit of the colours', d.limit, (limit) => app.setDisplay({ limit: Math.abs(limit) || d.limit, autoLimit: false }),
          (t) => parseLength(t, app.state?.surfaces[0]?.unit ?? 'mm')),
        toggle('Auto', d.autoLimit, (autoLimit) => app.setDisplay({ autoLimit }), 'The largest value that there is'))) : null,
      field('Point size', slider('Point size', d.pointSize, [2, 14], (pointSize) => app.setDisplay({ pointSize }))),
      field('Detail', select('Detail', [['48', 'Coarse'], ['96', 'Normal'], ['192', 'Fine']], String(d.detail) as '96',
        (v) => app.setDisplay({ detail: Number(v) })), 'Lines of the picture per direction; the surface itself is exact'),
      field('Mouse', select('Mouse as in', conventionNames, d.convention, (convention) => app.setDisplay({ convention }))),
      h('dl', { class: 'bindings' }, ...['Orbit', 'Pan', 'Zoom'].flatMap((what, k) =>
        [h('dt', {}, what), h('dd', {}, conventionText[d.convention][k]!)])),
    ];
  });
}
