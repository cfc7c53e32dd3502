import type { EdgeCheck, EdgeFault, EdgeMeasures } from '@knead/generated';
import { type EdgeOrder, isAbove, type Judging, type Measure, mostOf, ramp, rejudged, requestAgainst, requestOf, shareOf, thresholdsOf } from '../document/edge_checks';
import { adviceOn } from '../document/words';
import { Checker } from '../engine/checker';
import { KneadError } from '../engine/session_types';
import { type DrawnEdge, EdgeLines } from '../view/edge_lines';
import type { App } from './app';

const quick = 1500; // milliseconds: what took no longer is measured again by itself …
const rest = 1200; // … after so long without a change

/** Between amber and violet; `share` from 0 to 1. */
function colourAt(share: number): string {
  const at = Math.max(0, Math.min(1, share)) * (ramp.length - 1), k = Math.min(ramp.length - 2, Math.floor(at));
  const part = (colour: string, d: number) => parseInt(colour.slice(1 + 2 * d, 3 + 2 * d), 16);
  return `#${[0, 1, 2].map((d) => Math.round(part(ramp[k]!, d) + (at - k) * (part(ramp[k + 1]!, d) - part(ramp[k]!, d))).toString(16).padStart(2, '0')).join('')}`;
}

/** The edges of the whole document as it would be saved: measured beside the session, drawn in its views. */
export class EdgeCheckup {
  report: EdgeCheck | null = null;
  /** What is worse than as opened; null as long as that is not known. */
  worse: readonly EdgeFault[] | null = null;
  failed = '';
  busy = false;
  judging: Judging = { grade: 'b', gap: null, angle: null, curvature: null, unit: 'mm' };
  order: EdgeOrder = 'worst';
  kind = 'all';
  chosen: string | null = null;
  /** What colours the edges; null: nothing. */
  colour: Measure | null = 'gap';
  /** Counts what panels show. */
  version = 0;

  private open = false;
  private session = -1;
  /** The document as it was saved to be measured, and how many shapes the session had had by then. */
  private saved: Uint8Array | null = null;
  private shapes = -1;
  private took = Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private run = {};
  private readonly checker = new Checker(() => new Worker(new URL('../engine/check_worker.ts', import.meta.url), { type: 'module' }));
  readonly lines: EdgeLines;

  constructor(private readonly app: App) {
    this.lines = new EdgeLines(app.viewer);
    app.onChange.push(() => this.follow());
    app.client.acts.onShapes = () => {
      if (this.open) app.changed();
    };
  }

  private get fresh(): boolean {
    return this.shapes === this.app.client.acts.shapes;
  }

  /** The shapes are others than those that were measured. */
  get stale(): boolean {
    return (this.report !== null || this.failed !== '') && !this.fresh;
  }

  set shown(open: boolean) {
    if (open === this.open) return;
    this.open = open;
    if (!open) {
      this.stop();
      this.mark(null);
      if (this.stale) this.forget();
    }
    this.draw();
  }
  get shown(): boolean {
    return this.open;
  }

  /** What is under way is of no use any more. */
  private stop(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.busy = false;
    this.run = {};
    this.checker.end();
  }

  private forget(): void {
    Object.assign(this, { report: null, worse: null, failed: '', saved: null, shapes: -1, took: Infinity });
    ++this.version;
    this.draw();
  }

  private tell(): void {
    ++this.version;
    this.draw();
    this.app.changed();
  }

  private follow(): void {
    const { app } = this;
    if (this.session !== app.documents.sessions) {
      this.session = app.documents.sessions;
      this.stop();
      this.chosen = null;
      this.lines.mark(null);
      this.kind = 'all';
      this.forget();
    }
    if (!this.open || this.busy || this.timer !== undefined || !app.state) return;
    const first = !this.report && !this.failed;
    if (!first && !(this.stale && this.took < quick)) return;
    const { shapes } = app.client.acts;
    this.timer = setTimeout(() => {
      this.timer = undefined;
      if (!this.open) return;
      if (app.hand.active || app.playing() || shapes !== app.client.acts.shapes) this.follow();
      else void this.measure();
    }, first ? 0 : rest);
  }

