import { type Beginning, type Snapshot } from './document.js';
import { KneadError, kneadError } from './errors.js';
import { type EngineSource, moduleFrom } from './loading.js';
import { beginFresh, beginOpened, type CreateOptions, type FileBytes, type OpenOptions } from './opening.js';
import { packedBytes, packedModule } from './packed_module.js';
import { type Engine, RemoteDocument, type Spawn } from './remote.js';

export interface WorkerSource extends EngineSource {
  /** The address of the package's file worker-thread.js, where the page's policy allows no worker from a blob: URL. */
  workerUrl?: string | URL;
}

/** What a worker compiles itself where its maker must not. */
async function engineFor(source: WorkerSource): Promise<Engine> {
  if (source.wasmUrl !== undefined || source.wasmBinary) return moduleFrom(source);
  try {
    return await packedModule();
  } catch (error) {
    if (source.workerUrl === undefined || !(error instanceof KneadError)) throw error;
    return packedBytes();
  }
}

export const noWorker = (reason: string) =>
  kneadError('input', `no worker could be started (${reason})`, "serve the package's file worker-thread.js and give its address as workerUrl, "
    + "allow blob: in the worker-src of the page's policy, or import 'knead-cad' in a worker of your own");

/** The functions of the entry, with what starts a worker. */
export function doors(spawn: (workerUrl?: string | URL) => ReturnType<Spawn>) {
  const begin = async (from: Beginning, source: WorkerSource) => RemoteDocument.begin(() => spawn(source.workerUrl), await engineFor(source), from);
  return {
    open: async (file: FileBytes, options: OpenOptions & WorkerSource = {}) => begin(await beginOpened(file, options), options),
    create: async (options: CreateOptions & WorkerSource = {}) => begin(beginFresh(options), options),
    restore: async (snapshot: Snapshot, source: WorkerSource = {}) => begin(snapshot, source),
  };
}
