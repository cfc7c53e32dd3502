import { KneadError, type EngineErrorInfo, errorOf } from '../../engine/session_types';
import type { Snakes } from './module';
import type { Reply, Request, Result } from './protocol';

/** The panel's line to its worker. */
export class SnakeClient {
  onSnakes: (snakes: Snakes, running: boolean) => void = () => {};
  /** Errors that no request waits for. */
  onError: (error: EngineErrorInfo) => void = () => {};

  private readonly worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  private readonly waiting = new Map<number, { resolve(result: Result): void; reject(error: Error): void }>();
  private next = 1;

  constructor() {
    this.worker.onmessage = (event: MessageEvent<Reply>) => this.take(event.data);
    this.worker.onerror = (event) => {
      const what = event.message || 'the engine of snakes stopped';
      const info = errorOf('internal', what, 'close the panel and open the image again');
      for (const { reject } of this.waiting.values()) reject(new KneadError(info));
      this.waiting.clear();
      this.onError(info);
    };
  }

  close(): void {
    this.worker.terminate();
  }

  ask(request: Request): Promise<Result> {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, request });
    });
  }

  private take(reply: Reply): void {
    if (reply.kind === 'snakes') {
      this.onSnakes(reply.snakes, reply.running);
      // The worker goes on when these are on the screen.
      requestAnimationFrame(() => void this.ask({ kind: 'drawn' }));
      return;
    }
    const waiting = this.waiting.get(reply.id);
    this.waiting.delete(reply.id);
    if (reply.kind === 'done') waiting?.resolve(reply.result);
    else if (waiting) waiting.reject(new KneadError(reply.error));
    else this.onError(reply.error);
  }
}
