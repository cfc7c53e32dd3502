import { Growth } from '@studio/app/growth';
import { Notes } from '@studio/app/notes';
import type { Notice } from '@studio/document/host';
import type { Command, NoteInfo, SessionInfo } from '@studio/engine/session_types';

/** What the page says by itself, and takes back once it is not so any more. */
function desk() {
  const said: Notice[] = [], settled: string[] = [], executed: Command[] = [];
  const page = {
    diagonal: 300, notify: (notice: Notice) => void said.push(notice), settle: (topic: string) => void settled.push(topic),
    execute: async (commands: Command[]) => { executed.push(...commands); return true as const; }, again: async () => undefined,
  };
  return { page, said, settled, executed };
}

describe('a note of the session', () => {
  const loose = (id: string) => ({ text: '', code: 'surface_loose', values: { surfaces: [id] }, fixes: [{ code: 'hold_edges', commands: [{ do: 'hold' }] }] }) as never as NoteInfo;

  it('is told once, at the end of a stroke, and leaves when it is settled', () => {
    const { page, said, settled } = desk();
    const notes = new Notes(page);
    notes.tell([loose('#1')], true);
    expect(said).toEqual([]);
    notes.tell([loose('#1')], false);
    notes.tell([loose('#1')], false);
    expect(said.map(({ text }) => text)).toEqual(['Nothing holds #1: what presses on it moves all of it.']);
    expect(settled).toEqual([]);
    notes.tell([], false);
    expect(settled).toEqual([said[0]!.topic]);
  });
});

describe('a net that has grown', () => {
  const state = (net: number[]) => ({ surfaces: [{ id: '#1', name: 'sheet', unit: 'inch', net }] }) as never as SessionInfo;

  it('under a stroke is said, with what reduces it again', () => {
    const { page, said, settled, executed } = desk();
    const growth = new Growth(page);
    growth.follow(state([32, 32]), false);
    growth.follow(state([40, 32]), true);
    growth.follow(state([76, 32]), true);
    expect(said).toEqual([]);
    growth.follow(state([76, 32]), false);
    expect(said.map(({ text }) => text)).toEqual(['sheet was refined to 76 × 32 points.']);
    expect(said[0]!.actions!.map(({ label }) => label)).toEqual(['Reduce within 0.03 in', 'Undo']);
    for (const { act } of said[0]!.actions!) act();
    expect(executed).toEqual([{ do: 'coarsen', tolerance: 0.03 }, { do: 'undo' }]);
    growth.follow(state([76, 32]), false);
    expect(settled).toEqual([]);
    growth.follow(state([32, 32]), false);
    expect(settled).toEqual(['refined']);
  });

  it('by a command is what was asked for, and so is another document', () => {
    const { page, said } = desk();
    const growth = new Growth(page);
    growth.follow(state([32, 32]), false);
    growth.follow(state([64, 64]), false);
    growth.follow(state([64, 64]), true);
    growth.follow(state([64, 64]), false);
    growth.follow(state([64, 64]), true);
    growth.forget();
    growth.follow(state([128, 128]), false);
    expect(said).toEqual([]);
  });
});
