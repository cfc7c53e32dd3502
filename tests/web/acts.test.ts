import { Acts } from '@studio/engine/acts';

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
