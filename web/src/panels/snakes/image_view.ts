import { h } from '../dom';
import { s, set } from '../lab/svg';
import type { SnakeModel } from './model';
import { type Place, thinned, type Volcano } from './script';

const near = 11; // pixels of the screen at which something is meant
const least = 6; // pixels of the screen below which a stroke or an ellipse is a click

type Grip =
  | { kind: 'stroke'; places: Place[] }
  | { kind: 'ellipse'; from: Place; to: Place }
  | { kind: 'point'; snake: number; point: number; begun: boolean }
  | { kind: 'spring'; snake: number; at: number; from: Place; to: Place }
  | { kind: 'kept'; snake: number; spring: number; to: Place }
  | { kind: 'volcano'; k: number; volcano: Volcano; at: Place; made: boolean; moved: boolean }
  | { kind: 'pan'; last: [number, number] };

/** The image with its snakes over it, and what the pointer does there. */
export class ImageView {
  private readonly canvas = h('canvas', { aria: { hidden: 'true' } });
  private readonly svg = s('svg', { class: 'snakes-lines', role: 'img', 'aria-label': 'Contours over the image' });
  readonly element = h('div', { class: 'snakes-view', tabIndex: 0, aria: { label: 'Image' } }, this.canvas);
  private readonly observer = new ResizeObserver(() => this.resize());
  /** Pixels of the screen per pixel of the image, and where the middle of the first pixel is. */
  private scale = 1;
  private origin: Place = [0, 0];
  private fitted = true;
  private grip: Grip | null = null;
  private readonly fingers = new Map<number, [number, number]>();
  private drawnImage: unknown = null;

  constructor(private readonly model: SnakeModel) {
    this.element.append(this.svg);
    this.observer.observe(this.element);
    model.onChange.push(() => this.draw());
    const { element } = this;
    element.addEventListener('pointerdown', (e) => this.down(e));
    element.addEventListener('pointermove', (e) => this.moved(e));
    element.addEventListener('pointerup', (e) => this.up(e));
    element.addEventListener('pointercancel', (e) => this.up(e, true));
    element.addEventListener('contextmenu', (e) => e.preventDefault());
    element.addEventListener('wheel', (e) => {
      e.preventDefault();
      this.zoom(Math.exp(-e.deltaY / 400), this.screen(e));
    }, { passive: false });
  }

  close(): void {
    this.observer.disconnect();
  }

  get busy(): boolean {
    return this.grip !== null;
  }

  fit(): void {
    const { image } = this.model, { clientWidth, clientHeight } = this.element;
    this.fitted = true;
    if (!image || clientWidth === 0) return;
    const { width, height } = image.pixels;
    this.scale = Math.min((clientWidth - 24) / width, (clientHeight - 24) / height);
    this.origin = [(clientWidth - (width - 1) * this.scale) / 2, (clientHeight - (height - 1) * this.scale) / 2];
    this.draw();
  }

  zoom(factor: number, [x, y]: Place = [this.element.clientWidth / 2, this.element.clientHeight / 2]): void {
    const next = Math.min(200, Math.max(0.02, this.scale * factor)), by = next / this.scale;
    this.scale = next;
    this.origin = [x + (this.origin[0] - x) * by, y + (this.origin[1] - y) * by];
    this.fitted = false;
    this.draw();
  }

  /** Takes back what is under way. */
  cancel(): void {
    const { grip, model } = this;
    this.grip = null;
    if (grip?.kind === 'spring') void model.letGo();
    this.draw();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element, ratio = devicePixelRatio;
    [this.canvas.width, this.canvas.height] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    set(this.svg, { viewBox: `0 0 ${clientWidth} ${clientHeight}`, width: clientWidth, height: clientHeight });
    if (this.fitted) this.fit();
    this.draw();
  }

  // --- drawing -----------------------------------------------------------------------------------------------------

  private at([x, y]: readonly [number, number]): Place {
    return [this.origin[0] + x * this.scale, this.origin[1] + y * this.scale];
  }

