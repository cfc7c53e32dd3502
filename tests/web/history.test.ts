import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { Engine } from '@studio/engine/engine';
import { History } from '@studio/engine/history';
import { type Command, EngineError } from '@studio/engine/session_types';

const wasm = readFileSync(fileURLToPath(new URL('../../web/src/engine/knead_studio.wasm', import.meta.url)));
const drag = (z: number): Command => ({ do: 'drag', at: [0.5, 0.5], by: [0, 0, z], radius: 20, steps: 1 });

async function opened(): Promise<{ engine: Engine; history: History }> {
  const engine = await Engine.load(wasm);
  engine.fresh('sheet');
  for (const command of [{ do: 'new', size: [100, 100], net: [12, 12] }, { do: 'hold', rows: 2 }, { do: 'material', preset: 'clay' }] as const) {
    engine.execute(command as never as Command);
  }
  const history = new History(engine);
  history.begin();
  return { engine, history };
}
const undo: Command = { do: 'undo' };
const redo: Command = { do: 'redo' };

describe('the history above the opened document', () => {
  it('ends there', async () => {
    const { engine, history } = await opened();
    const [journal, points] = [engine.journal(), engine.controlPoints(0)];
    expect(history.state()).toMatchObject({ undo: false, redo: false });
    expect(() => history.execute([undo])).toThrow(EngineError);
    history.execute([drag(5)]);
    history.execute([drag(-3)], true);
    expect(history.state()).toMatchObject({ undo: true, redo: false });
    history.execute([undo]);
    expect(history.state()).toMatchObject({ undo: false, redo: true });
    expect(() => history.execute([undo])).toThrow('nothing to undo');
    expect(engine.journal()).toBe(journal);
    expect(engine.controlPoints(0)).toEqual(points);
    history.execute([redo]);
    expect(history.state()).toMatchObject({ undo: true, redo: false });
    expect(() => history.execute([redo])).toThrow('nothing to redo');
  });

  it('never joins with it', async () => {
    const { engine, history } = await opened();
    const journal = engine.journal();
    history.execute([drag(5)], true);
    history.execute([undo]);
    expect(engine.journal()).toBe(journal);
  });

  it('is found again in a restored session, also where its oldest states are gone', async () => {
    for (const bytes of [2 ** 24, 40_000]) {
      const { engine, history } = await opened();
      const journal = engine.journal();
      for (let k = 1; k <= 12; ++k) history.execute([drag(k)]);
      history.execute([undo]);
      const other = await Engine.load(wasm);
      other.restore(null, 'sheet', engine.snapshot(bytes));
      const again = new History(other);
      again.resume(history.opened);
      expect(other.journal()).toBe(engine.journal());
      expect(again.state()).toMatchObject({ undo: true, redo: true });
      let steps = 0;
      while (again.state().undo) {
        again.execute([undo]);
        ++steps;
      }
      if (bytes > 1e6) {
        expect(steps).toBe(11);
        expect(other.journal()).toBe(journal);
      } else expect(steps).toBeLessThan(11);
    }
  });

  it('has no entry of what changed nothing, or failed half-way', async () => {
    const { engine, history } = await opened();
    const journal = engine.journal();
    for (const same of [{ do: 'step', count: 3 }, { do: 'material', preset: 'clay' }, { do: 'hold', rows: 2 }] as Command[]) {
      history.execute([same]);
      expect(engine.journal(), same.do).toBe(journal);
      expect(history.state(), same.do).toMatchObject({ undo: false, redo: false });
    }
    expect(() => history.execute([drag(4), { do: 'select', surface: '#77' }])).toThrow('#77');
    expect(engine.journal()).toBe(journal);
    expect(history.state()).toMatchObject({ undo: false, redo: false });
    history.execute([{ do: 'material', preset: 'rubber' }]);
    expect(history.state().undo).toBe(true);
    history.execute([undo]);
    history.execute([drag(4)]);
    history.execute([{ do: 'step' }]);
    expect(engine.controlPoints(0)).not.toEqual((await opened()).engine.controlPoints(0));
  });
});
