import { KneadError, errorOf } from '../../engine/session_types';
import wasmUrl from './knead_snake.wasm?url';
import { SnakeModule, type Snakes } from './module';
import type { Reply, Request, Result } from './protocol';

const perFrame = 12; // milliseconds of iterations before the page sees them
const atOnce = 20; // iterations

const loaded = SnakeModule.load(fetch(wasmUrl));
let module: SnakeModule;
/** As the user asks, and while the hand pulls. */
let running = false, pulled = false;
/** Sent, and not drawn yet. */
let onTheWay = false;
let now: Snakes | null = null;

const send = (reply: Reply): void => postMessage(reply);

function show(snakes: Snakes): void {
  now = snakes;
  if (snakes.ended && !pulled) running = false;
  onTheWay = true;
  send({ kind: 'snakes', snakes, running: running || pulled });
}

const going = () => (running || pulled) && now !== null && now.states.length > 0;

/** Iterations until a frame's time is over; the next ones wait until the page has drawn these. */
function run(): void {
  if (onTheWay || !going()) return;
  try {
    const end = performance.now() + perFrame;
    let snakes = now!;
    do snakes = module.advance(atOnce);
    while (performance.now() < end && !snakes.ended);
    show(snakes);
  } catch (error) {
    running = pulled = false;
    if (now) show(now);
    send({ kind: 'failed', id: 0, error: infoOf(error) });
  }
}

function act(request: Request): Result {
  switch (request.kind) {
    case 'image': running = pulled = false; show(module.setImage(request.pixels)); return {};
    case 'mask': show(module.setMask(request.pixels)); return {};
    case 'script': show(module.setScript(request.text, request.again)); return {};
    case 'clear': running = pulled = false; show(module.clear()); return {};
    case 'keep': return { kept: module.keep() };
    case 'restore': {
      const kept = module.keep();
      running = pulled = false;
      show(module.restore(request.kept));
      return { kept };
    }
    case 'forget': for (const kept of request.kept) module.forget(kept); return {};
    case 'run': running = request.on; if (now) show(running ? module.wake() : now); return {};
    case 'step': show(module.advance(request.iterations)); return {};
    case 'pull':
      running ||= pulled && request.pull === null; // what the hand has drawn comes to rest
      pulled = request.pull !== null;
      show(module.pull(request.pull));
      return {};
    case 'move': show(module.move(request.snake, request.point, request.to)); return {};
    case 'contours': return { text: module.contours(request.as, request.image) };
    case 'picture': return { picture: module.picture(request.of) };
    case 'drawn': onTheWay = false; return {};
  }
}

function infoOf(error: unknown): KneadError['info'] {
  if (error instanceof KneadError) return error.info;
  const what = error instanceof Error ? error.message : String(error);
  return errorOf('internal', what, 'close the panel and open the image again');
}

addEventListener('message', (event: MessageEvent<{ id: number; request: Request }>) => {
  const { id, request } = event.data;
  void loaded.then((m) => {
    module = m;
    try {
      send({ kind: 'done', id, result: act(request) });
    } catch (error) {
      send({ kind: 'failed', id, error: infoOf(error) });
    }
    setTimeout(run, 0);
  }).catch((error: unknown) => send({ kind: 'failed', id, error: infoOf(error) }));
});
