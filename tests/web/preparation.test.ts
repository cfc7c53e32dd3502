import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import { Preparation } from '@studio/engine/preparation';
import { Rest } from '@studio/engine/rest';
import type { Command, Vector3 } from '@studio/engine/session_types';
import { rehearse, strokes } from '@studio/engine/strokes';

// What the worker does before the first stroke, while nobody asks for anything.

const module = (name: string) => readFileSync(fileURLToPath(new URL(join('../../web/src/engine', `knead_${name}.wasm`), import.meta.url)));
const core = module('core');

async function sheet(net = 16): Promise<Engine> {
  const engine = await Engine.load(core, new Rest(() => {
    throw new Error('the second module is called');
  }));
  engine.query('fresh', { name: 'sheet' });
  const commands: Command[] = [
    { do: 'new', size: [100, 100], net: [net, net] }, { do: 'hold', rows: 2 },
    { do: 'material', preset: 'clay' }, { do: 'evolve', mode: 'acm', lambda: 100, accuracy: 'interactive' },
  ];
  for (const command of commands) engine.execute(command);
  return engine;
}

function press(engine: Engine, position: Vector3): void {
  engine.execute({ do: 'tool', name: 'brush', radius: 20, position, mode: 'collision', plasticity: 1, touches: 'visible' });
  engine.execute({ do: 'stroke', tool: 'brush', path: [position] }, true);
  engine.execute({ do: 'remove', tool: 'brush' }, true);
}

const all = (engine: Engine) => ({ journal: engine.query('journal'), snapshot: engine.query('snapshot', { history_bytes: 2 ** 20 }), points: engine.query('control_points', { surface: 0 }) });

describe('a rehearsal', () => {
  it('leaves the session as it is, with what can be redone, and what follows has the same bits', async () => {
    const [engine, other] = [await sheet(), await sheet()];
    for (const e of [engine, other]) {
      press(e, [40, 50, 10]);
      press(e, [60, 50, 10]);
      e.execute({ do: 'undo' });
    }
    const before = all(engine);
    rehearse(engine);
    engine.query('rehearse', { commands: [{ do: 'tool', name: 'ball', radius: 20, position: [50, 50, 5] }, { do: 'step', count: 2 }] });
    expect(all(engine)).toEqual(before);
    for (const e of [engine, other]) e.execute({ do: 'redo' });
    expect(engine.query('control_points', { surface: 0 })).toEqual(other.query('control_points', { surface: 0 }));
    for (const e of [engine, other]) {
      e.execute({ do: 'undo' });
      press(e, [55, 45, 8]);
    }
    expect(engine.query('control_points', { surface: 0 })).toEqual(other.query('control_points', { surface: 0 }));
    expect(engine.query('control_points', { surface: 0 })).not.toEqual(before.points);
  });

  it('reports what is refused, and leaves the session as it is then, too', async () => {
    const engine = await sheet();
    const before = all(engine);
    expect(() => engine.query('rehearse', { commands: [{ do: 'tool', name: 'ball', radius: 20, position: [50, 50, 5] }, { do: 'select', surface: '#99' }] })).toThrow('#99');
    expect(all(engine)).toEqual(before);
  });

  it('is made of what strokes can press within the time of a frame, and of nothing else', async () => {
    const rehearsed = async (change: (engine: Engine) => void, net = 16) => {
      const engine = await sheet(net);
      change(engine);
      let count = 0;
      const { query } = engine;
      engine.query = (name, ...asked) => (name === 'rehearse' ? (++count, null as never) : query.call(engine, name, ...asked) as never);
      rehearse(engine);
      return count;
    };
    expect(await rehearsed(() => undefined)).toBe(1);
    expect(await rehearsed(() => undefined, 64)).toBe(1);
    expect(await rehearsed(() => undefined, 72)).toBe(0);
    expect(await rehearsed((engine) => void engine.query('fresh', { name: 'nothing' }))).toBe(0);
    expect(await rehearsed((engine) => engine.execute({ do: 'tool', name: 'ball', radius: 10, position: [50, 50, 20] }))).toBe(0);
  });
});

it('the strokes of a warm-up call the core alone, and change what they press', async () => {
  const engine = await sheet();
  let frames = 0;
  for (const _ of strokes(engine)) ++frames;
  expect(frames).toBeGreaterThan(50);
  const heights = engine.query('control_points', { surface: 0 }).filter((_, k) => k % 3 === 2);
  expect(Math.min(...heights)).toBeLessThan(-1);
});