  /** Of the document as it is now. */
  async measure(): Promise<void> {
    const { app, checker, session } = this;
    if (this.busy) this.stop();
    this.busy = true;
    this.failed = '';
    const run = (this.run = {});
    const stands = () => run === this.run && session === app.documents.sessions;
    this.tell();
    try {
      if (!this.saved || !this.fresh) {
        this.saved = null;
        const { file } = await app.client.query('save').finally(() => stands() && (this.shapes = app.client.acts.shapes));
        if (!stands()) return;
        this.saved = file;
      }
      const saved = this.saved!;
      const start = performance.now();
      const name = app.documents.file?.kind === 'step' ? app.documents.file.name : app.documents.name;
      const report = await checker.check(saved, name, requestOf(this.judging, app.viewer.unit));
      if (!stands()) return;
      this.took = performance.now() - start;
      this.show(report);
      const opened = app.state?.undo && report.edges.length > 0 ? await app.documents.opened() : null;
      const worse = opened && (await checker.check(saved, name, requestAgainst(report, opened))).faults;
      if (!stands()) return;
      this.worse = worse;
    } catch (error) {
      if (!stands()) return;
      this.report = this.worse = null;
      const advice = error instanceof KneadError ? adviceOn(error.info) : { text: error instanceof Error ? error.message : String(error) };
      this.failed = [advice.text, 'remedy' in advice ? advice.remedy : ''].filter(Boolean).join(' ');
    }
    this.busy = false;
    this.tell();
  }

  private show(report: EdgeCheck): void {
    this.report = report;
    this.worse = null;
    const chosen = report.edges.find(({ id }) => id === this.chosen);
    if (!chosen) this.chosen = null;
    this.lines.mark(chosen ? this.drawnOf(chosen, null) : null);
    this.tell();
  }

  /** The verdict by other limits is there at once, the kinds of edges by them once the engine has looked again. */
  judge(change: Partial<Judging>): void {
    Object.assign(this.judging, change);
    const { report, fresh } = this;
    const thresholds = report && fresh ? thresholdsOf(this.judging, report.unit) : null;
    if (thresholds) {
      this.report = rejudged(report!, thresholds);
      this.worse = null;
    }
    void this.measure();
  }

  set(change: Partial<Pick<EdgeCheckup, 'order' | 'kind' | 'colour'>>): void {
    Object.assign(this, change);
    this.tell();
  }

  /** Whether any measure of an edge is worse than as opened. */
  isWorse = (id: string, measure?: Measure): boolean => this.worse?.some((f) => f.edge === id && (!measure || f.measure === measure)) ?? false;

  private drawnOf(edge: EdgeMeasures, colour: string | null): DrawnEdge {
    return { faces: edge.faces, points: edge.course ?? [edge.start, edge.middle, edge.end], colour };
  }

  /** Zooms to an edge and marks it; once more, or null: no edge. */
  mark(edge: EdgeMeasures | null): void {
    const same = edge === null || edge.id === this.chosen;
    if (same && this.chosen === null) return;
    this.chosen = same ? null : edge.id;
    const drawn = same ? null : this.drawnOf(edge, null);
    this.lines.mark(drawn);
    if (drawn) this.lines.zoom(drawn);
    this.tell();
  }

  private drawn: unknown[] = [];
  private draw(): void {
    const { report, colour, lines } = this;
    const now = [this.open && report, colour];
    if (now.every((x, k) => x === this.drawn[k])) return;
    this.drawn = now;
    if (!this.open || !report || !colour) return lines.show([]);
    const most = mostOf(report, colour);
    lines.show(report.edges.filter((e) => e.kind !== 'unknown').map((e) => {
      const share = shareOf(report, e, colour, most);
      return this.drawnOf(e, share === null ? null : colourAt(share));
    }));
  }

  /** How many edges are above the limit of what colours them. */
  get loud(): number {
    const { report, colour } = this;
    return report && colour ? report.edges.filter((e) => isAbove(report, e, colour)).length : 0;
  }
}
