// What a tab of an older studio left behind.
import { autosave, isReadable, type Kept, keptForm, olderDocument } from '@studio/document/autosave';
import { Documents } from '@studio/document/documents';
import type { Host, Notice } from '@studio/document/host';

const kept = (fields: Partial<Kept>): Kept => ({
  form: keptForm, id: 'a', name: 'hood.step', when: 1, commands: 2, opened: 1, journal: '[{"do":"hold","rows":2}]', snapshot: new Uint8Array(3), hasSource: false, views: [], ...fields,
});
const { form: _, ...unmarked } = kept({ id: 'old', hasSource: true, journal: '{"knead": 1, "commands": [\n  {"do":"hold","rows":2}\n]}\n' });
const old = unmarked as Kept;
const source = { kind: 'step' as const, name: 'hood.step', bytes: Uint8Array.of(1, 2, 3) };

/** Documents of a page, and what it says and saves. */
function desk(all: Kept[]) {
  const notices: Notice[] = [], saved: { name: string; content: Promise<string> }[] = [], forgotten: string[] = [], restored: string[] = [];
  let blob = new Blob();
  vi.stubGlobal('document', {
    addEventListener: () => undefined, documentElement: { dataset: {} },
    createElement: () => ({ href: '', download: '', click() { saved.push({ name: this.download, content: blob.text() }); } }),
  });
  vi.stubGlobal('navigator', {});
  vi.stubGlobal('URL', { createObjectURL: (b: Blob) => { blob = b; return 'blob:'; }, revokeObjectURL: () => undefined });
  vi.spyOn(autosave, 'all').mockImplementation(async () => all);
  vi.spyOn(autosave, 'source').mockImplementation(async () => source);
  vi.spyOn(autosave, 'forget').mockImplementation(async (id) => { forgotten.push(id); return undefined; });
  const host = {
    client: { restore: async (_s: unknown, name: string) => { restored.push(name); } }, state: null,
    notify: (n: Notice) => notices.push(n), attempt: async (act: () => Promise<void>) => { await act(); return true as const; },
    begin: () => () => undefined,
  };
  return { documents: new Documents(host as never as Host), notices, saved, forgotten, restored };
}

describe('a session that an older studio kept', () => {
  afterEach(() => {
    vi.unstubAllGlobals();
    vi.restoreAllMocks();
  });

  it('is not read, which is said with what to do, and can be downloaded whole', async () => {
    expect(isReadable(old)).toBe(false);
    expect(isReadable(kept({}))).toBe(true);
    const { documents, notices, saved, forgotten, restored } = desk([old]);
    await documents.recover(old);
    expect(restored).toEqual([]);
    expect(forgotten).toEqual([]);
    expect(notices).toHaveLength(1);
    expect(notices[0]).toMatchObject({ kind: 'error', text: expect.stringContaining('“hood.step” was kept by an older studio') as string, remedy: expect.stringContaining('docs/scripts.md') as string });
    notices[0]!.actions!.find(({ label }) => label === 'Download')!.act();
    await vi.waitFor(() => expect(saved).toHaveLength(1));
    expect(saved[0]!.name).toBe('hood.knead');
    expect(JSON.parse(await saved[0]!.content)).toEqual({
      knead: 2, name: 'hood.step', source: { kind: 'step', name: 'hood.step', bytes: 'AQID' }, commands: [{ do: 'hold', rows: 2 }], snapshot: 'AAAA',
    });
  });

  it('stays in the list, however many there are', async () => {
    const newer = Array.from({ length: 9 }, (_, k) => kept({ id: `n${k}`, when: 10 + k }));
    const { documents, forgotten } = desk([old, ...newer]);
    const left = await documents.keeper.left();
    expect(left.map(({ id }) => id)).toEqual(['n8', 'n7', 'n6', 'n5', 'n4', 'n3', 'old']);
    expect(forgotten).toEqual(['n2', 'n1', 'n0']);
  });

  it('is written with its views, as that studio wrote documents', () => {
    const views = [{ name: 'front', position: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], height: 1, parallel: true }] as Kept['views'];
    expect(JSON.parse(olderDocument({ ...old, views }, null))).toMatchObject({ knead: 2, views });
  });
});
