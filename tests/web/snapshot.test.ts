import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';

const root = fileURLToPath(new URL('../..', import.meta.url));
const wasm = readFileSync(join(root, 'web/src/engine/knead_studio.wasm'));
const bonnet = new Uint8Array(readFileSync(join(root, 'samples/bonnet.step')));
const load = () => Engine.load(wasm);
const megabyte = 2 ** 20;

/** One entry of the history: a ball that is pressed in along a line, and taken away. */
function stroke(engine: Engine, k: number): void {
  for (let j = 0; j < 8; ++j) {
    engine.execute({ do: 'tool', name: 'brush', radius: 12, plasticity: 1, position: [20 + ((37 * k) % 60) + j, 20 + ((53 * k) % 60), 9] }, j > 0);
    engine.execute({ do: 'step', count: 2 }, true);
  }
  engine.execute({ do: 'remove', tool: 'brush' }, true);
}

async function session(net: number): Promise<Engine> {
  const engine = await load();
  engine.query('fresh', { name: 'long' });
  engine.execute({ do: 'new', size: [100, 100], net: [net, net] });
  engine.execute({ do: 'hold', rows: 2 });
  engine.execute({ do: 'material', alpha: [0.1, 0, 0.1], beta: [0.001, 0.001, 0.001] });
  engine.execute({ do: 'evolve', mode: 'acm', lambda: 100 });
  return engine;
}

describe('a snapshot', () => {
  it('of a long session is restored to the same bits, with its history', async () => {
    const engine = await session(32);
    const strokes = 40;
    for (let k = 0; k < strokes; ++k) stroke(engine, k);
    const snapshot = engine.query('snapshot', { history_bytes: 48 * megabyte });
    const other = await load();
    other.query('restore', { name: 'long', snapshot });
    expect(other.query('control_points', { surface: 0 })).toEqual(engine.query('control_points', { surface: 0 }));
    expect(other.query('journal')).toBe(engine.query('journal'));
    for (let k = 0; k < 5; ++k) {
      engine.execute({ do: 'undo' });
      other.execute({ do: 'undo' });
      expect(other.query('control_points', { surface: 0 })).toEqual(engine.query('control_points', { surface: 0 }));
    }
    stroke(engine, 3);
    stroke(other, 3);
    expect(other.query('control_points', { surface: 0 })).toEqual(engine.query('control_points', { surface: 0 }));
  });

  it('of a STEP file goes with its bytes, and saves the same file', async () => {
    const engine = await load();
    engine.query('open', { file: bonnet, name: 'bonnet.step' });
    const { id } = engine.query('state').surfaces[0]!;
    engine.execute({ do: 'select', surface: id });
    engine.execute({ do: 'hold', mode: 'open' }); // the edges of the face may open
    engine.execute({ do: 'hold', rows: 2 });
    engine.execute({ do: 'drag', at: [0.5, 0.5], by: [0, 0, 20] });
    const other = await load();
    other.query('restore', { source: bonnet, name: 'bonnet.step', snapshot: engine.query('snapshot', { history_bytes: megabyte }) });
    expect(other.query('save').file).toEqual(engine.query('save').file);
    expect(other.query('origin')).toEqual(engine.query('origin'));
    expect(() => other.query('restore', { name: 'x', snapshot: engine.query('snapshot', { history_bytes: megabyte }) })).toThrow(/another document/);
    // A refused snapshot leaves the session as it was.
    expect(other.query('save').file).toEqual(engine.query('save').file);
  });

  it('that is damaged is refused', async () => {
    const engine = await session(8);
    const snapshot = engine.query('snapshot', { history_bytes: megabyte });
    const other = await load();
    expect(() => other.query('restore', { name: 'x', snapshot: snapshot.slice(0, -1) })).toThrow(/damaged/);
    expect(() => other.query('restore', { name: 'x', snapshot: snapshot.map((b, k) => (k === 500 ? b ^ 1 : b)) })).toThrow(/damaged/);
    expect(() => other.query('restore', { name: 'x', snapshot: new Uint8Array(3) })).toThrow(/not a snapshot/);
    expect(() => other.query('state')).toThrow(/nothing is open/);
  });
});
