import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import { type Command, KneadError } from '@studio/engine/session_types';

const wasm = readFileSync(fileURLToPath(new URL('../../web/src/engine/knead_studio.wasm', import.meta.url)));
const drag = (z: number): Command => ({ do: 'drag', at: [0.5, 0.5], by: [0, 0, z], radius: 20, steps: 1 });

async function opened(): Promise<{ engine: Engine; commands: number }> {
  const engine = await Engine.load(wasm);
  engine.query('fresh', { name: 'sheet' });
  for (const command of [{ do: 'new', size: [100, 100], net: [12, 12] }, { do: 'hold', rows: 2 }, { do: 'material', preset: 'clay' }] as const) {
    engine.execute(command as never as Command);
  }
  return { engine, commands: engine.query('begin_history') };
}
const undo: Command = { do: 'undo' };
const redo: Command = { do: 'redo' };

describe('the history above the opened document', () => {
  it('ends there', async () => {
    const { engine } = await opened();
    const [journal, points] = [engine.query('journal'), engine.query('control_points', { surface: 0 })];
    expect(engine.query('state')).toMatchObject({ undo: false, redo: false });
    expect(() => engine.query('act', { commands: [undo] })).toThrow(KneadError);
    engine.query('act', { commands: [drag(5)] });
    engine.query('act', { commands: [drag(-3)], join: true });
    expect(engine.query('state')).toMatchObject({ undo: true, redo: false });
    engine.query('act', { commands: [undo] });
    expect(engine.query('state')).toMatchObject({ undo: false, redo: true });
    expect(() => engine.query('act', { commands: [undo] })).toThrow('nothing to undo');
    expect(engine.query('journal')).toBe(journal);
    expect(engine.query('control_points', { surface: 0 })).toEqual(points);
    engine.query('act', { commands: [redo] });
    expect(engine.query('state')).toMatchObject({ undo: true, redo: false });
    expect(() => engine.query('act', { commands: [redo] })).toThrow('nothing to redo');
  });

  it('never joins with it', async () => {
    const { engine } = await opened();
    const journal = engine.query('journal');
    engine.query('act', { commands: [drag(5)], join: true });
    engine.query('act', { commands: [undo] });
    expect(engine.query('journal')).toBe(journal);
  });

  it('is found again in a restored session, also where its oldest states are gone', async () => {
    for (const bytes of [2 ** 24, 40_000]) {
      const { engine, commands } = await opened();
      const journal = engine.query('journal');
      for (let k = 1; k <= 12; ++k) engine.query('act', { commands: [drag(k)] });
      engine.query('act', { commands: [undo] });
      const other = await Engine.load(wasm);
      other.query('restore', { name: 'sheet', snapshot: engine.query('snapshot', { history_bytes: bytes }) });
      other.query('begin_history', { commands: commands });
      expect(other.query('journal')).toBe(engine.query('journal'));
      expect(other.query('state')).toMatchObject({ undo: true, redo: true });
      let steps = 0;
      while (other.query('state').undo) {
        other.query('act', { commands: [undo] });
        ++steps;
      }
      if (bytes > 1e6) {
        expect(steps).toBe(11);
        expect(other.query('journal')).toBe(journal);
      } else expect(steps).toBeLessThan(11);
    }
  });

  it('has no entry of what changed nothing, or failed half-way', async () => {
    const { engine } = await opened();
    const journal = engine.query('journal');
    for (const same of [{ do: 'step', count: 3 }, { do: 'material', preset: 'clay' }, { do: 'hold', rows: 2 }] as Command[]) {
      engine.query('act', { commands: [same] });
      expect(engine.query('journal'), same.do).toBe(journal);
      expect(engine.query('state'), same.do).toMatchObject({ undo: false, redo: false });
    }
    expect(() => engine.query('act', { commands: [drag(4), { do: 'select', surface: '#77' }] })).toThrow('#77');
    expect(engine.query('journal')).toBe(journal);
    expect(engine.query('state')).toMatchObject({ undo: false, redo: false });
    engine.query('act', { commands: [{ do: 'material', preset: 'rubber' }] });
    expect(engine.query('state').undo).toBe(true);
    engine.query('act', { commands: [undo] });
    engine.query('act', { commands: [drag(4)] });
    engine.query('act', { commands: [{ do: 'step' }] });
    expect(engine.query('control_points', { surface: 0 })).not.toEqual((await opened()).engine.query('control_points', { surface: 0 }));
  });
});
