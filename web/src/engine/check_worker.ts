import { type Asked, Engine } from '@knead/engine';
import type { CheckAsked, CheckReply, FileQuery } from './checker';
import coreUrl from './knead_core.wasm?url';
import restUrl from './knead_rest.wasm?url';
import { Rest } from './rest';
import { KneadError, errorOf } from './session_types';

/** Files are measured here, in an engine of its own: strokes do not wait for it. */
const compiled = Promise.all([coreUrl, restUrl].map((url) => WebAssembly.compileStreaming(fetch(url))));
const loaded = compiled.then(([core, rest]) => Engine.load(core!, new Rest(() => rest!)));

self.onmessage = async ({ data: { id, file, name, query, request } }: MessageEvent<CheckAsked>) => {
  let reply: CheckReply;
  try {
    const engine = await loaded;
    if (file) engine.query('open', { file, name });
    reply = { id, answer: engine.query(query, ...([request] as Asked<FileQuery>)) };
  } catch (error) {
    reply = { id, error: error instanceof KneadError ? error.info : errorOf('internal', error instanceof Error ? error.message : String(error), '') };
  }
  const handed = 'answer' in reply ? Object.values(reply.answer).filter(ArrayBuffer.isView).map(({ buffer }) => buffer as ArrayBuffer) : [];
  self.postMessage(reply, { transfer: handed });
};
