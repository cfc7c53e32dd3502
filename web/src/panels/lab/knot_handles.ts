import { type Group, groups, inserted, moved, removed, limits } from './knots';
import type { LabModel } from './model';
import { margin, type PlotFrame } from './plot_frame';
import { s, set } from './svg';

const snapPixels = 5;

interface Drag {
  pointer: number;
  x: number;
  group: Group;
  /** Which of the copies move: known once the pointer has moved. */
  first: number;
  last: number;
  start: number[];
}

/**
 * The knots below the plot: one stack of dots per value. Dragging takes the copy that lies in the direction of the drag,
 * with Shift all of them; near a neighbour a knot merges with it, unless Alt is held.
 */
export class KnotHandles {
  readonly element = s('g', { role: 'group', 'aria-label': 'Knots' });
  private readonly lines = s('g', { class: 'lab-knot-lines', 'aria-hidden': 'true' });
  private readonly axis = s('line', { class: 'lab-axis', 'aria-hidden': 'true' });
  private readonly handles = s('g');
  private drag: Drag | null = null;

  constructor(private readonly model: LabModel, private readonly frame: PlotFrame, private readonly svg: SVGSVGElement) {
    this.element.append(this.lines, this.axis, this.handles);
    svg.addEventListener('pointermove', (e) => this.move(e));
    svg.addEventListener('pointerup', (e) => this.end(e));
    svg.addEventListener('pointercancel', () => this.cancel());
    svg.addEventListener('dblclick', (e) => this.insert(e));
  }

  get dragging(): boolean {
    return this.drag !== null;
  }

  draw(): void {
    const { frame, model } = this;
    const all = groups(model.now.knots);
    const y = frame.bottom;
    set(this.axis, { x1: margin.left, x2: frame.right, y1: y, y2: y });
    for (const part of [this.lines, this.handles]) {
      while (part.children.length > all.length) part.lastChild!.remove();
    }
    while (this.lines.children.length < all.length) this.lines.append(s('line'));
    while (this.handles.children.length < all.length) this.handles.append(this.make());
    this.lines.classList.toggle('crowded', all.length * 4 > frame.right - margin.left);
    all.forEach((g, k) => set(this.lines.children[k]!, { x1: frame.x(g.value), x2: frame.x(g.value), y1: margin.top, y2: y }));
    const focused = [...this.handles.children].indexOf(document.activeElement as SVGGElement);
    all.forEach((g, k) => this.show(this.handles.children[k] as SVGGElement, g));
    // The focus follows its knot to whichever stack the knot is in now.
    if (focused >= 0 && model.active >= 0) {
      const at = all.findIndex((g) => model.active >= g.first && model.active < g.first + g.count);
      if (at >= 0 && at !== focused) (this.handles.children[at] as SVGGElement).focus({ preventScroll: true });
    }
  }

  private make(): SVGGElement {
    const handle = s('g', { class: 'lab-knot', role: 'slider', tabindex: 0, 'aria-orientation': 'horizontal' });
    handle.addEventListener('pointerdown', (e) => this.begin(e, handle));
    handle.addEventListener('contextmenu', (e) => {
      e.preventDefault();
      this.cancel();
      this.remove(this.groupOf(handle));
    });
    handle.addEventListener('keydown', (e) => {
      if (this.key(e, this.groupOf(handle))) {
        e.preventDefault();
        e.stopPropagation();
      }
    });
    handle.addEventListener('focus', () => this.activate(this.groupOf(handle)));
    return handle;
  }

  private show(handle: SVGGElement, { value, first, count }: Group): void {
    const { model, frame } = this;
    const [x, y] = [frame.x(value), frame.bottom + 9];
    const [low] = limits(model.now.knots, first, first);
    const [, high] = limits(model.now.knots, first + count - 1, first + count - 1);
    const copies = count === 1 ? 'once' : count === 2 ? 'twice' : `${count} times`;
    const finite = (v: number) => (Number.isFinite(v) ? v : null);
    set(handle, { 'data-first': first, 'data-count': count, 'aria-label': `Knot ${value}, ${copies}`, 'aria-valuenow': value,
      'aria-valuetext': `${value}, ${copies}`, 'aria-valuemin': finite(low), 'aria-valuemax': finite(high) });
    handle.classList.toggle('active', model.active >= first && model.active < first + count);
    set(handle, { transform: `translate(${x.toFixed(2)} ${y})` });
    // Many knots have small dots, without the rings that separate the dots of a few.
    const crowded = model.now.knots.length * 6 > frame.right - margin.left;
    const atEnd = x > frame.width - 44;
    const drawn = `${count} ${crowded} ${atEnd}`;
    if (handle.getAttribute('data-drawn') === drawn) {
      handle.firstElementChild!.textContent = tip(value, copies);
      return;
    }
    set(handle, { 'data-drawn': drawn });
    const gap = Math.min(8.5, 27 / Math.max(1, count - 1));
    handle.classList.toggle('plain', crowded || gap < 6);
    handle.replaceChildren(
      s('title', {}, tip(value, copies)),
      s('rect', { class: 'lab-hit', x: -10, y: -13, width: 20, height: 44, fill: 'transparent' }),
      ...Array.from({ length: count }, (_, k) => s('circle', { cx: 0, cy: k * gap, r: crowded ? 2 : gap < 6 ? 3 : 4 })),
      ...(count > 4 ? [s('text', { x: atEnd ? -7 : 7, y: 31, 'text-anchor': atEnd ? 'end' : 'start' }, `×${count}`)] : []));
  }

