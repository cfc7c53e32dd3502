import { Engine } from '@knead/engine';
import { Rest } from './rest';
import { strokes } from './strokes';

/**
 * Browsers compile what a module calls often once more, for speed, and all instances of a module share what was compiled. This
 * worker makes strokes in an instance of its own, which nobody sees and which ends with it.
 */
self.onmessage = async ({ data }: MessageEvent<{ module: WebAssembly.Module; longest: number }>) => {
  try {
    const engine = await Engine.load(data.module, new Rest(() => {
      throw new Error('a stroke calls a function of the second module');
    }));
    const end = performance.now() + data.longest;
    for (const _ of strokes(engine)) if (performance.now() > end) break;
  } finally {
    self.postMessage('done');
  }
};
