// What saving means for the question whether work would be lost.
import { closedEdges, partedEdges } from '@studio/document/closed_edges';
import type { Documents } from '@studio/document/documents';
import type { Host, Notice } from '@studio/document/host';
import { lostInRhino, Saving } from '@studio/document/saving';
import { KneadError } from '@studio/engine/session_types';

const letOpen = [{ do: 'hold', mode: 'open' }] as const;
const refusal = new KneadError({ kind: 'numerical', what: '', place: '', where: '', remedy: '', code: 'edge_left_open', values: { edge: '#7', distance: 0.25 },
  fixes: [{ code: 'let_open', commands: letOpen }] } as never);

/** How often a document has become a saved one, and the names of its downloads. */
function desk(opened: { deviation?: number; refused?: boolean } = {}): { saving: Saving; saved: () => number; names: string[]; notices: Notice[]; executed: object[] } {
  const names: string[] = [];
  const notices: Notice[] = [], executed: object[] = [];
  let saved = 0;
  const link = () => ({ href: '', download: '', click() { names.push(this.download); } });
  vi.stubGlobal('document', { createElement: link });
  vi.stubGlobal('URL', { createObjectURL: () => 'blob:', revokeObjectURL: () => undefined });
  const client = {
    query: async (name: string) => {
      if (name !== 'save') return new Uint8Array(1);
      if (opened.refused && executed.length === 0) throw refusal;
      const edges = opened.deviation ? [{ surface: '#1', tolerance: 0, edges: [{ id: '#7', faces: [], deviation: opened.deviation }], unknown: '' }] : [];
      return { file: new Uint8Array(1), edges };
    },
    execute: async (commands: object[]) => void executed.push(...commands),
    snapshot: async () => ({ snapshot: new Uint8Array(1), journal: '[]' }),
  };
  const host = {
    client, state: { tools: [], last: null, surfaces: [{ unit: 'mm' }], fresh: false }, computedTime: 0, detail: 8,
    notify: (notice: Notice) => void notices.push(notice), showEdges: () => undefined, settle: () => undefined, picture: async () => new Blob(),
    attempt: async (act: () => Promise<void>) => { await act(); return true as const; },
  };
  const documents = { name: 'hood.step', file: null, place: null, views: [], saved: () => ++saved };
  return { saving: new Saving(host as never as Host, documents as never as Documents), saved: () => saved, names, notices, executed };
}

describe('saving', () => {
  afterEach(() => vi.unstubAllGlobals());

  it('of the CAD file or the document keeps all work', async () => {
    const { saving, saved, names } = desk();
    await saving.step();
    await saving.knead();
    expect(names).toEqual(['hood-sculpted.step', 'hood.knead']);
    expect(saved()).toBe(2);
  });

  it('of meshes, scripts and pictures does not: leaving the page would still lose the surfaces', async () => {
    const { saving, saved, names } = desk();
    await saving.mesh('stl');
    await saving.script();
    await saving.picture(2);
    expect(names).toEqual(['hood.stl', 'hood.json', 'hood@2x.png']);
    expect(saved()).toBe(0);
  });
});

describe('a Rhino file', () => {
  it('says before it is saved what it does not hold', () => {
    expect(lostInRhino('rhino', [], [])).toBe('');
    expect(lostInRhino(null, [], [])).toBe('');
    expect(lostInRhino('step', [], [])).toBe('Trims, solids, and faces on planes, cylinders and the like are not written.');
    expect(lostInRhino('rhino', ['a', 'b', 'c', 'd'], [])).toMatch(/^“a”, “b”, “c”, “…”: the edges stay/);
    expect(lostInRhino('rhino', [], ['hull'])).toMatch(/^“hull”: the polysurface keeps its old face/);
  });
});

describe('a file with open edges', () => {
  afterEach(() => vi.unstubAllGlobals());
  const press = async (notice: Notice, label: string) => {
    notice.actions!.find((a) => a.label === label)!.act();
    await new Promise((done) => setTimeout(done));
  };

  it('is not saved before the user says that it may have them', async () => {
    const { saving, saved, names, notices } = desk({ deviation: 45.2 });
    expect(await saving.step()).toBe(null);
    expect([names, saved()]).toEqual([[], 0]);
    expect(notices.map(({ text }) => text)).toEqual(['Not saved: one edge parted by 45.2 mm.']);
    expect(notices[0]!.actions!.map(({ label }) => label)).toEqual(['Show them', 'Save with open edges']);
    await press(notices[0]!, 'Save with open edges');
    expect([names, saved()]).toEqual([['hood-sculpted.step'], 1]);
    expect(notices.at(-1)!.text).toBe('Saved with open edges: one edge parted by 45.2 mm.');
  });

  it('in which the engine lets none be open is saved once they are let go', async () => {
    const { saving, names, notices, executed } = desk({ refused: true, deviation: 0.25 });
    expect(await saving.step()).toBe(null);
    expect(notices[0]!.text).toBe('Not saved: edge #7 parted by 0.25 mm.');
    await press(notices[0]!, 'Save with open edges');
    expect(executed).toEqual(letOpen);
    expect(names).toEqual(['hood-sculpted.step']);
  });
});

describe('what is said of the edges of a saved file', () => {
  const edges = (tolerance: number, ...deviations: number[]) =>
    [{ surface: '#1', tolerance, edges: deviations.map((deviation, k) => ({ id: `#${k + 10}`, faces: [], deviation })), unknown: '' }];

  it('is that they are closed to a thousandth of a millimetre, or to what the file takes for closed', () => {
    expect(closedEdges([], 'mm')).toBe('');
    expect(closedEdges(edges(0, 0.0005), 'mm')).toBe('All edges closed to 0.001 mm.');
    expect(closedEdges(edges(0.02, 0.01), 'mm')).toBe('All edges closed to 0.02 mm.');
    expect(closedEdges(edges(0, 0.00003), 'inch')).toBe('All edges closed to 0.001 mm.');
  });

  it('is how many of them are open, and the widest', () => {
    expect(closedEdges(edges(0, 0.0005, 0.002, 0.3), 'mm')).toBe('Saved with open edges: 2 edges parted, the widest by 0.3 mm.');
    expect(closedEdges(edges(0, 0.0005), 'm')).toBe('Saved with open edges: one edge parted by 5e-4 m.');
    expect(partedEdges([...edges(0, 0.1), ...edges(0, 0.2)], 'inch')).toBe('one edge parted by 0.2 in'); // seen from both faces
    expect(partedEdges(edges(0, 0), 'mm')).toBe('');
  });

  it('is why nothing is known of them', () => {
    expect(closedEdges([{ surface: '#1', tolerance: 0, edges: [], unknown: 'a curve is missing' }], 'mm'))
      .toBe('Whether #1 still meets its neighbours is not known: a curve is missing.');
  });
});
