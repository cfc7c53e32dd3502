import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { brotliDecompressSync } from 'node:zlib';

import { Engine } from '@knead/engine';
import { Rest } from '@studio/engine/rest';
import type { Command } from '@studio/engine/session_types';

// The engine as the page loads it, in two modules, beside the whole of it.

const root = fileURLToPath(new URL('../..', import.meta.url));
const module = (name: string) => readFileSync(join(root, `web/src/engine/knead_${name}.wasm`));
const bonnet = new Uint8Array(readFileSync(join(root, 'samples/bonnet.step')));

async function inTwo(): Promise<{ engine: Engine; rest: Rest }> {
  const rest = new Rest(() => new WebAssembly.Module(module('rest')));
  return { engine: await Engine.load(module('core'), rest), rest };
}

/** Does the same with both and compares all bits of the surface; whether the second module was called. */
async function same(act: (engine: Engine) => void): Promise<boolean> {
  const whole = await Engine.load(module('studio')), { engine, rest } = await inTwo();
  act(whole);
  act(engine);
  const points = engine.query('control_points', { surface: 0 });
  expect(points.length).toBeGreaterThan(0);
  expect(points).toEqual(whole.query('control_points', { surface: 0 }));
  expect(engine.query('save').file).toEqual(whole.query('save').file);
  return rest.started;
}

const run = (engine: Engine, commands: Command[]) => commands.forEach((command) => engine.execute(command));
const fresh = (commands: Command[]) => (engine: Engine) => {
  engine.query('fresh', { name: 'sheet' });
  run(engine, [{ do: 'new', size: [100, 100], net: [14, 14] }, { do: 'hold', rows: 2 }, ...commands]);
};

it('the core is at most 700 kilobytes as it goes over the network, and what is served is what was split', () => {
  const assets = join(root, 'web/dist/assets');
  const sizes = ['core', 'rest'].map((name) => {
    const packed = readdirSync(assets).filter((file) => file.startsWith(`knead_${name}`) && file.endsWith('.wasm.br')).map((file) => readFileSync(join(assets, file)));
    expect(packed).toHaveLength(1);
    expect(brotliDecompressSync(packed[0]!).equals(module(name))).toBe(true);
    return packed[0]!.byteLength;
  });
  expect(sizes[0]).toBeLessThan(700_000);
  expect(sizes[0]! + sizes[1]!).toBeLessThan(1_620_000); // both, with what programs ask of the package: new files of faces, edges that are checked, faces that follow data
});

it('a stroke, tools and a snapshot need the core alone', async () => {
  expect(await same(fresh([
    { do: 'material', preset: 'clay' }, { do: 'evolve', mode: 'acm', lambda: 100, accuracy: 'interactive' },
    { do: 'tool', name: 'brush', radius: 20, position: [50, 50, 10.5], plasticity: 1 },
    { do: 'stroke', tool: 'brush', path: [[50, 50, 10], [60, 50, 10]] },
    { do: 'undo' }, { do: 'redo' }, { do: 'remove', tool: 'brush' },
    { do: 'brush', kind: 'inflate', radius: 12, path: [[0.3, 0.3], [0.4, 0.3]] },
  ]))).toBe(false);
});

it('presses a file of STEP, held along its trims, without the second', async () => {
  expect(await same((engine) => {
    engine.query('open', { file: bonnet, name: 'bonnet.step' });
    const { surfaces } = engine.query('state');
    run(engine, [{ do: 'select', surface: surfaces[0]!.id }, { do: 'hold', mode: 'position' }, { do: 'material', preset: 'clay' },
      { do: 'tool', name: 'ball', radius: 100, at: [0.5, 0.5], plasticity: 1 }, { do: 'step' }]);
  })).toBe(false);
});

it('what is rare calls the second module, once it is compiled or at once', async () => {
  expect(await same(fresh([{ do: 'elevate', by: [1, 1] }, { do: 'coarsen', tolerance: 0.1 }]))).toBe(true);
  const { engine, rest } = await inTwo();
  rest.provide(new WebAssembly.Module(module('rest')));
  engine.query('open', { file: readFileSync(join(root, 'samples/bonnet.step')), name: 'bonnet.step' });
  expect(engine.query('file', { name: 'sheet.stl', detail: 8 }).file.length).toBeGreaterThan(1000);
  expect(rest.started).toBe(true);
});

it('a second module that cannot be had is an error of the call that needs it', async () => {
  const engine = await Engine.load(module('core'), new Rest(() => {
    throw new Error('no network');
  }));
  engine.query('open', { file: bonnet, name: 'bonnet.step' });
  expect(() => engine.query('file', { name: 'sheet.stl', detail: 8 }).file).toThrow('no network');
});
