// What saving means for the question whether work would be lost.
import { closedEdges } from '@studio/document/closed_edges';
import type { Documents } from '@studio/document/documents';
import type { Host } from '@studio/document/host';
import { Saving } from '@studio/document/saving';

/** How often a document has become a saved one, and the names of its downloads. */
function desk(): { saving: Saving; saved: () => number; names: string[] } {
  const names: string[] = [];
  let saved = 0;
  const link = () => ({ href: '', download: '', click() { names.push(this.download); } });
  vi.stubGlobal('document', { createElement: link });
  vi.stubGlobal('URL', { createObjectURL: () => 'blob:', revokeObjectURL: () => undefined });
  const client = {
    query: async (name: string) => (name === 'save' ? { file: new Uint8Array(1), edges: [] } : new Uint8Array(1)),
    snapshot: async () => ({ snapshot: new Uint8Array(1), journal: '[]' }),
  };
  const host = {
    client, state: { tools: [], last: null, surfaces: [], fresh: false }, computedTime: 0, detail: 8,
    notify: () => undefined, picture: async () => new Blob(),
    attempt: async (act: () => Promise<void>) => { await act(); return true as const; },
  };
  const documents = { name: 'hood.step', file: null, place: null, views: [], saved: () => ++saved };
  return { saving: new Saving(host as never as Host, documents as never as Documents), saved: () => saved, names };
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

describe('what is said of the edges of a saved file', () => {
  const edges = (tolerance: number, ...deviations: number[]) =>
    [{ surface: '#1', tolerance, edges: deviations.map((deviation, k) => ({ id: `#${k + 10}`, faces: [], deviation })), unknown: '' }];

  it('is that they are closed to a thousandth of a millimetre, or to what the file takes for closed', () => {
    expect(closedEdges([], 'mm')).toBe('');
    expect(closedEdges(edges(0, 0.0005), 'mm')).toBe('All edges closed to 0.001 mm.');
    expect(closedEdges(edges(0.02, 0.01), 'mm')).toBe('All edges closed to 0.02 mm.');
    expect(closedEdges(edges(0, 0.00003), 'inch')).toBe('All edges closed to 0.001 mm.');
  });

  it('is which of them are open, the widest first', () => {
    expect(closedEdges(edges(0, 0.0005, 0.002, 0.3), 'mm')).toBe('2 edges are open: #12 (0.3 mm), #11 (0.002 mm).');
    expect(closedEdges(edges(0, 0.0005), 'm')).toBe('One edge is open: #10 (5e-4 m).');
  });

  it('is why nothing is known of them', () => {
    expect(closedEdges([{ surface: '#1', tolerance: 0, edges: [], unknown: 'a curve is missing' }], 'mm'))
      .toBe('Whether #1 still meets its neighbours is not known: a curve is missing.');
  });
});
