import { h } from '../dom';
import { CurvesView } from './curves_view';
import { KnotHandles } from './knot_handles';
import type { LabModel, What } from './model';
import { exact, functionName, tiny } from './names';
import { margin, PlotFrame } from './plot_frame';
import { s, set } from './svg';

/** The plot of all functions over the knots. */
export class Plot {
  readonly svg = s('svg', { class: 'lab-svg', role: 'group', 'aria-label': 'Basis functions over their knots' });
  readonly readout = h('output', { class: 'lab-readout', aria: { live: 'off', label: 'Values at the pointer' } });
  readonly element = h('div', { class: 'lab-plot' }, this.svg, this.readout);
  /** The heights stay as they are while knots move. */
  holdScale = false;

  private readonly frame = new PlotFrame();
  private readonly clip = s('rect');
  private readonly cursor = s('line', { class: 'lab-cursor', 'aria-hidden': 'true', visibility: 'hidden' });
  private readonly curves: CurvesView;
  private readonly knots: KnotHandles;
  private readonly observer: ResizeObserver;

  constructor(private readonly model: LabModel, private readonly dark: () => boolean) {
    this.curves = new CurvesView(model, this.frame, 'lab-clip');
    this.knots = new KnotHandles(model, this.frame, this.svg);
    this.svg.append(s('defs', {}, s('clipPath', { id: 'lab-clip' }, this.clip)), this.curves.element, this.cursor, this.knots.element);
    this.svg.addEventListener('pointermove', (e) => this.point(e));
    this.svg.addEventListener('pointerleave', () => this.leave());
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.element);
    this.say();
  }

  close(): void {
    this.observer.disconnect();
  }

  update(what: Set<What>): void {
    if (what.has('knots') || what.has('order')) this.draw();
    else if (what.has('highlight')) {
      this.curves.light(this.dark());
      this.knots.draw();
    }
  }

  draw(): void {
    const { frame, model } = this;
    if (!this.knots.dragging) frame.fitU(model.now.knots);
    if (!this.holdScale) frame.fitV(model.curves, model.order);
    set(this.svg, { viewBox: `0 0 ${frame.width} ${frame.height}`, width: frame.width, height: frame.height });
    set(this.clip, { x: margin.left, y: 0, width: Math.max(0, frame.right - margin.left), height: frame.bottom });
    this.curves.draw(this.dark());
    this.knots.draw();
    this.say();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element;
    if (clientWidth < 120 || clientHeight < 100) return;
    [this.frame.width, this.frame.height] = [clientWidth, clientHeight];
    this.model.setPixels(clientWidth);
    this.draw();
  }

  /** Under the pointer: the value of the nearest function there, and the sum of all. */
  private point(event: PointerEvent): void {
    const box = this.svg.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const { frame, model } = this;
    if (this.knots.dragging || x < margin.left || x > frame.right || y > frame.bottom) {
      if (!this.knots.dragging) this.leave();
      return;
    }
    const u = frame.parameter(x);
    const { values, sum } = model.module.probe(model.order, u);
    let nearest = -1;
    let least = 30; // pixels
    values.forEach((v, i) => {
      if (v === 0 || !Number.isFinite(v)) return;
      const away = Math.abs(frame.y(v) - y);
      if (away < least) [nearest, least] = [i, away];
    });
    const arrow = (event.target as Element).closest('.lab-impulse');
    if (arrow) nearest = Number(arrow.getAttribute('data-function'));
    set(this.cursor, { visibility: 'visible', x1: x, x2: x, y1: margin.top, y2: frame.bottom });
    model.show(nearest < 0 ? null : { i: nearest, j: nearest });
    const { order } = model;
    const parts = [`u ${u.toPrecision(5)}`];
    if (nearest >= 0) parts.push(`${functionName(nearest, order)} = ${exact(values[nearest]!)}`);
    const [low, high] = model.basis.domain;
    if (order === 0 && u >= low && u <= high) parts.push(`Σ − 1 = ${tiny(sum - 1)}`);
    else if (order > 0 && u >= low && u <= high) parts.push(`Σ = ${tiny(sum)}`);
    this.readout.textContent = parts.join('   ');
  }

  private leave(): void {
    set(this.cursor, { visibility: 'hidden' });
    this.model.show(null);
    this.say();
  }

  private say(): void {
    const { count, domain } = this.model.basis;
    const unity = this.model.order === 0 ? `   largest |Σ − 1| ${tiny(this.model.curves.unity)}` : '';
    this.readout.textContent = `${count} functions on [${domain.map((x) => Number(x.toPrecision(6))).join(', ')}]${unity}`;
    this.readout.dataset.unity = String(this.model.curves.unity);
  }
}
