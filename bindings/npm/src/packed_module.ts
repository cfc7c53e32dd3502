import { compiled } from './loading.js';
import packed from 'packed:engine';

/** The engine that this package has inside, by gzip in base 64. */
export async function packedBytes(): Promise<Uint8Array> {
  const text = atob(packed);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

let module: Promise<WebAssembly.Module> | undefined;

/** The same, compiled once. */
export function packedModule(): Promise<WebAssembly.Module> {
  return (module ??= packedBytes().then((bytes) => compiled(bytes as BufferSource, 'the engine could not be started: the package holds')));
}
