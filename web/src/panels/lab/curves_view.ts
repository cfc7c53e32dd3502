import { format } from '../../document/units';
import type { LabModel } from './model';
import type { Curves } from './module';
import { colour, impulseName } from './names';
import { margin, type PlotFrame } from './plot_frame';
import { s, set, ticks } from './svg';

/** Draws the sampled functions, and their impulses as arrows. */
export class CurvesView {
  readonly element = s('g', { 'aria-hidden': 'true' });
  private readonly grid = s('g', { class: 'lab-gridlines' });
  private readonly areas = s('g', { class: 'lab-areas' });
  private readonly jumps = s('path', { class: 'lab-jump', fill: 'none' });
  private readonly curves = s('g', { class: 'lab-curves', fill: 'none' });
  private readonly impulses = s('g', { class: 'lab-impulses' });

  constructor(private readonly model: LabModel, private readonly frame: PlotFrame, clip: string) {
    for (const g of [this.areas, this.jumps, this.curves]) g.setAttribute('clip-path', `url(#${clip})`);
    this.element.append(this.grid, this.areas, this.jumps, this.curves, this.impulses);
  }

  draw(dark: boolean): void {
    const { frame, model } = this;
    this.drawGrid();
    const { offsets, points } = model.curves;
    const n = offsets.length - 1;
    while (this.curves.children.length > n) this.curves.lastChild!.remove();
    while (this.curves.children.length < n) this.curves.append(s('path'));
    let breaks = '';
    const nothing = model.curves.lowest === model.curves.highest; // except impulses
    for (let i = 0; i < n; ++i) {
      let d = '';
      if (nothing) {
        set(this.curves.children[i]!, { d: 'M0 0' });
        continue;
      }
      for (let k = offsets[i]!; k < offsets[i + 1]!; ++k) {
        const [u, v] = [points[2 * k]!, points[2 * k + 1]!];
        if (!Number.isFinite(v)) continue;
        const jumps = k > offsets[i]! && points[2 * k - 2] === u && points[2 * k - 1] !== v;
        const [x, y] = [frame.x(u).toFixed(2), frame.y(v).toFixed(2)];
        // Limits that differ only by rounding are one point of the picture.
        if (jumps && Math.abs(frame.y(points[2 * k - 1]!) - frame.y(v)) > 0.5) {
          breaks += `M${x} ${frame.y(points[2 * k - 1]!).toFixed(2)}V${y}`;
          d += `M${x} ${y}`;
        } else d += `${d === '' ? 'M' : 'L'}${x} ${y}`;
      }
      set(this.curves.children[i]!, { d: d || 'M0 0', stroke: colour(i, dark) });
    }
    set(this.jumps, { d: breaks || 'M0 0' });
    this.drawImpulses(model.curves, dark);
    this.light(dark);
  }

  /** Highlights what is under the pointer. */
  light(dark: boolean): void {
    const { highlight } = this.model;
    const lit = (i: number) => highlight !== null && (highlight.i === i || highlight.j === i);
    [...this.curves.children].forEach((path, i) => path.classList.toggle('lit', lit(i)));
    this.curves.classList.toggle('some-lit', highlight !== null);
    for (const arrow of this.impulses.children) arrow.classList.toggle('lit', lit(Number(arrow.getAttribute('data-function'))));
    this.impulses.classList.toggle('some-lit', highlight !== null);
    const functions = highlight ? [...new Set([highlight.i, highlight.j])] : [];
    this.areas.replaceChildren(...functions.map((i) => s('path', { d: this.area(i), fill: colour(i, dark) })));
  }

  private area(i: number): string {
    const { offsets, points } = this.model.curves;
    const [first, last] = [offsets[i] ?? 0, (offsets[i + 1] ?? 0) - 1];
    if (last <= first) return 'M0 0';
    const zero = this.frame.y(0).toFixed(2);
    let d = `M${this.frame.x(points[2 * first]!).toFixed(2)} ${zero}`;
    for (let k = first; k <= last; ++k) {
      const v = points[2 * k + 1]!;
      if (Number.isFinite(v)) d += `L${this.frame.x(points[2 * k]!).toFixed(2)} ${this.frame.y(v).toFixed(2)}`;
    }
    return `${d}V${zero}Z`;
  }

