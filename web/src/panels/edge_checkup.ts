import type { EdgeCheck, EdgeFault, EdgeMeasures } from '@knead/generated';
import { type EdgeOrder, isAbove, type Judging, type Measure, mostOf, ramp, rejudged, requestAgainst, requestOf, shareOf, thresholdsOf } from '../document/edge_checks';
import { type DrawnEdge, EdgeLines } from '../view/edge_lines';
import { MeasuredBeside } from './measured_beside';

/** Between amber and violet; `share` from 0 to 1. */
function colourAt(share: number): string {
  const at = Math.max(0, Math.min(1, share)) * (ramp.length - 1), k = Math.min(ramp.length - 2, Math.floor(at));
  const part = (colour: string, d: number) => parseInt(colour.slice(1 + 2 * d, 3 + 2 * d), 16);
  return `#${[0, 1, 2].map((d) => Math.round(part(ramp[k]!, d) + (at - k) * (part(ramp[k + 1]!, d) - part(ramp[k]!, d))).toString(16).padStart(2, '0')).join('')}`;
}

/** The edges of the whole document as it would be saved: measured beside the session, drawn in its views. */
export class EdgeCheckup extends MeasuredBeside {
  report: EdgeCheck | null = null;
  /** What is worse than as opened; null as long as that is not known. */
  worse: readonly EdgeFault[] | null = null;
  judging: Judging = { grade: 'b', gap: null, angle: null, curvature: null, unit: 'mm' };
  order: EdgeOrder = 'worst';
  kind = 'all';
  chosen: string | null = null;
  /** What colours the edges; null: nothing. */
  colour: Measure | null = 'gap';
  readonly lines = new EdgeLines(this.app.viewer);

  protected get found(): boolean {
    return this.report !== null;
  }
  protected drop(): void {
    this.report = this.worse = null;
  }
  protected override close(): void {
    this.mark(null);
  }
  protected override leave(): void {
    this.chosen = null;
    this.lines.mark(null);
    this.kind = 'all';
  }

  protected async find(stands: () => boolean): Promise<void> {
    const report = await this.ask('check', requestOf(this.judging, this.app.viewer.unit), stands);
    if (report) this.show(report);
  }
  protected override async findMore(stands: () => boolean): Promise<void> {
    const { app, report } = this;
    const opened = app.state?.undo && report!.edges.length > 0 ? await app.documents.opened() : null;
    if (!opened || !stands()) return;
    const check = await this.ask('check', requestAgainst(report!, opened), stands);
    if (check) this.worse = check.faults;
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

  protected get look(): unknown[] {
    return [this.shown && this.report, this.colour];
  }
  protected paint(): void {
    const { report, colour, lines } = this;
    if (!this.shown || !report || !colour) return lines.show([]);
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
