import type { DeviationRequest, MorphCommand } from '@knead/generated';
import { byField, type DataFile, dataFile, type DataKind, textOf, withFile } from '../../document/data_files';
import { blended, colourAt, type Deviations, deviationsOf, distancesAt, type Grid, placesAt, sampledAt, shortAbove, sorted, targetsOf } from '../../document/deviations';
import { adviceOn } from '../../document/words';
import { Checker } from '../../engine/checker';
import { type Command, KneadError, type Picture } from '../../engine/session_types';
import { DataPoints } from '../../view/data_points';
import type { App } from '../app';

const quick = 1500; // milliseconds: what took no longer is compared again by itself …
const rest = 1200; // … after so long without a change
const leftOut = [0.5, 0.5, 0.5] as const; // the colour of points without a partner

/** How data are understood. */
export interface FollowSettings {
  align: boolean;
  /** Lengths of the file; null: what the engine takes. */
  reach: number | null;
  noise: number | null;
  /** Of the data; empty: that of the file. */
  unit: string;
  /** Only the part of displacements along the normal. */
  normal: boolean;
  /** Of VTK: the vector field; of CSV: six columns; of an assembly: which places the data are about. Empty: what the engine takes. */
  field: string;
  columns: string;
  place: string;
}

const usual: FollowSettings = { align: false, reach: null, noise: null, unit: '', normal: false, field: '', columns: '', place: '' };

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
export class FollowData {
  files: readonly DataFile[] = [];
  kind: DataKind = 'scan';
  settings = { ...usual };
  /** Of the document before it follows. */
  deviations: Deviations | null = null;
  failed = '';
  busy = false;
  morphing = false;
  /** Of the displacements. */
  scale = 1;
  /** From before, 0, to after, 1. */
  part = 1;
  /** Where the colours end; null: at 95 % of the points. */
  limit: number | null = null;
  followed: Followed | null = null;
  /** Counts what panels show. */
  version = 0;
  /** Opens the panel. */
  reveal: () => void = () => {};

  private most = 0; // the usual end of the colours
  private open = false;
  private session = -1;
  private deaths = 0;
  private shapes = -1;
  private took = Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private run = {};
  private readonly checker = new Checker(() => new Worker(new URL('../../engine/check_worker.ts', import.meta.url), { type: 'module' }));
  private readonly points: DataPoints;

  constructor(private readonly app: App) {
    this.points = new DataPoints(app.viewer);
    app.onChange.push(() => this.keepUp());
    const { acts } = app.client, told = acts.onShapes;
    acts.onShapes = () => {
      told();
      if (this.open) app.changed();
    };
  }

  get fresh(): boolean {
    return this.shapes === this.app.client.acts.shapes;
  }
  /** The shapes are others than those that were compared. */
  get stale(): boolean {
    return (this.deviations !== null || this.failed !== '') && !this.fresh && !this.done;
  }
  /** The document has followed the data, and is as it was then. */
  get done(): Followed | null {
    return this.followed?.shapes === this.app.client.acts.shapes ? this.followed : null;
  }
  /** The second mesh of a pair is missing. */
  get waits(): boolean {
    return this.files.length > 0 && byField(this.files, this.kind, (b) => b) === null;
  }

  set shown(open: boolean) {
    if (open === this.open) return;
    this.open = open;
    if (!open) this.stop();
    this.draw();
  }
  get shown(): boolean {
    return this.open;
  }

  private stop(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.busy = false;
    this.run = {};
    this.checker.end();
  }

  private forget(): void {
    Object.assign(this, { deviations: null, failed: '', shapes: -1, took: Infinity, followed: null, part: 1 });
  }

  private tell(): void {
    ++this.version;
    this.draw();
    this.app.changed();
  }

  private keepUp(): void {
    const { app } = this;
    if (this.session !== app.documents.sessions) {
      this.session = app.documents.sessions;
      this.stop();
      this.forget();
      // Where the engine has stopped, the session is the same one in another engine: the data stay.
      if (this.deaths === app.client.deaths) Object.assign(this, { files: [], scale: 1, limit: null, settings: { ...usual } });
      this.deaths = app.client.deaths;
      ++this.version;
    }
    this.draw(); // frames draw the faces where they are
    if (!this.open || this.busy || this.morphing || this.timer !== undefined || this.files.length === 0 || this.waits || !app.state) return;
    const first = !this.deviations && !this.failed;
    if (!first && !(this.stale && this.took < quick)) return;
    const { shapes } = app.client.acts;
    this.timer = setTimeout(() => {
      this.timer = undefined;
      if (!this.open) return;
      if (app.hand.active || app.playing() || shapes !== app.client.acts.shapes) this.keepUp();
      else void this.compare();
    }, first ? 0 : rest);
  }

