import { allowedGap, brokeSmooth, type CheckedEdge, edgesInWords, gapes, ordered } from '@studio/document/edge_checks';

const edge = (id: string, gap: number, angle: number | null, more: Partial<CheckedEdge> = {}): CheckedEdge =>
  ({ id, faces: ['#1', '#2'], gap, opened_gap: 0, angle, opened_angle: angle, curvature: null, opened_curvature: null, unknown: '', surface: 0, ...more });

describe('edges of faces', () => {
  const closed = edge('#10', 1e-7, 90), wide = edge('#12', 0.4, 0), narrow = edge('#11', 0.002, 0);
  const creased = edge('#13', 0, 3, { opened_angle: 0.01 }), sharp = edge('#9', 0, 88, { opened_angle: 90 });
  const bound = edge('#8', 0.5, null, { faces: ['#1'] });
  const all = [closed, wide, narrow, creased, sharp, bound];

  it('stand in the order of what is worst', () => {
    expect(ordered(all, 'worst', 0.001).map((e) => e.id)).toEqual(['#12', '#11', '#13', '#10', '#8', '#9']);
    expect(ordered(all, 'gap', 0.001).map((e) => e.id).slice(0, 2)).toEqual(['#12', '#11']);
    expect(ordered(all, 'angle', 0.001).map((e) => e.id).slice(0, 3)).toEqual(['#10', '#9', '#13']);
    const bent = [edge('#14', 0, 0, { curvature: 0.02 }), edge('#15', 0, 0, { curvature: 0.5 }), closed];
    expect(ordered(bent, 'curvature', 0.001).map((e) => e.id)).toEqual(['#15', '#14', '#10']);
    expect(ordered(all, 'id', 0.001).map((e) => e.id)).toEqual(['#8', '#9', '#10', '#11', '#12', '#13']);
  });

  it('that two selected faces share stand there once', () => {
    expect(ordered([closed, wide, { ...closed, surface: 1 }], 'worst', 0.001).map((e) => [e.id, e.surface])).toEqual([['#12', 0], ['#10', 0]]);
  });

  it('are told in a sentence or two', () => {
    expect(edgesInWords([closed, sharp], 'mm')).toBe('All edges closed to 0.001 mm.');
    expect(edgesInWords([wide, closed], 'mm')).toBe('1 edge is open by more than 0.001 mm, the widest by 0.4 mm.');
    expect(edgesInWords(all, 'mm')).toBe(
      '2 edges are open by more than 0.001 mm, the widest by 0.4 mm. 1 edge that was smooth has a crease. 1 edge bounds one face only.');
    expect(edgesInWords([edge('#1', 0, null, { unknown: 'a curve of an unknown type' })], 'mm')).toBe('1 edge could not be checked.');
  });

  it('are judged in the unit of the file', () => {
    expect(allowedGap('inch')).toBeCloseTo(0.001 / 25.4, 15);
    expect(gapes(narrow, allowedGap('mm'))).toBe(true);
    expect(gapes(narrow, allowedGap('m'))).toBe(true);
    expect(gapes(edge('#1', 0.0009, 0), allowedGap('mm'))).toBe(false);
    expect(gapes(bound, allowedGap('mm'))).toBe(false);
    expect([creased, sharp, closed, bound].map(brokeSmooth)).toEqual([true, false, false, false]);
  });
});
