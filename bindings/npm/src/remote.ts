import { defineCommands, defineQueries, type PromisedQueries, type Working } from './commands.js';
import type { Beginning, FileOptions, PictureOptions, Report, Script, Snapshot, SurfaceShape } from './document.js';
import { KneadError, kneadError } from './errors.js';
import type { AnyCommand, BodyInfo, CommandMethods, DisplayInfo, Picture, SessionInfo, SurfaceInfo } from './generated.js';
import type { Answer, Call, Question } from './protocol.js';

/** A worker of the browser, or of Node. */
export interface Thread {
  post(question: Question): void;
  listen(answered: (answer: Answer) => void, failed: (error: KneadError) => void): void;
  end(): void;
  /** Whether it keeps a program running. */
  hold?(held: boolean): void;
}

export type Spawn = () => Thread;
export type Engine = WebAssembly.Module | Uint8Array;

interface Waiting {
  resolve(value: unknown): void;
  reject(error: unknown): void;
  told?: (done: number, total: number) => void;
}

export const stoppedWorker = (reason: string): KneadError =>
  kneadError('internal', `the worker has stopped (${reason})`, 'open the document again, or a snapshot of it');

/** A worker with a document, which must not know who uses it: it ends when nobody does. */
class Line {
  private readonly waiting = new Map<number, Waiting>();
  private next = 1;
  private readonly thread: Thread;
  /** The number of the call that is to stop. Without memory that threads share, null. */
  private readonly stop = typeof SharedArrayBuffer === 'undefined' ? null : new Int32Array(new SharedArrayBuffer(4));

  constructor(spawn: Spawn) {
    this.thread = spawn();
    this.thread.listen((answer) => this.answered(answer), (error) => this.fail(error));
  }

  get stoppable(): boolean {
    return this.stop !== null;
  }

  begin(engine: Engine, from: Beginning): Promise<unknown> {
    return this.ask({ call: 'begin', engine, from, stop: this.stop });
  }

  ask(call: Call, { progress, signal }: Working = {}): Promise<unknown> {
    const id = this.next++;
    const stop = () => {
      if (this.stop) Atomics.store(this.stop, 0, id);
    };
    return new Promise((resolve, reject) => {
      const told = progress && ((done: number, total: number) => {
        try {
          if (progress(done, total) === false) stop();
        } catch (error) {
          stop();
          reject(error);
        }
      });
      this.waiting.set(id, { resolve, reject, told });
      this.thread.hold?.(true);
      signal?.addEventListener('abort', stop, { once: true });
      this.thread.post({ ...call, id });
    }).finally(() => signal?.removeEventListener('abort', stop));
  }

  private answered(answer: Answer): void {
    const waiting = this.waiting.get(answer.id);
    if (!waiting) return;
    if ('total' in answer) return waiting.told?.(answer.done, answer.total);
    this.waiting.delete(answer.id);
    if (this.waiting.size === 0) this.thread.hold?.(false);
    if ('value' in answer) waiting.resolve(answer.value);
    else waiting.reject('info' in answer.error ? new KneadError(answer.error.info, answer.error.file, answer.error.line) : new Error(answer.error.message));
  }

  private fail(error: KneadError): void {
    for (const { reject } of this.waiting.values()) reject(error);
    this.waiting.clear();
    this.thread.hold?.(false);
  }

  end(): void {
    this.thread.end();
    this.fail(stoppedWorker('it was ended'));
  }
}

const forgotten = new FinalizationRegistry<{ line: Line }>((holder) => holder.line.end());

/** A surface of a document in a worker: what it returns is of the moment in which it is asked. */
export class RemoteSurface {
  constructor(private readonly document: RemoteDocument, readonly id: string, readonly label: string, readonly unit: string) {}

  private read<T>(member: string, ...given: unknown[]): Promise<T> {
    return this.document.read<T>(member, given, this.id);
  }

  get info(): Promise<SurfaceInfo> {
    return this.read('info');
  }

  get controlPoints(): Promise<Float64Array> {
    return this.read('controlPoints');
  }

  get shape(): Promise<SurfaceShape> {
    return this.read('shape');
  }

  picture(options: PictureOptions = {}): Promise<Picture> {
    return this.read('picture', options);
  }
}

/** Commands under way: more can be added, and all of them can be awaited. */
export class Chain implements PromiseLike<RemoteDocument> {
  /** @internal */
  constructor(readonly document: RemoteDocument, private readonly done: Promise<unknown>) {}

