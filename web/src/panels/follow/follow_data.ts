import { type DeviationRequest, type MorphCommand, morphPhases } from '@knead/generated';
import { byField, type DataFile, dataFile, type DataKind, textOf, withFile } from '../../document/data_files';
import { blended, coloursAt, type Deviations, deviationsOf, distancesAt, type Grid, placesAt, sampledAt, shortAbove, sorted, targetsOf } from '../../document/deviations';
import type { Command, Picture } from '../../engine/session_types';
import { DataPoints } from '../../view/data_points';
import { MeasuredBeside } from '../measured_beside';

/** How data are understood. */
export interface FollowSettings {
  align: boolean;
  /** Lengths of the file; null: what the engine takes. */
  reach: number | null;
  noise: number | null;
  tolerance: number | null;
  /** Times the control points, at most. */
  refine: number | null;
  /** Ids of surfaces: these alone move, none: all; these stay. */
  faces: readonly string[];
  keep: readonly string[];
  /** Of the data; empty: that of the file. */
  unit: string;
  /** Only the part of displacements along the normal. */
  normal: boolean;
  /** Of VTK: the vector field; of CSV: six columns. Empty: what the engine takes. */
  field: string;
  columns: string;
  /** Of parts in several places, by their numbers: the one that the data are about; empty: nobody has said. */
  place: Readonly<Record<number, string>>;
}

const usual: FollowSettings = {
  align: false, reach: null, noise: null, tolerance: null, refine: null, faces: [], keep: [], unit: '', normal: false, field: '', columns: '', place: {},
};
/** How faces follow: the comparison is the same. */
const later = ['noise', 'tolerance', 'refine'] as const;

/** The document before and after it has followed the data. */
interface Followed {
  scale: number;
  /** The shapes that the session had had by then. */
  shapes: number;
  /** By the ids of surfaces, as they were drawn. */
  before: Map<string, Grid>;
  /** What was left of the distances at the points of the data; null as long as it is not known. */
  left: Float64Array | null;
}

/** Data that the faces of the document follow: compared with it beside the session, drawn in its views, followed by a command. */
export class FollowData extends MeasuredBeside {
  files: readonly DataFile[] = [];
  kind: DataKind = 'scan';
  settings = { ...usual };
  /** Of the document before it follows. */
  deviations: Deviations | null = null;
  morphing = false;
  /** Of the displacements. */
  scale = 1;
  /** From before, 0, to after, 1. */
  part = 1;
  /** Where the colours end; null: at 95 % of the points. */
  limit: number | null = null;
  followed: Followed | null = null;
  /** Opens the panel. */
  reveal: () => void = () => {};

  private most = 0; // the usual end of the colours
  private deaths = 0;
  private readonly points = new DataPoints(this.app.viewer);

  protected get found(): boolean {
    return this.deviations !== null;
  }
  protected override get ready(): boolean {
    return !this.morphing && this.files.length > 0 && !this.waits;
  }
  override get stale(): boolean {
    return super.stale && !this.done;
  }
  /** The document has followed the data, and is as it was then. */
  get done(): Followed | null {
    return this.followed?.shapes === this.app.client.acts.shapes ? this.followed : null;
  }
  /** The second mesh of a pair is missing. */
  get waits(): boolean {
    return this.files.length > 0 && byField(this.files, this.kind, (b) => b) === null;
  }

  protected drop(): void {
    Object.assign(this, { deviations: null, known: null, followed: null, part: 1 });
  }
  protected override leave(): void {
    const { deaths } = this.app.client;
    // Where the engine has stopped, the session is the same one in another engine: the data stay.
    if (this.deaths === deaths) Object.assign(this, { files: [], scale: 1, limit: null, settings: { ...usual } });
    this.deaths = deaths;
  }

