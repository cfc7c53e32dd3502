import { KneadError } from '../../engine/session_types';
import type { App } from '../app';
import { change, type Change, type Direct, type Direction, withDegree } from './knots';
import type { Basis, Curves, Gramians, LabModule } from './module';
import { readDirections } from './surface';

/** What the pointer or the keyboard is on: a function, or an entry of the Gramian. */
export interface Highlight {
  i: number;
  j: number;
}

export type What = 'knots' | 'order' | 'gramian' | 'highlight' | 'times' | 'surface';

const settleTime = 250; // milliseconds without an edit, after which times are measured
const budget = 0.005; // seconds per method

/** The knots in the panel, and everything that the module computes from them. */
export class LabModel {
  direction: Direction = 'u';
  order = 0;
  a = 1;
  b = 1;
  /** The surface's knots; null if there is no surface. */
  surface: { name: string; unit: string; rational: boolean; directions: Record<Direction, Direct> } | null = null;
  now: Direct = { degree: 3, knots: [0, 0, 0, 0, 0.2, 0.4, 0.6, 0.8, 1, 1, 1, 1] };
  basis: Basis;
  curves: Curves;
  gramians: Gramians;
  /** Seconds per method; null until measured. */
  times: number[] | null = null;
  highlight: Highlight | null = null;
  /** Index of the knot that was last touched. */
  active = -1;
  error = '';
  /** Width of the plot, in pixels. */
  pixels = 600;

  readonly onChange: ((what: Set<What>) => void)[] = [];
  private readonly due = new Set<What>();
  private request = 0;
  private timer = 0;
  private reading: Promise<void> | null = null;
  private shown = '';
  private closed = false;

  constructor(private readonly app: App, readonly module: LabModule) {
    this.basis = module.setKnots(this.now.degree, this.now.knots);
    this.curves = module.curves(this.order, this.pixels);
    this.gramians = module.gramians(this.a, this.b);
  }

  close(): void {
    this.closed = true;
    cancelAnimationFrame(this.request);
    clearTimeout(this.timer);
    this.onChange.length = 0;
  }

  // --- the surface -------------------------------------------------------------------------------------------------

  get original(): Direct | null {
    return this.surface?.directions[this.direction] ?? null;
  }

  get edited(): boolean {
    const from = this.original;
    return from !== null && !same(from, this.now);
  }

  get change(): Change {
    return this.original ? change(this.direction, this.original, this.now) : { kind: 'impossible', why: 'there is no surface' };
  }

  /** Reads the selected surface's knots again. Edits stay, unless another surface was selected. */
  async follow(): Promise<void> {
    this.reading ??= this.read().finally(() => (this.reading = null));
    return this.reading;
  }

  private async read(): Promise<void> {
    const { state } = this.app;
    const index = state?.selection[0] ?? 0;
    const info = state?.surfaces[index];
    if (!info) {
      this.surface = null;
      this.changed('surface');
      return;
    }
    const directions = await readDirections(this.app, index);
    if (this.closed) return;
    const untouched = !this.surface || !this.edited;
    const identity = `${this.app.documents.name} ${info.id}`;
    const other = identity !== this.shown;
    this.shown = identity;
    const was = this.original;
    this.surface = { name: info.name || info.id, unit: info.unit, rational: info.rational, directions };
    const is = directions[this.direction];
    if ((untouched || other) && (other || !was || !same(was, is) || !same(is, this.now))) this.edit(is);
    this.changed('surface');
  }

  reset(): void {
    if (this.original) this.edit(this.original);
  }

  async apply(): Promise<void> {
    const { change: todo } = this;
    if (todo.kind !== 'command') return;
    if (await this.app.execute([todo.command])) await this.follow();
  }

  turn(direction: Direction): void {
    this.direction = direction;
    this.reset();
    this.changed('surface', 'knots');
  }

  // --- edits -------------------------------------------------------------------------------------------------------

  /** Sets the knots. If they are not a knot vector, the previous ones stay and `error` says why. */
  edit(wanted: Direct): boolean {
    try {
      this.basis = this.module.setKnots(wanted.degree, wanted.knots);
    } catch (error) {
      this.refused(error);
      return false;
    }
    this.now = { degree: wanted.degree, knots: [...wanted.knots] };
    if (this.active >= wanted.knots.length) this.active = -1;
    if (this.highlight && Math.max(this.highlight.i, this.highlight.j) >= this.basis.count) this.highlight = null;
    this.error = '';
    this.changed('knots');
    return true;
  }

  setDegree(degree: number): void {
    this.edit(withDegree(this.now, degree));
    if (this.order > 2 * degree + 1) this.setOrder(degree);
  }

  setOrder(order: number): void {
    this.order = order;
    this.changed('order');
  }

  setGramian(a: number, b: number): void {
    [this.a, this.b] = [a, b];
    this.changed('gramian');
  }

  setPixels(pixels: number): void {
    if (Math.abs(pixels - this.pixels) < 2) return;
    this.pixels = pixels;
    this.changed('order');
  }

  show(highlight: Highlight | null): void {
    if (highlight?.i === this.highlight?.i && highlight?.j === this.highlight?.j) return;
    this.highlight = highlight;
    this.changed('highlight');
  }

  touch(knot: number): void {
    this.active = knot;
    this.changed('highlight');
  }

  private refused(error: unknown): void {
    if (!(error instanceof KneadError)) throw error;
    const { what, where, remedy } = error.info;
    this.error = [where && `${where}:`, what + (remedy ? ';' : ''), remedy].filter(Boolean).join(' ');
    this.changed('surface');
  }

  /** All listeners are notified once before the next picture, however much has changed by then. */
  changed(...what: What[]): void {
    for (const w of what) this.due.add(w);
    if (this.request === 0 && !this.closed) this.request = requestAnimationFrame(() => this.update());
  }

  private update(): void {
    this.request = 0;
    const what = new Set(this.due);
    this.due.clear();
    const knots = what.has('knots');
    if (knots || what.has('order')) this.curves = this.module.curves(this.order, this.pixels);
    if (knots || what.has('gramian')) {
      this.gramians = this.module.gramians(this.a, this.b);
      this.times = null;
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => {
        this.times = this.module.times(this.a, this.b, budget);
        this.changed('times');
      }, settleTime);
    }
    for (const draw of this.onChange) draw(what);
  }
}

const same = (x: Direct, y: Direct): boolean =>
  x.degree === y.degree && x.knots.length === y.knots.length && x.knots.every((k, i) => k === y.knots[i]);
