import { Engine } from './engine';
import type { Command } from './session_types';

const net = 16;
const strokes = 40;
const sheet: Command[] = [
  { do: 'new', size: [1, 1], net: [net, net] },
  { do: 'hold', rows: 2 },
  { do: 'material', alpha: [0.1, 0, 0.1], beta: [0.001, 0.001, 0.001] },
  { do: 'evolve', mode: 'acm', lambda: 100 },
];

/**
 * Runs a few strokes on a small sheet of their own: the browser compiles a function well only once it has run for a
 * while, and all sessions of one module share what it has compiled. In pieces of milliseconds, between which the worker
 * does what the page asks for.
 */
export async function warmUp(module: WebAssembly.Module): Promise<void> {
  const pause = () => new Promise((resolve) => setTimeout(resolve, 0));
  const engine = await Engine.start(module);
  engine.fresh('warm-up');
  for (const command of sheet) {
    await pause();
    engine.execute(command);
  }
  for (let k = 0; k < strokes; ++k) {
    await pause();
    const position = [0.3 + 0.4 * ((k * 0.137) % 1), 0.3 + 0.4 * ((k * 0.271) % 1), 0.06];
    engine.execute({ do: 'tool', name: 'ball', shape: 'sphere', radius: 0.12, position, mode: 'collision', plasticity: 1 }, k > 0);
    engine.execute({ do: 'step' }, true);
    engine.paint(0, 32, 'none');
    engine.state();
  }
}
