import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import { Acts } from '@studio/engine/acts';
import type { Command } from '@studio/engine/session_types';

const root = fileURLToPath(new URL('../..', import.meta.url));

const execute = (name: string, join = false) => ({ kind: 'execute' as const, commands: [{ do: 'select' as const, surface: name }], join });
const names = (acts: Acts) => acts.toRepeat.acts.map(({ commands }) => (commands[0] as { surface: string }).surface);

describe('what an engine has done since the last copy', () => {
  it('is repeated by the next one, in its order', () => {
    const acts = new Acts();
    for (const name of ['a', 'b', 'c']) acts.settled(execute(name), true);
    expect(names(acts)).toEqual([]); // the engine lives
    acts.lose();
    expect(names(acts)).toEqual(['a', 'b', 'c']);
    expect(acts.toRepeat.all).toBe(true);
    acts.repeated();
    expect(names(acts)).toEqual([]);
  });

  it('does not count what the copy holds, even where the copy is safe only after the end', () => {
    const acts = new Acts();
    acts.settled(execute('a'), true);
    const { mark } = acts;
    acts.settled(execute('b'), false); // refused half-way: it does the same again
    acts.lose();
    acts.kept(mark);
    expect(names(acts)).toEqual(['b']);
  });

  it('ends where steps were played, until a copy holds these', () => {
    const acts = new Acts();
    acts.settled(execute('a'), true);
    acts.gap();
    acts.gap();
    const { mark } = acts;
    acts.settled(execute('b'), true);
    acts.lose();
    expect([names(acts), acts.toRepeat.all]).toEqual([['a'], false]);
    acts.kept(mark);
    expect([names(acts), acts.toRepeat.all]).toEqual([['b'], true]);
  });

  it('begins anew with another session, but not with one that could not be opened', () => {
    const acts = new Acts();
    const open = { kind: 'open' as const, bytes: new Uint8Array(), name: 'x', commands: [] };
    acts.settled(execute('a'), true);
    acts.settled(open, false);
    acts.settled(execute('b'), true);
    acts.lose();
    expect(names(acts)).toEqual(['a', 'b']);
    acts.repeated();
    acts.settled(execute('c'), true);
    acts.settled(open, true);
    acts.lose();
    expect(names(acts)).toEqual([]);
  });

  it('is repeated once only: what ends the next engine as well is left out', () => {
    const acts = new Acts();
    acts.settled(execute('a'), true);
    acts.lose();
    acts.lose();
    expect([names(acts), acts.toRepeat.all]).toEqual([[], false]);
  });
});

describe('what may have changed a shape', () => {
  const shapesAfter = (...commands: Command[]) => {
    const acts = new Acts();
    acts.settled({ kind: 'execute', commands, join: false }, true);
    return acts.shapes;
  };
  const still: Command[] = [
    { do: 'material', mass: 2 }, { do: 'pin', at: [0.5, 0.5] }, { do: 'freeze', region: [[0.4, 0.6], [0.4, 0.6]] }, { do: 'load', gravity: [0, 0, -1] }, { do: 'limit', distance: 50 },
    { do: 'measure', name: 'm', at: [0.5, 0.5] }, { do: 'move', tool: 'ball', by: [1, 0, 0] }, { do: 'turn', tool: 'ball', axis: [1, 0, 0], angle: 10 },
    { do: 'scale', tool: 'ball', by: [1, 2, 1] }, { do: 'edit_tool', name: 'ball', stiffness: 10 }, { do: 'lock', surfaces: ['#285'], locked: true }, { do: 'select', surface: '#285' },
  ];

  it('is nothing of what leaves the saved file as it is', async () => {
    const engine = await Engine.load(readFileSync(join(root, 'web/src/engine/knead_studio.wasm')));
    engine.query('open', { file: new Uint8Array(readFileSync(join(root, 'samples/bonnet.step'))), name: 'bonnet.step' });
    engine.query('act', { commands: [{ do: 'select', surface: '#285' }, { do: 'hold', mode: 'open' }, { do: 'tool', name: 'ball', radius: 100, at: [0.5, 0.1] }, { do: 'step', count: 2 }] });
    const before = engine.query('save').file;
    for (const command of still) {
      if (command.do === 'select') engine.query('act', { commands: [{ do: 'lock', surfaces: ['#285'], locked: false }] });
      engine.query('act', { commands: [command] });
      expect(Buffer.compare(engine.query('save').file, before), command.do).toBe(0);
      expect(shapesAfter(command), command.do).toBe(0);
    }
    engine.query('act', { commands: [{ do: 'step', count: 1 }] });
    expect(Buffer.compare(engine.query('save').file, before)).not.toBe(0);
  });

  it('is everything else, and steps that are played', () => {
    for (const command of [{ do: 'step' }, { do: 'undo' }, { do: 'points', which: [0], by: [0, 0, 1] }, { do: 'hold', mode: 'open' }, { do: 'evolve', mode: 'static' }] as Command[])
      expect(shapesAfter(command), command.do).toBe(1);
    expect(shapesAfter({ do: 'select', surface: '#285' }, { do: 'step' } as Command)).toBe(1);
    const acts = new Acts();
    acts.gap();
    expect(acts.shapes).toBe(1);
    const counts: number[] = [];
    acts.onShapes.push(() => counts.push(acts.shapes), () => counts.push(-acts.shapes));
    acts.settled(execute('#1'), true);
    acts.settled({ kind: 'execute', commands: [{ do: 'undo' }], join: false }, true);
    expect(counts).toEqual([2, -2]);
  });
});
