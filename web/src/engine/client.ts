import { Acts } from './acts';
import type { Context, Trim } from './context';
import type { DisplayInfo } from './displays';
import type { Answer, Asked, Query } from '@knead/engine';
import type { Frame, PictureSettings, Reply, Request, Snapshot } from './protocol';
import { type Command, KneadError, type EngineErrorInfo, errorOf } from './session_types';

interface Waiting {
  resolve(answer: unknown): void;
  reject(error: Error): void;
  /** When it was asked for. */
  since: number;
  request: Request;
}

/** Why there is another engine: the one before trapped or was ended, or the user stopped it. */
export type End = 'died' | 'stopped';


/** The page's end of the connection to the worker. */
export class Client {
  onFrame: (frame: Frame) => void = () => {};
  /** Errors that no request waits for. */
  onError: (error: EngineErrorInfo) => void = () => {};
  /** The engine has stopped, and another one, which holds nothing, is on its way. */
  onDeath: (end: End) => void = () => {};
  /** So many steps of the command under way are done. */
  onProgress: (done: number, total: number) => void = () => {};
  /** What the command under way does, one after the other: each is as many of its steps. None: they have no names. */
  phases: readonly string[] = [];
  /** Of the present engine. */
  ready: Promise<void>;
  /** How many engines there were before; how many of these the user has stopped. */
  deaths = 0;
  stops = 0;
  readonly acts = new Acts();
  /** What can colour surfaces; known once the engine is ready. */
  displays: readonly DisplayInfo[] = [];

  private readonly waiting = new Map<number, Waiting>();
  private next = 1;
  private live: { commands: () => Command[]; join: boolean } | null = null;
  private liveUnderWay: Promise<void> | null = null;
  private worker: Worker;
  private watch = new AbortController();

  constructor(private readonly makeWorker: () => Worker) {
    this.worker = makeWorker();
    this.ready = this.listen(this.worker);
  }

  private listen(worker: Worker): Promise<void> {
    let started = false;
    const ready = new Promise<void>((resolve) => {
      worker.onmessage = (event: MessageEvent<Reply>) => {
        const reply = event.data;
        if (reply.kind === 'ready') {
          started = true;
          this.displays = reply.displays;
          if (reply.lock) this.watchOver(worker, reply.lock);
          resolve();
        } else if (reply.kind === 'progress') this.onProgress(reply.done, reply.total);
        else if (reply.kind === 'frame') this.draw(reply.frame);
        else if (reply.kind === 'died') this.startAgain();
        else this.settle(reply);
      };
    });
    worker.onerror = (event) => {
      if (started) {
        this.startAgain();
        return;
      }
      const message = event.message || 'the engine could not be started';
      this.onError(errorOf('internal', message, 'reload the page'));
    };
    return ready;
  }

  /** The browser may end a worker without a word, where memory is short: its lock is free then. */
  private watchOver(worker: Worker, lock: string): void {
    const { signal } = (this.watch = new AbortController());
    const free = () => {
      if (!signal.aborted && worker === this.worker) this.startAgain();
    };
    void navigator.locks.request(lock, { signal }, free).catch(() => undefined);
  }

  /** Since when the request under way has been waiting; null without one. `performance.now()`. */
  get busySince(): number | null {
    const [first] = this.waiting.values();
    return first?.since ?? null;
  }

  /** Ends what the engine is doing, and the engine with it: what it has done before is done again in another one. */
  stopAll(): void {
    ++this.stops;
    this.startAgain('stopped');
  }

  /** What was asked of the engine before is answered by an error of the kind "died". */
  private startAgain(end: End = 'died'): void {
    this.watch.abort();
    this.worker.onmessage = this.worker.onerror = null;
    this.worker.terminate();
    ++this.deaths;
    this.acts.lose();
    this.live = null;
    const lost = [...this.waiting.values()];
    this.waiting.clear();
    this.worker = this.makeWorker();
    this.ready = this.listen(this.worker);
    const what = 'the engine stopped, and was started again';
    for (const { reject } of lost) reject(new KneadError(errorOf('died', what, '')));
    this.onDeath(end);
  }

  private draw(frame: Frame): void {
    if (frame.playing) this.acts.gap();
    this.onFrame(frame);
    // Request the next one once this one is on the screen; a hidden page draws nothing and must not hold up the session.
    if (document.hidden) setTimeout(() => this.send({ kind: 'drawn' }), 0);
    else requestAnimationFrame(() => this.send({ kind: 'drawn' }));
  }

  private settle(reply: Extract<Reply, { id: number }>): void {
    const waiting = this.waiting.get(reply.id);
    this.waiting.delete(reply.id);
    if (waiting) this.acts.settled(waiting.request, reply.kind === 'done');
    if (reply.kind === 'failed') {
      if (waiting) waiting.reject(new KneadError(reply.error));
      else this.onError(reply.error);
    } else waiting?.resolve(reply.answer);
  }

  private send(request: Request, id = 0): void {
    this.worker.postMessage({ id, request });
  }

  private ask<T = void>(request: Request): Promise<T> {
    const id = this.next++;
    return new Promise<T>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as Waiting['resolve'], reject, since: performance.now(), request });
      this.send(request, id);
    });
  }

  open = (bytes: Uint8Array, name: string, commands: Command[] = [], opened?: number) => this.ask({ kind: 'open', bytes, name, commands, opened });
  fresh = (name: string, commands: Command[], opened?: number) => this.ask({ kind: 'fresh', name, commands, opened });
  execute = (commands: Command[], join = false, opening = false) => this.ask({ kind: 'execute', commands, join, opening });
  pictures = (settings: PictureSettings) => this.ask({ kind: 'pictures', settings });
  play = (toRest = false) => this.ask({ kind: 'play', toRest });
  stop = () => this.ask({ kind: 'stop' });
  /** `mark`: of the acts that are in it. */
  snapshot = async (historyBytes: number, kept: boolean): Promise<Snapshot & { mark: number }> =>
    ({ ...(await this.ask<Snapshot>({ kind: 'snapshot', historyBytes, kept })), mark: this.acts.mark });
  restore = (source: Uint8Array | null, name: string, snapshot: Uint8Array, opened: number) =>
    this.ask({ kind: 'restore', source, name, snapshot, opened });
  context = () => this.ask<{ context: Context | null; trims: Trim[] }>({ kind: 'context' });
  query = <Q extends Query>(query: Q, ...[request]: Asked<Q>): Promise<Answer<Q>> => this.ask({ kind: 'query', query, request });

  /**
   * Commands that follow the pointer: while one act is under way only the newest waiting one is kept, so that
   * the page is never more than one ahead. They are made at the moment they are sent.
   */
  follow(commands: () => Command[], join: boolean): void {
    this.live = { commands, join };
    this.liveUnderWay ??= this.followOn();
  }

  /** Resolves when everything given to `follow` has been done. */
  async followed(): Promise<void> {
    await this.liveUnderWay;
  }

  private async followOn(): Promise<void> {
    try {
      while (this.live) {
        const { commands, join } = this.live;
        this.live = null;
        await this.execute(commands(), join);
      }
    } catch (error) {
      this.live = null;
      if (error instanceof KneadError) this.onError(error.info);
    } finally {
      this.liveUnderWay = null;
    }
  }
}
