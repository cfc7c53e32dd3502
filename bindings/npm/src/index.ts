import { Document, type Snapshot } from './document.js';
import { beginFresh, beginOpened, type CreateOptions, type FileBytes, type OpenOptions } from './opening.js';
import { packedModule } from './packed_module.js';

export { Document, Surface } from './document.js';
export * from './types.js';

/** A document of a CAD file: its bytes, which may be compressed. The edges of faces are held. */
export async function open(file: FileBytes, options: OpenOptions = {}): Promise<Document> {
  return Document.begin(await packedModule(), await beginOpened(file, options));
}

/** A document without a file: its command `new` makes surfaces, curves and volumes, and `save` writes STEP. */
export async function create(options: CreateOptions = {}): Promise<Document> {
  return Document.begin(await packedModule(), beginFresh(options));
}

/** The document of a snapshot, bit for bit, with undo and redo; nothing is computed. */
export async function restore(snapshot: Snapshot): Promise<Document> {
  return Document.begin(await packedModule(), snapshot);
}