  private drawGrid(): void {
    const { frame, model } = this;
    const lines: Node[] = [];
    const [low, high] = model.basis.domain;
    const [first, last] = [model.now.knots[0]!, model.now.knots.at(-1)!];
    // Outside the domain there are functions, but no curve or surface.
    for (const [from, to] of [[first, low], [high, last]] as const) {
      if (to > from) lines.push(s('rect', { class: 'lab-outside', x: frame.x(from), y: margin.top, width: frame.x(to) - frame.x(from), height: frame.bottom - margin.top }));
    }
    // If there are only impulses, the heights are their weights.
    const { lowest, highest, weight } = model.curves;
    const weights = weight > 0 && !(highest > lowest);
    const range: [number, number] = weights ? [-frame.v[1], frame.v[1]] : frame.v;
    const place = (v: number) => (weights ? frame.y(0) - v * frame.weight : frame.y(v));
    for (const v of ticks(range[0], range[1], (frame.bottom - margin.top) / 34)) {
      const y = place(v);
      if (y < margin.top - 1 || y > frame.bottom + 1) continue;
      lines.push(s('line', { class: v === 0 ? 'lab-zero' : '', x1: margin.left, x2: frame.right, y1: y, y2: y }),
        s('text', { x: margin.left - 6, y: y + 3.5, 'text-anchor': 'end' }, format(v)));
    }
    for (const u of ticks(frame.u[0], frame.u[1], (frame.right - margin.left) / 70)) {
      lines.push(s('text', { x: frame.x(u), y: frame.height - 5, 'text-anchor': 'middle' }, format(u)));
    }
    this.grid.replaceChildren(...lines);
  }

  private drawImpulses({ impulses }: Curves, dark: boolean): void {
    const { frame } = this;
    const all = Array.from({ length: impulses.length / 4 }, (_, k) => ({ i: impulses[4 * k]!, knot: impulses[4 * k + 1]!, order: impulses[4 * k + 2]!, weight: impulses[4 * k + 3]! }));
    const zero = frame.y(0);
    const arrows: Node[] = [];
    for (const knot of new Set(all.map((f) => f.knot))) {
      const here = all.filter((f) => f.knot === knot && Number.isFinite(f.weight));
      // Impulses of several functions at one knot are drawn side by side.
      const plain = here.filter((f) => f.order === 0);
      plain.forEach((f, k) => {
        const x = frame.x(knot) + (k - (plain.length - 1) / 2) * Math.min(6, 40 / plain.length);
        const tip = zero - f.weight * frame.weight;
        const head = Math.sign(f.weight) * Math.min(7, Math.abs(tip - zero));
        arrows.push(s('g', { class: 'lab-impulse', 'data-function': f.i, stroke: colour(f.i, dark), fill: colour(f.i, dark) },
          s('line', { x1: x, x2: x, y1: zero, y2: tip + head / 2 }),
          s('path', { d: `M${x} ${tip}l-3.5 ${head}h7z`, stroke: 'none' }),
          s('text', { x, y: tip + (f.weight > 0 ? -4 : 12), 'text-anchor': 'middle', stroke: 'none' }, format(f.weight))));
      });
      // Derivatives of impulses have no height to draw: a mark on the axis, named when pointed at.
      const higher = here.filter((f) => f.order > 0);
      higher.forEach((f) => {
        const x = frame.x(knot);
        arrows.push(s('g', { class: 'lab-impulse higher', 'data-function': f.i, fill: colour(f.i, dark), stroke: 'none' },
          s('path', { d: `M${x} ${zero - 5}l4 5l-4 5l-4 -5z` }),
          s('text', { x, y: zero - 9 - 12 * (f.order - 1), 'text-anchor': 'middle' }, `${format(f.weight)} ${impulseName(f.order)}`)));
      });
    }
    this.impulses.classList.toggle('few', all.length <= 16);
    this.impulses.replaceChildren(...arrows);
  }
}