  then<A = RemoteDocument, B = never>(resolved?: ((document: RemoteDocument) => A | PromiseLike<A>) | null, rejected?: ((reason: unknown) => B | PromiseLike<B>) | null): Promise<A | B> {
    return this.done.then(() => this.document).then(resolved, rejected);
  }

  /** @internal After what is under way, if that succeeds. */
  and(act: () => Promise<unknown>): Chain {
    return new Chain(this.document, this.done.then(act));
  }
}

/** A document in a worker: `Document` with promises. The worker ends when nothing refers to the document any more. */
export class RemoteDocument {
  private readonly holder: { line: Line };

  private constructor(line: Line, private readonly spawn: Spawn, private readonly engine: Engine) {
    this.holder = { line };
    forgotten.register(this, this.holder);
  }

  /** @internal */
  static async begin(spawn: Spawn, engine: Engine, from: Beginning): Promise<RemoteDocument> {
    const line = new Line(spawn);
    try {
      await line.begin(engine, from);
    } catch (error) {
      line.end();
      throw error;
    }
    return new RemoteDocument(line, spawn, engine);
  }

  /** @internal */
  async read<T>(member: string, given: unknown[] = [], surface?: string): Promise<T> {
    const value = await this.holder.line.ask({ call: 'read', member, given, surface });
    return value as T;
  }

  /** @internal */
  async work(call: Call, working: Working): Promise<void> {
    const { signal } = working;
    signal?.throwIfAborted();
    if (!signal || this.holder.line.stoppable) await this.holder.line.ask(call, working);
    else await this.endable(call, working, signal);
    signal?.throwIfAborted();
  }

  /** Where a worker cannot be told to stop it is ended, and another one begins with what was there before. */
  private async endable(call: Call, working: Working, signal: AbortSignal): Promise<void> {
    const before = await this.snapshot();
    signal.throwIfAborted();
    const { line } = this.holder;
    const stop = () => line.end();
    signal.addEventListener('abort', stop, { once: true });
    try {
      await line.ask(call, working);
    } catch (error) {
      if (!signal.aborted) throw error;
      this.holder.line = new Line(this.spawn);
      await this.holder.line.begin(this.engine, before);
    } finally {
      signal.removeEventListener('abort', stop);
    }
  }

  run(script: Script, { name, ...working }: Working & { name?: string } = {}): Chain {
    return new Chain(this, this.work({ call: 'run', script, name, told: Boolean(working.progress) }, working));
  }

  get name(): Promise<string> {
    return this.read('name');
  }

  get script(): Promise<string> {
    return this.read('script');
  }

  get state(): Promise<SessionInfo> {
    return this.read('state');
  }

  get report(): Promise<Report> {
    return this.read('report');
  }

  get displays(): Promise<DisplayInfo[]> {
    return this.read('displays');
  }

  get bodies(): Promise<BodyInfo[]> {
    return this.read('bodies');
  }

  get surfaces(): Promise<RemoteSurface[]> {
    return this.read<RemoteSurface[]>('surfaces').then((all) => all.map(({ id, label, unit }) => new RemoteSurface(this, id, label, unit)));
  }

  async surface(key: string): Promise<RemoteSurface> {
    const { id, label, unit } = await this.read<RemoteSurface>('surface', [key]);
    return new RemoteSurface(this, id, label, unit);
  }

  save(name?: string, options?: Pick<FileOptions, 'schema'>): Promise<Uint8Array> {
    return this.read('save', [name, options]);
  }

  saveCompressed(name?: string, options?: Pick<FileOptions, 'schema'>): Promise<Uint8Array> {
    return this.read('saveCompressed', [name, options]);
  }

  export(name: string, options?: FileOptions): Promise<{ file: Uint8Array; leftOut: string[] }> {
    return this.read('export', [name, options]);
  }

  snapshot(): Promise<Snapshot> {
    return this.read('snapshot');
  }
}

const acted = (document: RemoteDocument, command: AnyCommand, working: Working) => () =>
  document.work({ call: 'act', command, told: Boolean(working.progress) }, working);

export interface RemoteDocument extends CommandMethods<Chain, Working>, PromisedQueries {}
defineCommands(RemoteDocument.prototype, (document: RemoteDocument, command, working) => new Chain(document, acted(document, command, working)()));
defineQueries(RemoteDocument.prototype, (document: RemoteDocument, name, request) => document.read(name, [request]));
export interface Chain extends CommandMethods<Chain, Working> {}
defineCommands(Chain.prototype, (chain: Chain, command, working) => chain.and(acted(chain.document, command, working)));