  /** A file of data, dropped or chosen. */
  async add(file: File): Promise<void> {
    const next = dataFile(file.name, new Uint8Array(await file.arrayBuffer()));
    Object.assign(this, withFile(this.files, this.kind, next), { limit: null, scale: 1 });
    Object.assign(this.settings, { align: this.settings.align && this.kind === 'scan', field: '', columns: '', noise: null });
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
    if (Object.keys(change).some((name) => name !== 'noise')) this.again();
    else this.tell();
  }

  /** What is shown, without asking the engine. */
  show(change: Partial<Pick<FollowData, 'scale' | 'part' | 'limit'>>): void {
    Object.assign(this, change);
    this.tell();
  }

  private again(): void {
    this.stop();
    this.forget();
    this.tell();
  }

  private get asked(): Omit<DeviationRequest, 'scan' | 'vectors' | 'from' | 'to'> {
    const { align, reach, unit, normal, field, columns, place } = this.settings;
    const list = (text: string) => text.split(/[,;]/).map((name) => name.trim());
    return {
      ...(align ? { align } : {}), ...(reach === null ? {} : { reach }), ...(unit ? { unit } : {}), ...(normal ? { along: 'normal' as const } : {}),
      ...(field ? { field } : {}), ...(columns ? { columns: list(columns) } : {}), ...(place ? { place: list(place) } : {}),
    };
  }

  /** What the engine answers of the document as it is now; null if that is of no use any more. */
  private async ask(request: DeviationRequest): Promise<Deviations | null> {
    const { app, session } = this;
    const run = (this.run = {});
    const stands = () => run === this.run && session === app.documents.sessions;
    try {
      const { file } = await app.client.query('save').finally(() => stands() && (this.shapes = app.client.acts.shapes));
      if (!stands()) return null;
      const name = app.documents.file?.kind === 'step' ? app.documents.file.name : app.documents.name;
      const answer = await this.checker.ask('deviation', file, name, request);
      return stands() ? deviationsOf(answer) : null;
    } catch (error) {
      if (!stands()) return null;
      throw error;
    }
  }

  /** Of the document as it is now. */
  async compare(): Promise<void> {
    const data = byField(this.files, this.kind, (bytes) => bytes);
    if (!data) return;
    if (this.busy) this.stop();
    this.busy = true;
    this.failed = '';
    this.followed = null;
    this.part = 1;
    this.tell();
    const start = performance.now();
    try {
      const found = await this.ask({ ...data, ...this.asked });
      if (!found) return;
      this.deviations = found;
      this.most = shortAbove(found.info.deviation.of_95);
      this.took = performance.now() - start;
    } catch (error) {
      this.deviations = null;
      this.failed = wordsOf(error);
    }
    this.busy = false;
    this.tell();
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
    const { noise } = this.settings;
    const command: MorphCommand = { do: 'morph', ...data, ...this.asked, ...(noise === null ? {} : { noise }), ...(scale === 1 ? {} : { scale }) };
    const ended = await app.execute([command as Command]);
    this.followed = ended && { scale, shapes: app.client.acts.shapes, before, left: null };
    if (!ended) this.shapes = app.client.acts.shapes; // what was taken back is the document that was compared
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
    const { text, numbers } = targetsOf(of, followed.scale);
    const { place } = this.asked;
    const later = await this.ask({ scan: new TextEncoder().encode(text), reach: of.info.reach, ...(place ? { place } : {}) });
    if (later) followed.left = sorted(later, numbers, of.states.length);
  }

  /** Of the points with a partner, as they are shown; NaN of the others. */
  get distances(): Float64Array {
    const { deviations, done } = this;
    if (!deviations) return new Float64Array();
    return distancesAt(deviations, this.scale, done?.left ?? null, done?.scale ?? 1, this.part);
  }

  /** Where the colours end. */
  get ends(): number {
    return this.limit ?? (this.deviations ? this.most : 0);
  }

  private drawn: unknown[] = [];
  private draw(): void {
    this.blend();
    const { deviations, scale, part, ends, done } = this;
    const visible = this.open && deviations !== null && this.files.length > 0;
    const now = [visible && deviations, scale, part, ends, done?.left, this.app.viewer.origin.join()];
    if (now.every((x, k) => x === this.drawn[k])) return;
    this.drawn = now;
    if (!visible) return this.points.show(null);
    const distances = this.distances;
    const colours = new Float32Array(3 * distances.length);
    distances.forEach((d, k) => colours.set(Number.isNaN(d) ? leftOut : colourAt(d, ends), 3 * k));
    this.points.show(placesAt(deviations, scale), colours);
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
    const away = this.open && done !== null && share !== 1 ? [frame, share, done.before.size] : null;
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

function wordsOf(error: unknown): string {
  if (!(error instanceof KneadError)) return error instanceof Error ? error.message : String(error);
  const { text, remedy } = adviceOn(error.info);
  return [text, remedy].filter(Boolean).join(' ');
}