  private draw(): void {
    const { image, energy } = this.model;
    const what = `${image?.name ?? ''} ${energy !== null} ${this.scale} ${this.origin.join()} ${this.canvas.width} ${this.canvas.height}`;
    if (what !== this.drawnImage || energy) {
      this.drawnImage = what;
      const context = this.canvas.getContext('2d')!, ratio = devicePixelRatio;
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      context.clearRect(0, 0, this.canvas.width, this.canvas.height);
      if (image) {
        context.imageSmoothingEnabled = this.scale < 3;
        const [x, y] = this.at([-0.5, -0.5]);
        context.drawImage(energy ?? image.bitmap, x, y, image.pixels.width * this.scale, image.pixels.height * this.scale);
      }
    }
    this.drawLines();
  }

  private drawLines(): void {
    const { model, grip } = this, { snakes, script, selected } = model;
    const all: Node[] = [];
    snakes.states.forEach(({ closed }, k) => {
      let d = '';
      for (let i = snakes.offsets[k]!; i < snakes.offsets[k + 1]!; ++i) {
        const [x, y] = this.at([snakes.points[3 * i]!, snakes.points[3 * i + 1]!]);
        d += `${d === '' ? 'M' : 'L'}${x.toFixed(1)} ${y.toFixed(1)}`;
      }
      d += closed ? 'Z' : '';
      all.push(s('path', { class: 'snake-halo', d }), s('path', { class: k === selected ? 'snake on' : 'snake', d, 'data-snake': k }));
    });
    if (model.tool === 'points' && snakes.states.length > 0) {
      for (let i = snakes.netFrom[selected]!; i < snakes.netFrom[selected + 1]!; ++i) {
        const [cx, cy] = this.at([snakes.net[2 * i]!, snakes.net[2 * i + 1]!]);
        all.push(s('rect', { class: 'snake-point', x: cx - 3.5, y: cy - 3.5, width: 7, height: 7 }));
      }
    }
    script.snakes.forEach(({ springs = [] }, k) => springs.forEach((spring, i) => {
      const held = grip?.kind === 'kept' && grip.snake === k && grip.spring === i ? grip.to : spring.to;
      all.push(...this.springLine(this.placeOn(k, spring.at), held));
    }));
    if (grip?.kind === 'spring') all.push(...this.springLine(this.placeOn(grip.snake, grip.at), grip.to));
    const held = grip?.kind === 'volcano' ? grip : null;
    [...script.volcanoes, ...(held?.made ? [held.volcano] : [])].forEach((v, k) => {
      const [cx, cy] = this.at(held?.k === k ? held.at : v.at);
      all.push(s('circle', { class: 'volcano-reach', cx, cy, r: Math.max(8, v.radius * this.scale) }), s('path', { class: 'volcano', d: `M${cx} ${cy - 6}l6 11h-12z` }));
    });
    if (grip?.kind === 'stroke') all.push(s('path', { class: 'snake-draft', d: grip.places.map((p, k) => `${k === 0 ? 'M' : 'L'}${this.at(p).join(' ')}`).join('') + (model.closed ? 'Z' : '') }));
    if (grip?.kind === 'ellipse') {
      const [a, b] = [this.at(grip.from), this.at(grip.to)];
      all.push(s('ellipse', { class: 'snake-draft', cx: (a[0] + b[0]) / 2, cy: (a[1] + b[1]) / 2, rx: Math.abs(a[0] - b[0]) / 2, ry: Math.abs(a[1] - b[1]) / 2 }));
    }
    this.svg.replaceChildren(...all);
  }

  private springLine(from: Place, to: Place): Node[] {
    const [[x1, y1], [cx, cy]] = [this.at(from), this.at(to)];
    return [s('line', { class: 'spring', x1, y1, x2: cx, y2: cy }), s('circle', { class: 'spring-end', cx, cy, r: 5 })];
  }

  /** The point of a contour at a fraction of its parameter, as it is drawn. */
  private placeOn(k: number, at: number): Place {
    const { points, offsets } = this.model.snakes;
    let nearest = offsets[k] ?? 0;
    for (let i = nearest; i < (offsets[k + 1] ?? 0); ++i) if (Math.abs(points[3 * i + 2]! - at) < Math.abs(points[3 * nearest + 2]! - at)) nearest = i;
    return [points[3 * nearest] ?? 0, points[3 * nearest + 1] ?? 0];
  }

  // --- the pointer -------------------------------------------------------------------------------------------------

