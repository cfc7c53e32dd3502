// Of Node, for worker_node.ts alone.
declare module 'node:worker_threads' {
  export class Worker {
    constructor(script: string, options: { eval: boolean });
    postMessage(message: unknown): void;
    on(event: string, does: (value: never) => void): void;
    terminate(): Promise<number>;
    ref(): void;
    unref(): void;
  }
}
