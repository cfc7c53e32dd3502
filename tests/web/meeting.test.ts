import type { SurfaceInfo } from '@studio/engine/session_types';
import { heldInWords, heldTogether, meetingAt } from '@studio/tools/held';

const edge = (meets: [string, string, string][], seam = false) =>
  ({ id: '#7' as const, course: [], seam, meets: meets.map(([face, surface, form]) => ({ face, surface, form })) });

describe('an edge of a face', () => {
  it('opens where faces of other surfaces stay behind, which are named', () => {
    const meeting = meetingAt(edge([['#1', '#10', 'B_SPLINE_SURFACE_WITH_KNOTS'], ['#2', '#20', 'PLANE']]), '#10');
    expect(meeting).toEqual({ opens: true, follows: true, text: 'Shared with plane #2. Free: a gap opens, because that face stays. Follow: both move together.' });
    expect(meetingAt(edge([['#1', '#10', ''], ['#2', '#20', 'B_SPLINE_SURFACE_WITH_KNOTS'], ['#3', '#30', 'CYLINDRICAL_SURFACE']]), '#10').text)
      .toContain('Shared with face #2 and cylinder #3. Free: a gap opens, because those faces stay. Follow: all move together.');
  });

  it('opens nothing where no other face meets it, and opens where a surface that meets itself leaves it behind', () => {
    expect(meetingAt(edge([['#1', '#10', '']]), '#10')).toMatchObject({ opens: false, follows: true });
    expect(meetingAt(edge([['#1', '#10', '']], true), '#10')).toMatchObject({ opens: true, follows: true });
  });

  it('is counted where it would open, before it does', () => {
    const info = (hold: 'open' | 'follow' | 'position') => ({ hold: 0, pins: 0, constraints: [
      { do: 'hold', mode: 'position' }, { do: 'edge', edge: '#7', hold }] }) as unknown as SurfaceInfo;
    expect(heldInWords(info('position'), ['#7', '#8'], ['#7', '#8'])).toBe('2 edges held');
    expect(heldInWords(info('open'), ['#7', '#8'], ['#7', '#8'])).toBe('1 of 2 edges held, one opens when it moves');
    expect(heldInWords(info('open'), ['#7', '#8'], ['#8'])).toBe('1 of 2 edges held');
    expect(heldInWords(info('follow'), ['#7', '#8'], ['#7', '#8'])).toBe('1 of 2 edges held');
  });

  it('counts once where two selected faces meet, as held if neither lets it go', () => {
    const held = (...constraints: object[]) => ({ hold: 0, pins: 0, constraints }) as unknown as SurfaceInfo;
    const all = { do: 'hold', mode: 'position' }, follow = { do: 'edge', edge: '#7', hold: 'follow' };
    const pair = (first: SurfaceInfo, second: SurfaceInfo) => heldTogether([
      { info: first, edges: ['#6', '#7'], open: ['#7'] }, { info: second, edges: ['#7', '#8', '#9'], open: ['#7', '#8'] }]);
    expect(pair(held(all), held(all))).toBe('4 edges held');
    expect(pair(held(all, follow), held(all, follow))).toBe('3 of 4 edges held');
    expect(pair(held(all, follow), held(follow))).toBe('1 of 4 edges held, one opens when it moves');
    expect(pair(held(all), held())).toBe('1 of 4 edges held, 2 open when it moves');
    expect(pair(held(all), held({ do: 'hold', mode: 'open' }))).toBe('1 of 4 edges held, 2 open when it moves');
  });

  it('is a side of a surface of the file on which no face lies, and no edge at all of a closed one', () => {
    const bare = (...constraints: object[]) => ({ id: '#5', hold: 0, pins: 0, faces: 0, bare: true, constraints }) as unknown as SurfaceInfo;
    const all = { do: 'hold', mode: 'position' }, sides = ['u0', 'u1', 'v0', 'v1'] as const;
    expect(heldInWords(bare(all), sides)).toBe('4 edges held');
    expect(heldInWords(bare(all, { do: 'edge', edge: 'u0', hold: 'open' }), sides)).toBe('3 of 4 edges held');
    expect(heldTogether([{ info: bare(all), edges: sides, open: [] }, { info: { ...bare(all), id: '#6' }, edges: sides, open: [] }])).toBe('8 edges held');
    expect(heldInWords(bare(all), [])).toBe('Its place held');
    expect(heldInWords(bare({ do: 'hold', mode: 'open' }), [])).toBe('Nothing held');
    expect(heldInWords({ ...bare(all), bare: false }, [])).toBe('Nothing held');
  });
});