describe('the time of the preparation', () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  class Warmer {
    onmessage = () => {};
    onerror = (_: unknown) => {};
    ended = false;
    postMessage = () => {};
    terminate(): void {
      this.ended = true;
    }
  }

  function prepared(refused = 0) {
    const workers: Warmer[] = [];
    let rehearsals = 0;
    const preparation = new Preparation(Promise.resolve({} as WebAssembly.Module), () => {
      workers.push(new Warmer());
      return workers.at(-1) as unknown as Worker;
    }, () => {
      ++rehearsals;
      return Promise.resolve(rehearsals !== refused);
    });
    return { preparation, workers, rehearsals: () => rehearsals };
  }

  const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);

  /** Something is done, and nothing for so long after it that a preparation begins. */
  async function leaveAlone(preparation: Preparation): Promise<void> {
    preparation.interrupt(true);
    await wait(1100);
  }

  it('begins with one rehearsal when a session has been left alone, and goes on with a warm-up', async () => {
    const { preparation, workers, rehearsals } = prepared();
    await leaveAlone(preparation);
    expect([workers.length, rehearsals()]).toEqual([0, 0]); // there is no session yet
    preparation.renew();
    preparation.interrupt(true);
    await wait(100);
    preparation.interrupt(false);
    await wait(950);
    expect([workers.length, rehearsals()]).toEqual([0, 0]);
    await wait(100);
    expect([workers.length, rehearsals()]).toEqual([1, 1]);
    workers[0]!.onmessage();
    expect(workers[0]!.ended).toBe(true);
    await wait(10_000);
    await leaveAlone(preparation);
    expect([workers.length, rehearsals()]).toEqual([1, 1]);
    preparation.renew();
    await leaveAlone(preparation);
    expect([workers.length, rehearsals()]).toEqual([1, 2]);
  });

  it('is over at once when the user begins something, and warms up three times at most', async () => {
    const { preparation, workers, rehearsals } = prepared();
    preparation.renew();
    for (let k = 0; k < 5; ++k) await leaveAlone(preparation);
    preparation.interrupt(true);
    expect(workers.map((w) => w.ended)).toEqual([true, true, true]);
    expect(rehearsals()).toBe(1);
  });

  it('rehearses again later where it could not, and does without a worker where there is none', async () => {
    const { preparation, workers, rehearsals } = prepared(1);
    let alone = 0;
    const without = new Preparation(Promise.resolve({} as WebAssembly.Module), () => {
      throw new Error('no workers within workers');
    }, () => Promise.resolve(++alone > 0));
    without.renew();
    for (let k = 0; k < 3; ++k) await leaveAlone(without);
    expect(alone).toBe(1);
    preparation.renew();
    await leaveAlone(preparation);
    expect([workers.length, rehearsals()]).toEqual([1, 1]);
    workers[0]!.onmessage();
    await wait(0);
    expect(rehearsals()).toBe(2);
    for (let k = 0; k < 3; ++k) await leaveAlone(preparation);
    expect([workers.length, rehearsals()]).toEqual([1, 2]);
  });

  it('is not ended by a worker that was ended before', async () => {
    const { preparation, workers } = prepared();
    preparation.renew();
    await leaveAlone(preparation);
    await leaveAlone(preparation);
    workers[0]!.onmessage();
    expect([workers.length, workers[1]!.ended]).toEqual([2, false]);
  });

  it('goes on beside requests that are short, and waits with a rehearsal until they are over', async () => {
    const { preparation, workers, rehearsals } = prepared(1);
    preparation.renew();
    await leaveAlone(preparation);
    preparation.interrupt(false);
    expect(workers[0]!.ended).toBe(false);
    workers[0]!.onerror({ preventDefault: () => undefined });
    await wait(0);
    expect(rehearsals()).toBe(1);
    await wait(1100);
    expect(rehearsals()).toBe(2);
  });

  it('does not warm up before a request that came during the rehearsal has been left alone', async () => {
    let done = (_: boolean) => {};
    const workers: Warmer[] = [];
    const preparation = new Preparation(Promise.resolve({} as WebAssembly.Module), () => {
      workers.push(new Warmer());
      return workers[0] as unknown as Worker;
    }, () => new Promise((resolve) => (done = resolve)));
    preparation.renew();
    await leaveAlone(preparation);
    preparation.interrupt(true);
    done(true);
    await wait(500);
    expect(workers).toHaveLength(0);
    await wait(600);
    expect(workers).toHaveLength(1);
  });
});