  /** A file of data, dropped or chosen. */
  async add(file: File): Promise<void> {
    const next = dataFile(file.name, new Uint8Array(await file.arrayBuffer()));
    Object.assign(this, withFile(this.files, this.kind, next), { limit: null, scale: 1 });
    Object.assign(this.settings, { align: this.settings.align && this.kind === 'scan', field: '', columns: '', noise: null, tolerance: null });
    this.again();
    this.reveal();
  }

  /** The data are something else than they seem to be. */
  be(kind: DataKind): void {
    this.kind = kind;
    if (kind !== 'pair') this.files = this.files.slice(0, 1);
    this.settings.align &&= kind === 'scan';
    this.again();
  }

  set(change: Partial<FollowSettings>): void {
    Object.assign(this.settings, change);
    if (Object.keys(change).some((name) => !(later as readonly string[]).includes(name))) this.again();
    else this.tell();
  }

  /** What is shown, without asking the engine. */
  show(change: Partial<Pick<FollowData, 'scale' | 'part' | 'limit'>>): void {
    Object.assign(this, change);
    this.tell();
  }

  private get asked(): Omit<DeviationRequest, 'scan' | 'vectors' | 'from' | 'to'> {
    const { align, reach, unit, normal, field, columns, faces, keep } = this.settings;
    const place = Object.values(this.settings.place).filter(Boolean);
    return {
      ...(align ? { align } : {}), ...(reach === null ? {} : { reach }), ...(unit ? { unit } : {}), ...(normal ? { along: 'normal' as const } : {}),
      ...(field ? { field } : {}), ...(columns ? { columns: columns.split(/[,;]/).map((name) => name.trim()) } : {}),
      ...(place.length > 0 ? { place } : {}), ...(faces.length > 0 ? { faces: [...faces] } : {}), ...(keep.length > 0 ? { keep: [...keep] } : {}),
    };
  }

  override async measure(): Promise<void> {
    if (!this.ready) return;
    this.followed = null;
    this.part = 1;
    await super.measure();
  }
  protected async find(stands: () => boolean): Promise<void> {
    const answer = await this.ask('deviation', { ...byField(this.files, this.kind, (bytes) => bytes), ...this.asked }, stands);
    if (!answer) return;
    this.deviations = deviationsOf(answer);
    this.most = shortAbove(answer.deviation.of_95);
  }

  /** The faces follow: one entry of the history. At another scale than before the last one is taken back. */
  async morph(): Promise<void> {
    const { app, deviations, scale } = this;
    const data = byField(this.files, this.kind, textOf);
    if (!data || !deviations || this.morphing || scale === 0) return;
    this.stop();
    this.morphing = true;
    this.tell();
    const { done } = this;
    if (done && !(await this.takeBack())) {
      this.morphing = false;
      return this.tell();
    }
    const before = done?.before ?? this.grids();
    const how = Object.fromEntries(later.flatMap((name) => (this.settings[name] === null ? [] : [[name, this.settings[name]]])));
    const command: MorphCommand = { do: 'morph', ...data, ...this.asked, ...how, ...(scale === 1 ? {} : { scale }) };
    app.client.phases = morphPhases;
    const ended = await app.execute([command as Command]).finally(() => (app.client.phases = []));
    this.followed = ended && { scale, shapes: app.client.acts.shapes, before, left: null };
    if (!ended) this.refresh(); // what was taken back is the document that was compared
    this.part = 1;
    if (this.followed) await app.attempt(() => this.complete(this.followed!, deviations));
    this.morphing = false;
    this.tell();
  }

  /** The document as it was before it followed; false where something was done since. */
  private async takeBack(): Promise<boolean> {
    const { app } = this;
    const commands = async () => (JSON.parse(await app.client.query('journal')) as Command[]).map((c) => c.do);
    const before = await commands(), morph = before.lastIndexOf('morph');
    if (before.slice(morph + 1).some((name) => name !== 'select')) {
      app.notify({ kind: 'info', topic: 'morph again', text: 'Something was done since the faces have followed.', remedy: 'Undo that first, or compare again: they follow from where they are.' });
      return false;
    }
    while ((await commands())[morph] === 'morph') {
      if (!(await app.execute([{ do: 'undo' }]))) return false;
    }
    return true;
  }

