import script from 'packed:thread';

import type { Answer } from './protocol.js';
import { stoppedWorker, type Thread } from './remote.js';
import { doors, noWorker } from './remote_doors.js';

export { Chain, RemoteDocument, RemoteSurface } from './remote.js';
export type { WorkerSource } from './remote_doors.js';
export * from './types.js';

/** A worker of its own script, or of the one that is served. */
function started(workerUrl?: string | URL): Thread {
  const url = workerUrl ?? URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
  let worker: Worker;
  let answers = false;
  try {
    worker = new Worker(url);
  } catch (error) {
    throw noWorker(error instanceof Error ? error.message : String(error));
  }
  return {
    post: (question) => worker.postMessage(question),
    listen(answered, failed) {
      worker.onmessage = ({ data }: MessageEvent<Answer>) => {
        if (!answers && workerUrl === undefined) URL.revokeObjectURL(String(url));
        answers = true;
        answered(data);
      };
      worker.onerror = (event) => failed(answers ? stoppedWorker(event.message) : noWorker(event.message || (workerUrl ? `${String(url)} gives none` : 'the page allows none from a blob: URL')));
    },
    end: () => worker.terminate(),
  };
}

/** `open`, `create` and `restore` as in 'knead-cad': what they return lives in a worker, and answers with promises. */
export const { open, create, restore } = doors(started);
