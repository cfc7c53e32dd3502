import { parseLength, parseNumber } from '../document/units';
import type { SurfaceNumbers } from '../engine/session_types';
import type { App } from './app';
import { field, h } from './dom';
import { numberInput, refuse } from './number_input';
import { note, panel, row } from './panel';
import { numbers } from './panel_create';

const small = (label: string, title: string, onclick: () => void) => h('button', { class: 'button small', type: 'button', title, onclick }, label);

/** Multiple knots are written once, with their count: 0×4. */
export function knotText(knots: ArrayLike<number>): string {
  const parts: string[] = [];
  for (let k = 0; k < knots.length;) {
    let count = 1;
    while (knots[k + count] === knots[k]) ++count;
    parts.push(count > 1 ? `${knots[k]}×${count}` : String(knots[k]));
    k += count;
  }
  return parts.join('  ');
}

/** The knot vector of such a text; null if it is not one. */
export function readKnots(text: string): number[] | null {
  const result: number[] = [];
  for (const part of text.split(/[\s,;]+/).filter(Boolean)) {
    const match = /^(.+?)(?:[×x*](\d+))?$/.exec(part);
    const value = match ? parseNumber(match[1]!) : null;
    if (value === null) return null;
    result.push(...Array.from({ length: Number(match![2] ?? 1) }, () => value));
  }
  return result;
}

/** Degree, net, knots and weights of the selected surface: for viewing and editing. */
export function surfacePanel(app: App): HTMLElement {
  const chosen = (a: App) => a.state?.surfaces[a.state.selection[0] ?? -1];
  let data: SurfaceNumbers | null = null;
  let of = '';
  const what = (a: App) => {
    const s = chosen(a);
    return s ? [s.id, s.degree, s.net, s.rational, a.hand.active || a.playing() ? null : a.changes] : null;
  };
  return panel(app, 'Knots and net', what, () => {
    const s = chosen(app);
    if (!s) return [note('Select a surface.')];
    const key = `${s.id} ${s.degree} ${s.net} ${s.rational}`;
    const knots = (['u', 'v'] as const).map((direction) => {
      const area = h('textarea', { class: 'number knots', rows: 3, spellcheck: false, aria: { label: `Knots ${direction}` } });
      const fill = () => {
        if (data && document.activeElement !== area) area.value = knotText(direction === 'u' ? data.knots_u : data.knots_v);
      };
      if (of === key) fill();
      area.addEventListener('keydown', (e) => e.stopPropagation());
      area.addEventListener('change', () => {
        const typed = readKnots(area.value);
        const valid = data ? knotText(direction === 'u' ? data.knots_u : data.knots_v) : '';
        if (!typed) refuse(area, 'These are not numbers with spaces between them', valid);
        else void app.offer([{ do: 'knots', direction, knots: typed }]).then((why) => why && refuse(area, why, valid));
      });
      return { direction, area, fill };
    });
    const weights = h('span', {});
    void app.surfaceData(app.state!.selection[0]!).then((now) => {
      data = now;
      of = key;
      for (const k of knots) k.fill();
      const all = now.weights;
      weights.textContent = all.length === 0 ? 'polynomial: all weights 1' : `rational: weights ${Math.min(...all).toPrecision(4)} to ${Math.max(...all).toPrecision(4)}`;
    }, () => {});
    let insert = '';
    const at = (direction: 'u' | 'v') => small(direction, `Insert these knots in ${direction}: the same shape`, () => {
      const list = numbers(insert);
      if (list && list.length > 0) void app.execute([{ do: 'refine', [`knots_${direction}`]: list }]);
      else app.notify({ kind: 'error', text: 'The knots to insert are not a list of numbers', remedy: 'type parameters between the ends of the knot vector' });
    });
    const input = h('input', { class: 'number', type: 'text', placeholder: 'parameters', spellcheck: false, aria: { label: 'Knots to insert' } });
    input.addEventListener('input', () => (insert = input.value));
    input.addEventListener('keydown', (e) => e.stopPropagation());
    let tolerance = 1e-4 * app.diagonal;
    return [
      note(`Degree ${s.degree.join(' × ')}, ${s.net.join(' × ')} control points`),
      weights,
      ...knots.map(({ direction, area }) => field(`Knots ${direction}`, area, 'Another vector of the same length: the points stay, the shape changes. 0×4 means four times')),
      field('Insert', row(input, at('u'), at('v')), 'New knots, the same shape'),
      field('Coarsen', row(numberInput('Tolerance of coarsening', tolerance, (v) => void (tolerance = Math.abs(v)),
        (text) => parseLength(text, s.unit)),
        small('Remove', 'Remove knots where the shape moves by no more than this', () => void app.execute([{ do: 'coarsen', tolerance }])))),
      row(
        small('Halve spans', 'Halve every span: the same shape on a finer net', () => void app.execute([{ do: 'refine', region: [[0, 1], [0, 1]] }])),
        small('Raise degree', 'By one, with the same shape', () => void app.execute([{ do: 'elevate' }])),
      ),
    ];
  }, false);
}
