import type { Answer, Asked } from '@knead/engine';
import type { CheckRequest, EdgeCheck, EngineErrorInfo } from '@knead/generated';
import { KneadError } from './session_types';

/** What is asked of a file, beside the session. */
export type FileQuery = 'check' | 'deviation';

/** What the worker is asked for; without a file the one that it has read before is meant. */
export interface CheckAsked {
  id: number;
  file: Uint8Array | null;
  name: string;
  query: FileQuery;
  request: Asked<FileQuery>[0];
}
export type CheckReply = { id: number; answer: Answer<FileQuery> } | { id: number; error: EngineErrorInfo };

/** Measures files in a worker of its own, which lasts until `end`. */
export class Checker {
  private worker: Worker | null = null;
  /** What the worker has read: with other thresholds it is not read again. */
  private held: Uint8Array | null = null;
  private next = 1;
  private readonly waiting = new Map<number, { resolve(answer: Answer<FileQuery>): void; reject(error: Error): void }>();

  constructor(private readonly makeWorker: () => Worker) {}

  check = (file: Uint8Array, name: string, request: CheckRequest): Promise<EdgeCheck> => this.ask('check', file, name, request);

  /** Errors: those of `open` and of the query; "stopped" after `end`. */
  ask<Q extends FileQuery>(query: Q, file: Uint8Array, name: string, request: Asked<Q>[0]): Promise<Answer<Q>> {
    const worker = (this.worker ??= this.begin());
    const id = this.next++;
    const known = this.held === file;
    this.held = file;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (answer: Answer<FileQuery>) => void, reject });
      worker.postMessage({ id, file: known ? null : file, name, query, request } satisfies CheckAsked);
    });
  }

  /** Frees the memory of the worker. What it was asked for is not answered any more, but refused. */
  end(why = 'stopped'): void {
    this.worker?.terminate();
    this.worker = this.held = null;
    const lost = [...this.waiting.values()];
    this.waiting.clear();
    for (const { reject } of lost) reject(new Error(why));
  }

  private begin(): Worker {
    const worker = this.makeWorker();
    worker.onmessage = ({ data }: MessageEvent<CheckReply>) => {
      const asked = this.waiting.get(data.id);
      this.waiting.delete(data.id);
      if (!('error' in data)) return asked?.resolve(data.answer);
      this.held = null; // perhaps it was not read
      asked?.reject(new KneadError(data.error));
      if (data.error.kind === 'internal') this.end(); // the module has trapped, and cannot be relied on
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.end(event.message || 'the engine beside the session stopped');
    };
    return worker;
  }
}