  private groupOf(handle: Element): Group {
    const first = Number(handle.getAttribute('data-first'));
    return { first, count: Number(handle.getAttribute('data-count')), value: this.model.now.knots[first]! };
  }

  private activate({ first, count }: Group): void {
    const { active } = this.model;
    if (active < first || active >= first + count) this.model.touch(first + count - 1);
  }

  // --- the pointer -------------------------------------------------------------------------------------------------

  private begin(event: PointerEvent, handle: SVGGElement): void {
    if (event.button !== 0) return;
    event.preventDefault();
    handle.focus({ preventScroll: true });
    this.svg.setPointerCapture(event.pointerId);
    this.drag = { pointer: event.pointerId, x: this.place(event), group: this.groupOf(handle), first: -1, last: -1, start: this.model.now.knots };
  }

  private place(event: MouseEvent): number {
    return event.clientX - this.svg.getBoundingClientRect().left;
  }

  private move(event: PointerEvent): void {
    const { drag, frame, model } = this;
    if (!drag || event.pointerId !== drag.pointer) return;
    const x = this.place(event);
    if (drag.first < 0) {
      if (Math.abs(x - drag.x) < 3) return;
      const { first, count } = drag.group;
      const right = x > drag.x;
      [drag.first, drag.last] = event.shiftKey ? [first, first + count - 1] : right ? [first + count - 1, first + count - 1] : [first, first];
      model.active = drag.first;
    }
    const knots = moved(drag.start, drag.first, drag.last, frame.roundParameter(x), event.altKey ? 0 : snapPixels * frame.pixel);
    model.edit({ degree: model.now.degree, knots });
  }

  private end(event: PointerEvent): void {
    if (!this.drag || event.pointerId !== this.drag.pointer) return;
    this.drag = null;
    this.model.changed('order'); // the axis takes its new extent
  }

  private cancel(): void {
    if (!this.drag) return;
    const { start } = this.drag;
    this.drag = null;
    this.model.edit({ degree: this.model.now.degree, knots: start });
  }

  private insert(event: MouseEvent): void {
    const handle = (event.target as Element).closest('.lab-knot');
    const x = this.place(event);
    if (!handle && (x < margin.left || x > this.frame.right)) return;
    this.add(handle ? this.groupOf(handle).value : this.frame.roundParameter(x));
  }

  // --- edits -------------------------------------------------------------------------------------------------------

  private add(value: number): void {
    const { degree, knots } = this.model.now;
    const more = inserted(knots, value);
    if (this.model.edit({ degree, knots: more })) this.model.touch(more.lastIndexOf(value));
  }

  private remove({ first, count }: Group): void {
    const { degree, knots } = this.model.now;
    this.model.edit({ degree, knots: removed(knots, first + count - 1) });
  }

  /** True if the key was handled. */
  private key(event: KeyboardEvent, group: Group): boolean {
    const { model, frame } = this;
    const { first, count, value } = group;
    if (event.ctrlKey || event.metaKey) return false;
    if (event.key === 'Escape' && this.drag) this.cancel();
    else if (event.key === 'Delete' || event.key === 'Backspace') this.remove(group);
    else if (event.key === 'Insert' || event.key === '+') this.add(value);
    else {
      const far = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (far === undefined) return false;
      const step = 10 ** Math.floor(Math.log10((frame.u[1] - frame.u[0]) / 50));
      const one = far > 0 ? first + count - 1 : first;
      const to = Number((value + far * step).toPrecision(12));
      const [from, last] = event.shiftKey ? [first, first + count - 1] : [one, one];
      if (model.edit({ degree: model.now.degree, knots: moved(model.now.knots, from, last, to) })) model.touch(one);
    }
    return true;
  }
}

const tip = (value: number, copies: string): string =>
  `${value}, ${copies}. Drag it, with Shift all copies; double-click repeats it, Delete or right click removes one`;
