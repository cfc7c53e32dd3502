// The entry for Node, which has workers of its own.
import script from 'packed:thread';
import { Worker } from 'node:worker_threads';

import type { Answer } from './protocol.js';
import { stoppedWorker } from './remote.js';
import { doors } from './remote_doors.js';

export { Chain, RemoteDocument, RemoteSurface } from './remote.js';
export * from './types.js';

/** What a worker of a browser has and one of Node has not. */
const scope = `const { parentPort } = require('node:worker_threads');
globalThis.postMessage = (message, transfer) => parentPort.postMessage(message, transfer);
parentPort.on('message', (data) => globalThis.onmessage({ data }));
`;

export const { open, create, restore } = doors(() => {
  const worker = new Worker(scope + script, { eval: true });
  worker.unref();
  return {
    post: (question) => worker.postMessage(question),
    listen(answered, failed) {
      worker.on('message', (answer: Answer) => answered(answer));
      worker.on('error', (error: Error) => failed(stoppedWorker(error.message)));
    },
    end: () => void worker.terminate(),
    hold: (held: boolean) => (held ? worker.ref() : worker.unref()),
  };
});
