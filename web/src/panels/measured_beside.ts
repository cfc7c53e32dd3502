import type { Answer, Asked } from '@knead/engine';
import { adviceOn } from '../document/words';
import { Checker, type FileQuery } from '../engine/checker';
import { KneadError } from '../engine/session_types';
import type { App } from './app';

const quick = 1500; // milliseconds: what took no longer is measured again by itself …
const rest = 1200; // … after so long without a change

/** Whether a run is still the last one, of the document that it has begun with. */
type Stands = () => boolean;

/** What is measured of the whole document as it would be saved, beside the session in a worker, and drawn in its views. */
export abstract class MeasuredBeside {
  failed = '';
  busy = false;
  /** Counts what panels show. */
  version = 0;

  private open = false;
  private session = -1;
  /** The document as it was saved to be measured, and how many shapes the session had had by then. */
  private saved: Uint8Array | null = null;
  private shapes = -1;
  private begun = 0; // when the worker was asked last, and how long it took
  private took = Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private run = {};
  private drawn: unknown[] = [];
  private readonly checker = new Checker(() => new Worker(new URL('../engine/check_worker.ts', import.meta.url), { type: 'module' }));

  constructor(protected readonly app: App) {
    app.onChange.push(() => this.keepUp());
    app.client.acts.onShapes.push(() => {
      if (this.open) app.changed();
    });
  }

  /** Something has been found. */
  protected abstract get found(): boolean;
  /** There is something to measure. */
  protected get ready(): boolean {
    return true;
  }
  /** Asks the engine; an error drops what was found. */
  protected abstract find(stands: Stands): Promise<void>;
  /** What takes longer, and need not be there at once. */
  protected async findMore(_stands: Stands): Promise<void> {}
  protected abstract drop(): void;
  /** Another document is there. */
  protected leave(): void {}
  protected close(): void {}
  /** What decides how it is drawn. */
  protected abstract get look(): unknown[];
  protected abstract paint(): void;

  protected get fresh(): boolean {
    return this.shapes === this.app.client.acts.shapes;
  }
  /** The shapes are others than those that were measured. */
  get stale(): boolean {
    return (this.found || this.failed !== '') && !this.fresh;
  }

  set shown(open: boolean) {
    if (open === this.open) return;
    this.open = open;
    if (!open) {
      this.stop();
      this.close();
      if (this.stale) this.forget();
    }
    this.draw();
  }
  get shown(): boolean {
    return this.open;
  }

  /** What is under way is of no use any more; the memory of the worker is free. */
  protected stop(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.busy = false;
    this.run = {};
    this.checker.end();
  }

  protected forget(): void {
    this.drop();
    Object.assign(this, { failed: '', saved: null, shapes: -1, took: Infinity });
    ++this.version;
    this.draw();
  }

  /** What was asked is something else now, of the same document. */
  protected again(): void {
    if (this.busy || this.timer !== undefined) this.stop();
    const { saved, shapes } = this;
    this.forget();
    Object.assign(this, { saved, shapes });
    this.app.changed();
  }

  protected tell(): void {
    ++this.version;
    this.draw();
    this.app.changed();
  }

  private keepUp(): void {
    const { app } = this;
    if (this.session !== app.documents.sessions) {
      this.session = app.documents.sessions;
      this.stop();
      this.leave();
      this.forget();
    }
    this.draw();
    if (!this.open || this.busy || this.timer !== undefined || !this.ready || !app.state) return;
    const first = !this.found && !this.failed;
    if (!first && !(this.stale && this.took < quick)) return;
    const { shapes } = app.client.acts;
    this.timer = setTimeout(() => {
      this.timer = undefined;
      if (!this.open) return;
      if (app.hand.active || app.playing() || shapes !== app.client.acts.shapes) this.keepUp();
      else void this.measure();
    }, first ? 0 : rest);
  }

  /** Of the document as it is now. */
  async measure(): Promise<void> {
    if (this.busy) this.stop();
    this.busy = true;
    this.failed = '';
    const stands = this.begin();
    this.tell();
    try {
      await this.find(stands);
      if (!stands()) return;
      this.took = performance.now() - this.begun;
      await this.findMore(stands);
    } catch (error) {
      if (!stands()) return;
      this.drop();
      this.failed = wordsOf(error);
    }
    if (!stands()) return;
    this.busy = false;
    this.tell();
  }

  protected begin(): Stands {
    const { session } = this, run = (this.run = {});
    return () => run === this.run && session === this.app.documents.sessions;
  }

  /** What the engine answers of the document as it is now; null if that is of no use any more. */
  protected async ask<Q extends FileQuery>(query: Q, request: Asked<Q>[0], stands: Stands = this.begin()): Promise<Answer<Q> | null> {
    const { app } = this;
    try {
      if (!this.saved || !this.fresh) {
        this.saved = null;
        const { file } = await app.client.query('save').finally(() => stands() && (this.shapes = app.client.acts.shapes));
        if (!stands()) return null;
        this.saved = file;
      }
      const name = app.documents.file?.kind === 'step' ? app.documents.file.name : app.documents.name;
      this.begun = performance.now();
      const answer = await this.checker.ask(query, this.saved, name, request);
      return stands() ? answer : null;
    } catch (error) {
      if (stands()) throw error;
      return null;
    }
  }

  /** The document is, by other ways, again as it was measured. */
  protected refresh(): void {
    this.saved = null;
    this.shapes = this.app.client.acts.shapes;
  }

  protected draw(): void {
    const now = this.look;
    if (now.every((x, k) => x === this.drawn[k])) return;
    this.drawn = now;
    this.paint();
  }
}

function wordsOf(error: unknown): string {
  if (!(error instanceof KneadError)) return error instanceof Error ? error.message : String(error);
  const { text, remedy } = adviceOn(error.info);
  return [text, remedy ?? ''].filter(Boolean).map((sentence) => sentence.replace(/[^.?!]$/, '$&.')).join(' ');
}
