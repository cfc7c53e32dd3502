import type { SurfaceNumbers } from '../../engine/session_types';
import type { Patch } from './patch';
import type { RhinoContents } from './read';
import type { RhinoReply, RhinoRequest } from './worker';
import type { Written } from './write';

/** The connection to the worker that handles Rhino files; it is started, and its module loaded, when first needed. */
class RhinoClient {
  private worker: Worker | null = null;
  private next = 1;
  private readonly waiting = new Map<number, { resolve(value: never): void; reject(error: Error): void }>();

  read = (bytes: Uint8Array) => this.ask<RhinoContents>({ kind: 'read', bytes });
  write = (source: Uint8Array | null, surfaces: { name: string; patch: Patch }[], unit: string) =>
    this.ask<Written>({ kind: 'write', source, surfaces, unit });

  private ask<T>(request: RhinoRequest): Promise<T> {
    this.worker ??= this.start();
    const id = this.next++;
    return new Promise<T>((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.worker!.postMessage({ id, request });
    });
  }

  private start(): Worker {
    const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
    worker.onmessage = (event: MessageEvent<RhinoReply>) => {
      const { id, error, value } = event.data;
      const waiting = this.waiting.get(id);
      this.waiting.delete(id);
      if (error !== undefined) waiting?.reject(new Error(error));
      else waiting?.resolve(value as never);
    };
    worker.onerror = (event) => {
      for (const { reject } of this.waiting.values()) reject(new Error(`Rhino files cannot be read here: ${event.message || 'the module could not be loaded'}`));
      this.waiting.clear();
      this.worker = null;
    };
    return worker;
  }
}

export const rhino = new RhinoClient();

export const patchOfNumbers = ({ degree, net, knots_u, knots_v, weights, points }: SurfaceNumbers): Patch => ({
  degree, net, knots_u: [...knots_u], knots_v: [...knots_v], weights: weights.length > 0 ? [...weights] : null,
  points: Array.from({ length: points.length / 3 }, (_, k) => [points[3 * k]!, points[3 * k + 1]!, points[3 * k + 2]!]),
});
