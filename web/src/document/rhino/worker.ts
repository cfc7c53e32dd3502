import wasmUrl from 'rhino3dm/rhino3dm.wasm?url';

import { loadRhino } from './module';
import type { Patch } from './patch';
import { openRhino, readRhino, type RhinoContents } from './read';
import { rewriteRhino, writeRhino, type Written } from './write';

export type RhinoRequest =
  | { kind: 'read'; bytes: Uint8Array }
  /** Writes into the file as it was opened, or into a new one. */
  | { kind: 'write'; source: Uint8Array | null; surfaces: { name: string; patch: Patch }[]; unit: string };

export interface RhinoReply {
  id: number;
  value?: RhinoContents | Written;
  error?: string;
}

const loaded = loadRhino(wasmUrl);

self.onmessage = async (event: MessageEvent<{ id: number; request: RhinoRequest }>) => {
  const { id, request } = event.data;
  const post = (reply: Omit<RhinoReply, 'id'>) => self.postMessage({ id, ...reply });
  try {
    const rhino = await loaded;
    if (request.kind === 'read') post({ value: readRhino(rhino, openRhino(rhino, request.bytes)) });
    else {
      const { source, surfaces, unit } = request;
      post({ value: source ? rewriteRhino(rhino, source, surfaces) : writeRhino(rhino, surfaces, unit) });
    }
  } catch (error) {
    post({ error: error instanceof Error ? error.message : String(error) });
  }
};
