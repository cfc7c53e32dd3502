import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { isNet, readKnead } from '@studio/document/knead_file';
import { scenes } from '@studio/document/scenes';
import { Engine } from '@knead/engine';
import type { Command } from '@studio/engine/session_types';

const root = fileURLToPath(new URL('../..', import.meta.url));
const wasm = readFileSync(join(root, 'web/src/engine/knead_studio.wasm'));
const bonnet = new Uint8Array(readFileSync(join(root, 'samples/bonnet.step')));
const defaultHold: Command = { do: 'hold', mode: 'position', all: true };

/** The control points after a script as the command line runs it. */
async function run(script: string, file: Uint8Array | null): Promise<Float64Array[]> {
  const engine = await Engine.load(wasm);
  if (file) engine.query('open', { file, name: 'bonnet.step' });
  else engine.query('fresh', { name: 'again' });
  for (const command of [defaultHold, ...readKnead(script).commands]) engine.execute(command);
  return engine.query('state').surfaces.map((_, k) => engine.query('control_points', { surface: k }));
}

describe('a script that the studio saves', () => {
  it.each(scenes.filter((s) => s.commands && !s.file))('of the scene $name, without a file, does the same', async ({ commands }) => {
    const engine = await Engine.load(wasm);
    engine.query('fresh', { name: 'scene' });
    for (const command of [...commands!, { do: 'step', count: 2 } as const]) engine.execute(command);
    const script = engine.query('script');
    expect(readKnead(script).commands[0]).toMatchObject({ do: 'new' });
    expect(await run(script, null)).toEqual(engine.query('state').surfaces.map((_, k) => engine.query('control_points', { surface: k })));
  });

  it('of a STEP file lets go what scripts hold at first, unless it begins with that hold', async () => {
    for (const held of [false, true]) {
      const engine = await Engine.load(wasm);
      engine.query('open', { file: bonnet, name: 'bonnet.step' });
      if (held) engine.execute(defaultHold);
      engine.execute({ do: 'select', surface: engine.query('state').surfaces[0]!.id });
      if (!held) engine.execute({ do: 'hold', rows: 2 });
      engine.execute({ do: 'drag', at: [0.5, 0.5], by: [0, 0, 20], radius: 100, steps: 1 });
      const script = engine.query('script');
      expect(readKnead(script).commands[0]).toMatchObject(held ? { do: 'select' } : { do: 'hold', rows: 0, all: true });
      expect(await run(script, bonnet)).toEqual(engine.query('state').surfaces.map((_, k) => engine.query('control_points', { surface: k })));
    }
  });
});

describe('a JSON file', () => {
  const rows = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]];

  it.each([['lists of points', rows], ['an object', { net: rows, degree: [1, 1] }]])('with a net as %s is no script, and opens as a surface', async (_, net) => {
    const text = JSON.stringify(net);
    expect(isNet(text)).toBe(true);
    const engine = await Engine.load(wasm);
    engine.query('open', { file: new TextEncoder().encode(text), name: 'net.json' });
    expect(engine.query('control_points', { surface: 0 })).toEqual(new Float64Array(rows.flat(2)));
  });

  it('with commands, or damaged, is no net', () => {
    for (const text of ['{"knead": 2, "commands": []}', '{"knead": 2, "net": []}', '{"commands": []}', '3', 'null', '[[', '']) expect(isNet(text)).toBe(false);
  });
});