  /** Surfaces as they are drawn now, by id. */
  private grids(): Map<string, Grid> {
    const { frame } = this.app;
    return new Map(frame?.pictures.map(({ positions, normals, s, t }, k) => [frame.state.surfaces[k]!.id, { positions: positions.slice(), normals: normals.slice(), s: s.slice(), t: t.slice() }]));
  }

  /** Surfaces that were none before, as they were opened; and what is left of the distances. */
  private async complete(followed: Followed, of: Deviations): Promise<void> {
    const { app } = this;
    const { surfaces } = await app.client.query('state'); // the frame of it may be late
    for (const [surface, { id }] of surfaces.entries()) {
      if (!followed.before.has(id)) followed.before.set(id, await app.client.query('picture', { surface, detail: app.display.detail, opened: true }));
    }
    this.tell();
    const { scan, numbers } = targetsOf(of, followed.scale);
    const { place, faces, keep } = this.asked;
    const after = await this.ask('deviation', { scan, reach: of.info.reach, place, faces, keep });
    if (after) followed.left = sorted(deviationsOf(after), numbers, of.states.length);
  }

  private known: { of: readonly unknown[]; distances: Float64Array } | null = null;
  /** Of the points with a partner, as they are shown; NaN of the others. */
  get distances(): Float64Array {
    const { deviations, done, scale, part } = this;
    if (!deviations) return new Float64Array();
    const of = [deviations, scale, part, done?.left, done?.scale];
    if (this.known?.of.every((x, k) => x === of[k])) return this.known.distances;
    const distances = distancesAt(deviations, scale, done?.left ?? null, done?.scale ?? 1, part);
    this.known = { of, distances };
    return distances;
  }

  /** Where the colours end. */
  get ends(): number {
    return this.limit ?? (this.deviations ? this.most : 0);
  }

  protected override draw(): void {
    this.blend(); // frames draw the faces where they are
    super.draw();
  }
  protected get look(): unknown[] {
    const { deviations, scale, part, ends, done } = this;
    return [this.shown && this.files.length > 0 && deviations, scale, part, ends, done?.left, this.app.viewer.origin.join()];
  }
  protected paint(): void {
    const { deviations, scale, ends } = this;
    if (!this.shown || this.files.length === 0 || !deviations) return this.points.show(null);
    this.points.show(placesAt(deviations, scale, this.app.viewer.origin), coloursAt(this.distances, ends));
  }

  /** The frame and the share that the faces were blended by; null: they are drawn where they are. */
  private blends: readonly unknown[] | null = null;
  /** Surfaces before, on the grids of their present pictures. */
  private readonly sampled = new WeakMap<Picture, Pick<Grid, 'positions' | 'normals'>>();
  /** Draws the faces between before and after, and at other scales: displacements are linear. */
  private blend(): void {
    const { app, done } = this;
    const { frame } = app;
    const share = done ? (this.part * this.scale) / done.scale : 1;
    const away = this.shown && done !== null && share !== 1 ? [frame, share, done.before.size] : null;
    if (!frame || away?.every((x, k) => x === this.blends?.[k]) || (!away && !this.blends)) return;
    this.blends = away;
    frame.pictures.forEach((picture, k) => {
      const from = away && done!.before.get(frame.state.surfaces[k]!.id);
      if (away && !from) return;
      const before = from && (this.sampled.get(picture) ?? { positions: sampledAt(from, 'positions', picture), normals: sampledAt(from, 'normals', picture) });
      if (before) this.sampled.set(picture, before);
      const drawn = (of: 'positions' | 'normals') => (before ? blended(before[of], picture[of], share) : picture[of]);
      app.viewer.surfaces[k]?.drawAt(drawn('positions'), drawn('normals'));
    });
    app.viewer.redraw();
  }
}