  private screen(e: { clientX: number; clientY: number }): Place {
    const box = this.element.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  private place(e: { clientX: number; clientY: number }): Place {
    const [x, y] = this.screen(e);
    return [(x - this.origin[0]) / this.scale, (y - this.origin[1]) / this.scale];
  }

  private down(e: PointerEvent): void {
    const { model } = this;
    if (!model.image) return;
    this.element.setPointerCapture(e.pointerId);
    this.element.focus({ preventScroll: true });
    if (e.pointerType === 'touch') {
      this.fingers.set(e.pointerId, this.screen(e));
      if (this.fingers.size > 1) this.cancel(); // two fingers move the image
      if (this.fingers.size > 1) return;
    }
    if (e.button !== 0) this.grip = { kind: 'pan', last: this.screen(e) };
    else if (model.tool === 'draw') this.grip = { kind: 'stroke', places: [this.place(e)] };
    else if (model.tool === 'ellipse') this.grip = { kind: 'ellipse', from: this.place(e), to: this.place(e) };
    else if (model.tool === 'volcano') this.grip = this.volcanoAt(e);
    else this.grip = this.pointAt(e) ?? { kind: 'pan', last: this.screen(e) };
    if (this.grip.kind === 'spring') void model.pull(this.grip.snake, this.grip.at, this.grip.to, true);
    this.draw();
  }

  private moved(e: PointerEvent): void {
    if (this.fingers.has(e.pointerId)) {
      if (this.fingers.size === 2) return this.pinch(e);
      this.fingers.set(e.pointerId, this.screen(e));
    }
    const { grip, model } = this;
    if (!grip) return;
    const place = this.place(e);
    if (grip.kind === 'stroke') {
      for (const each of e.getCoalescedEvents?.() ?? [e]) grip.places.push(this.place(each));
      if ((e.getCoalescedEvents?.() ?? []).length === 0) grip.places.push(place);
    } else if (grip.kind === 'ellipse') {
      const [dx, dy] = [place[0] - grip.from[0], place[1] - grip.from[1]], both = Math.max(Math.abs(dx), Math.abs(dy));
      grip.to = e.shiftKey ? [grip.from[0] + Math.sign(dx) * both, grip.from[1] + Math.sign(dy) * both] : place;
    } else if (grip.kind === 'point') {
      void model.move(grip.snake, grip.point, place, !grip.begun);
      grip.begun = true;
    } else if (grip.kind === 'spring') {
      grip.to = place;
      void model.pull(grip.snake, grip.at, place, false);
    } else if (grip.kind === 'kept') grip.to = place;
    else if (grip.kind === 'volcano') {
      grip.at = place;
      grip.moved = true;
    } else {
      const now = this.screen(e);
      this.origin = [this.origin[0] + now[0] - grip.last[0], this.origin[1] + now[1] - grip.last[1]];
      this.fitted = false;
      grip.last = now;
    }
    this.draw();
  }

  private up(e: PointerEvent, cancelled = false): void {
    this.fingers.delete(e.pointerId);
    const { grip, model } = this;
    this.grip = null;
    if (!grip) return;
    if (cancelled) {
      this.grip = grip;
      this.cancel();
    } else if (grip.kind === 'stroke') {
      const points = thinned(grip.places, Math.max(0.5, 2 / this.scale));
      if (this.extent(points) >= least) void model.add({ shape: 'points', points, closed: model.closed, ...(model.closed || model.holdEnds ? {} : { hold_ends: false }) });
    } else if (grip.kind === 'ellipse') {
      const radii: Place = [Math.abs(grip.from[0] - grip.to[0]) / 2, Math.abs(grip.from[1] - grip.to[1]) / 2];
      if (Math.min(...radii) * this.scale >= least / 2) {
        void model.add({ shape: 'ellipse', centre: [(grip.from[0] + grip.to[0]) / 2, (grip.from[1] + grip.to[1]) / 2], radii, closed: true });
      }
    } else if (grip.kind === 'spring') void this.letGo(grip);
    else if (grip.kind === 'kept') {
      const springs = model.script.snakes[grip.snake]!.springs ?? [];
      void model.setSprings(grip.snake, springs.map((spring, k) => (k === grip.spring ? { ...spring, to: grip.to } : spring)));
    } else if (grip.kind === 'volcano') {
      const { volcanoes } = model.script;
      const stays = grip.made || grip.moved; // a click on one takes it away
      const others = volcanoes.filter((_, k) => k !== grip.k);
      if (stays) others.splice(grip.k, 0, { ...grip.volcano, at: grip.at });
      void model.setVolcanoes(others);
    }
    this.draw();
  }

  private async letGo({ snake, at, to, from }: Extract<Grip, { kind: 'spring' }>): Promise<void> {
    const { model } = this, stays = model.keepSprings && Math.hypot(to[0] - from[0], to[1] - from[1]) * this.scale >= least;
    if (stays) await model.letGo(snake, [...(model.script.snakes[snake]!.springs ?? []), { at, to, strength: model.spring }]);
    else await model.letGo();
  }

  /** Largest side of what places cover, pixels of the screen. */
  private extent(places: readonly Place[]): number {
    const side = (d: 0 | 1) => Math.max(...places.map((p) => p[d])) - Math.min(...places.map((p) => p[d]));
    return Math.max(side(0), side(1)) * this.scale;
  }

  private away(e: PointerEvent, place: Place): number {
    const [x, y] = this.screen(e), [px, py] = this.at(place);
    return Math.hypot(px - x, py - y);
  }

  private volcanoAt(e: PointerEvent): Grip {
    const { model } = this, { volcanoes } = model.script;
    const k = volcanoes.findIndex((v) => this.away(e, v.at) < near);
    if (k >= 0) return { kind: 'volcano', k, volcano: volcanoes[k]!, at: volcanoes[k]!.at, made: false, moved: false };
    const at = this.place(e), { width, height } = model.image!.pixels;
    const volcano = { at, strength: model.volcano, radius: Math.max(2, Math.round(Math.min(width, height) / 20)) };
    return { kind: 'volcano', k: volcanoes.length, volcano, at, made: true, moved: false };
  }

  /** What is under the pointer: the end of a spring, a control point of the selected snake, or a contour. */
  private pointAt(e: PointerEvent): Grip | null {
    const { model } = this, { snakes, script, selected } = model;
    for (const [k, { springs = [] }] of model.tool === 'pull' ? script.snakes.entries() : []) {
      const spring = springs.findIndex((one) => this.away(e, one.to) < near);
      if (spring >= 0) return { kind: 'kept', snake: k, spring, to: springs[spring]!.to };
    }
    let [best, distance] = [-1, near as number];
    for (let i = snakes.netFrom[selected] ?? 0; i < (snakes.netFrom[selected + 1] ?? 0); ++i) {
      const d = this.away(e, [snakes.net[2 * i]!, snakes.net[2 * i + 1]!]);
      if (d < distance) [best, distance] = [i, d];
    }
    if (best >= 0 && model.tool === 'points') return { kind: 'point', snake: selected, point: best - snakes.netFrom[selected]!, begun: false };
    [best, distance] = [-1, 1.5 * near];
    for (let i = 0; i < snakes.points.length / 3; ++i) {
      const d = this.away(e, [snakes.points[3 * i]!, snakes.points[3 * i + 1]!]);
      if (d < distance) [best, distance] = [i, d];
    }
    if (best < 0) return null;
    const snake = snakes.offsets.findIndex((from, k) => from <= best && best < (snakes.offsets[k + 1] ?? 0));
    model.selected = snake;
    model.changed();
    const place = this.place(e);
    if (model.tool === 'points') return { kind: 'pan', last: this.screen(e) };
    return { kind: 'spring', snake, at: snakes.points[3 * best + 2]!, from: place, to: place };
  }

  private pinch(e: PointerEvent): void {
    const [other] = [...this.fingers].filter(([id]) => id !== e.pointerId).map(([, p]) => p);
    const before = this.fingers.get(e.pointerId)!, now = this.screen(e);
    this.fingers.set(e.pointerId, now);
    if (!other) return;
    const length = (p: Place) => Math.hypot(p[0] - other[0], p[1] - other[1]);
    this.zoom(length(now) / Math.max(1, length(before)), [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2]);
    this.origin = [this.origin[0] + (now[0] - before[0]) / 2, this.origin[1] + (now[1] - before[1]) / 2];
    this.draw();
  }
}
