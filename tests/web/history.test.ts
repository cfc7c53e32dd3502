import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { Engine } from '@studio/engine/engine';
import { type Command, EngineError } from '@studio/engine/session_types';

const wasm = readFileSync(fileURLToPath(new URL('../../web/src/engine/knead_studio.wasm', import.meta.url)));
const drag = (z: number): Command => ({ do: 'drag', at: [0.5, 0.5], by: [0, 0, z], radius: 20, steps: 1 });

async function opened(): Promise<{ engine: Engine; commands: number }> {
  const engine = await Engine.load(wasm);
  engine.fresh('sheet');
  for (const command of [{ do: 'new', size: [100, 100], net: [12, 12] }, { do: 'hold', rows: 2 }, { do: 'material', preset: 'clay' }] as const) {
    engine.execute(command as never as Command);
  }
  return { engine, commands: engine.beginHistory() };
}
const undo: Command = { do: 'undo' };
const redo: Command = { do: 'redo' };

describe('the history above the opened document', () => {
  it('ends there', async () => {
    const { engine } = await opened();
    const [journal, points] = [engine.journal(), engine.controlPoints(0)];
    expect(engine.state()).toMatchObject({ undo: false, redo: false });
    expect(() => engine.act([undo])).toThrow(EngineError);
    engine.act([drag(5)]);
    engine.act([drag(-3)], { join: true });
    expect(engine.state()).toMatchObject({ undo: true, redo: false });
    engine.act([undo]);
    expect(engine.state()).toMatchObject({ undo: false, redo: true });
    expect(() => engine.act([undo])).toThrow('nothing to undo');
    expect(engine.journal()).toBe(journal);
    expect(engine.controlPoints(0)).toEqual(points);
    engine.act([redo]);
    expect(engine.state()).toMatchObject({ undo: true, redo: false });
    expect(() => engine.act([redo])).toThrow('nothing to redo');
  });

  it('never joins with it', async () => {
    const { engine } = await opened();
    const journal = engine.journal();
    engine.act([drag(5)], { join: true });
    engine.act([undo]);
    expect(engine.journal()).toBe(journal);
  });

  it('is found again in a restored session, also where its oldest states are gone', async () => {
    for (const bytes of [2 ** 24, 40_000]) {
      const { engine, commands } = await opened();
      const journal = engine.journal();
      for (let k = 1; k <= 12; ++k) engine.act([drag(k)]);
      engine.act([undo]);
      const other = await Engine.load(wasm);
      other.restore(null, 'sheet', engine.snapshot(bytes));
      other.beginHistory(commands);
      expect(other.journal()).toBe(engine.journal());
      expect(other.state()).toMatchObject({ undo: true, redo: true });
      let steps = 0;
      while (other.state().undo) {
        other.act([undo]);
        ++steps;
      }
      if (bytes > 1e6) {
        expect(steps).toBe(11);
        expect(other.journal()).toBe(journal);
      } else expect(steps).toBeLessThan(11);
    }
  });

  it('has no entry of what changed nothing, or failed half-way', async () => {
    const { engine } = await opened();
    const journal = engine.journal();
    for (const same of [{ do: 'step', count: 3 }, { do: 'material', preset: 'clay' }, { do: 'hold', rows: 2 }] as Command[]) {
      engine.act([same]);
      expect(engine.journal(), same.do).toBe(journal);
      expect(engine.state(), same.do).toMatchObject({ undo: false, redo: false });
    }
    expect(() => engine.act([drag(4), { do: 'select', surface: '#77' }])).toThrow('#77');
    expect(engine.journal()).toBe(journal);
    expect(engine.state()).toMatchObject({ undo: false, redo: false });
    engine.act([{ do: 'material', preset: 'rubber' }]);
    expect(engine.state().undo).toBe(true);
    engine.act([undo]);
    engine.act([drag(4)]);
    engine.act([{ do: 'step' }]);
    expect(engine.controlPoints(0)).not.toEqual((await opened()).engine.controlPoints(0));
  });
});
