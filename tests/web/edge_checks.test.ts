import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import type { EdgeCheck, EdgeMeasures } from '@knead/generated';
import {
  figureOf, isAbove, isFault, type Judging, limitOf, measures, mostOf, ordered, rejudged, reportJson, requestAgainst, requestOf, shareOf, shown, suffix, thresholdsOf, verdict, worstBy,
} from '@studio/document/edge_checks';

const root = fileURLToPath(new URL('../..', import.meta.url));
const wasm = readFileSync(join(root, 'web/src/engine/knead_studio.wasm'));
const bonnet = new Uint8Array(readFileSync(join(root, 'samples/bonnet.step')));

const at = (value: number) => ({ value, at: { point: [1, 2, 3] as [number, number, number], parameters: [] } });
const edge = (id: string, kind: EdgeMeasures['kind'], gap: number, angle: number | null, more: Partial<EdgeMeasures> = {}): EdgeMeasures => ({
  id, kind, faces: ['#1', '#2'], length: 1, start: [0, 0, 0], middle: [0.5, 0, 0], end: [1, 0, 0], gap: at(gap), off_curve: at(gap / 2), angle: angle === null ? null : at(angle),
  least_angle: angle, smooth_share: 0, curvature: null, relative_curvature: null, samples: 17, course: [[0, 0, 0], [1, 0, 0]], ...more,
});
const judging = (change: Partial<Judging>): Judging => ({ grade: 'none', gap: null, angle: null, curvature: null, unit: 'mm', ...change });
const closed = edge('#10', 'sharp', 1e-7, 90), wide = edge('#12', 'gap', 0.4, 1), creased = edge('#13', 'G0', 0, 3);
const bent = edge('#14', 'G1', 0, 0, { relative_curvature: at(60) }), open = edge('#15', 'open', 0.03, null, { faces: ['#1'] });
const unknown = edge('#16', 'unknown', 0, null, { reason: 'a curve of an unknown type', gap: null, off_curve: null });
const corner = edge('#17', 'non-manifold', 0, 2);
const report: EdgeCheck = {
  file: 'x.step', format: 'STEP', unit: 'mm', thresholds: { gap: null, angle: null, curvature: null }, passed: true, size: 100, gap_tolerance: 1e-4, angle_tolerance: 0.1,
  curvature_tolerance: 5, counts: [], faults: [], edges: [closed, wide, creased, bent, open, unknown, corner],
};
const ids = (edges: readonly EdgeMeasures[]) => edges.map(({ id }) => id);

describe('edges of a report', () => {
  it('have a limit by what they are', () => {
    const above = (of: EdgeMeasures) => measures.filter((m) => isAbove(report, of, m));
    expect(report.edges.map(above)).toEqual([[], ['gap', 'angle'], ['angle'], ['curvature'], ['gap'], [], []]);
    expect(measures.map((m) => limitOf(report, m))).toEqual([1e-4, 0.1, 5]); // the tolerances stand for limits
    const strict = rejudged(report, { gap: 0.5, angle: 3.5, curvature: 80 });
    expect(strict.edges.flatMap((e) => measures.filter((m) => isAbove(strict, e, m)))).toEqual([]);
  });

  it('stand in the order of what is worst, or of a column', () => {
    expect(ids(ordered(report, 'worst', 'all'))).toEqual(['#12', '#15', '#13', '#14', '#10', '#16', '#17']); // 4000, 300, 30 and 12 times their limits
    expect(ids(ordered(report, 'gap', 'all')).slice(0, 3)).toEqual(['#12', '#15', '#10']);
    expect(ids(ordered(report, 'angle', 'all')).slice(0, 4)).toEqual(['#10', '#13', '#17', '#12']);
    expect(ids(ordered(report, 'id', 'all'))).toEqual(ids(report.edges));
    expect(ids(ordered(report, 'worst', 'open'))).toEqual(['#15']);
  });

  it('are judged only by what has a limit, where anything has', () => {
    const angles = rejudged(report, { gap: null, angle: 0.5, curvature: null });
    expect(angles.edges.map((e) => measures.filter((m) => isFault(angles, e, m)))).toEqual([[], ['angle'], ['angle'], [], [], [], []]);
    expect(isAbove(angles, wide, 'gap')).toBe(true); // the tolerance colours it all the same
    expect(ids(ordered(angles, 'worst', 'all')).slice(0, 3)).toEqual(['#13', '#12', '#10']);
    expect(report.edges.some((e) => measures.some((m) => isFault(report, e, m)))).toBe(false);
  });

  it('with nothing to compare them with are infinitely worse than a limit of 0', () => {
    const zero = rejudged(report, { gap: 0, angle: null, curvature: null });
    expect(ids(ordered(zero, 'worst', 'all')).slice(0, 3)).toEqual(['#10', '#12', '#15']);
    expect(shareOf(zero, wide, 'gap', mostOf(zero, 'gap'))).toBe(1);
  });

  it('have their gap where it is wider, between the faces or at the curve', () => {
    const off = edge('#1', 'G2', 1, 0, { off_curve: at(2) });
    expect(figureOf(off, 'gap')).toBe(off.off_curve);
    expect(figureOf(wide, 'gap')).toBe(wide.gap);
    expect([shown(report, wide, 'gap'), shown(report, edge('#1', 'G2', 2e-6, 0), 'gap'), shown(report, open, 'angle')]).toEqual(['0.4', '2e-6', '–']);
    expect(shown(report, edge('#1', 'G2', 1e-8, 1e-9), 'gap')).toBe('0'); // rounding, for a model of that size
    expect(shown(report, edge('#1', 'G2', 1e-8, 1e-9), 'angle')).toBe('0');
  });

  it('are coloured from the limit to the largest value, by ratios', () => {
    const most = mostOf(report, 'gap');
    expect(most).toBe(0.4);
    expect(shareOf(report, wide, 'gap', most)).toBe(1);
    expect(shareOf(report, edge('#1', 'gap', Math.sqrt(0.4 * 1e-4), 0), 'gap', most)).toBeCloseTo(0.5, 12);
    expect(shareOf(report, closed, 'gap', most)).toBeNull();
    expect(ids(worstBy(report, 'gap'))).toEqual(['#12', '#15']);
    expect(ids(worstBy(report, 'gap', 1))).toEqual(['#12']);
    expect(measures.map((m) => suffix(m, 'mm'))).toEqual([' mm', '°', ' %']);
    expect(suffix('gap', 'unknown')).toBe('');
  });

  it('are judged in a sentence', () => {
    expect(verdict(report, 'none', null)).toBe('7 edges, not judged: choose a class or limits.');
    const by = (change: Partial<Judging>) => rejudged(report, thresholdsOf(judging(change), 'mm')!);
    expect(verdict(by({ grade: 'b' }), 'b', null)).toBe('Failed class B, gap 0.02 mm, angle 0.2°: 3 of 7 edges, 2 by gap, 2 by angle.');
    expect(verdict(by({ grade: 'own', gap: 1 }), 'own', [])).toBe('Passed gap 1 mm: no edge of 7 exceeds it. None is worse than as opened.');
    const fault = { edge: '#12', measure: 'gap', value: 1, limit: 0, before: 0 };
    expect(verdict(by({ grade: 'own', gap: 1 }), 'own', [fault, { ...fault, measure: 'angle' }])).toMatch(/ 1 edge is worse than as opened\.$/);
    expect(verdict({ ...report, edges: [] }, 'b', null)).toBe('The document has no edges of faces.');
  });

  it('are written without what is for drawing', () => {
    const written = JSON.parse(reportJson(report)) as EdgeCheck;
    expect(written.edges.map(({ id }) => id)).toEqual(ids(report.edges));
    expect(written.edges.some((e) => 'course' in e)).toBe(false);
  });
});

it('limits are asked for as of the program, in the unit of the file', () => {
  expect(requestOf(judging({ gap: 1, curvature: 2 }), 'mm')).toEqual({ courses: true });
  expect(requestOf(judging({ grade: 'a', gap: 1, curvature: 2 }), 'mm')).toEqual({ courses: true, class: 'a', curvature: 2 });
  expect(requestOf(judging({ grade: 'a', unit: 'inch' }), 'unknown')).toEqual({ courses: true, class: 'a', unit: 'inch' });
  expect(requestOf(judging({ grade: 'own', gap: 0, angle: 1 }), 'mm')).toEqual({ courses: true, gap: 0, angle: 1 });
  expect(thresholdsOf(judging({ grade: 'a' }), 'inch')!.gap).toBeCloseTo(0.01 / 25.4, 15);
  expect(thresholdsOf(judging({ grade: 'a', unit: 'cm' }), 'unknown')).toEqual({ gap: 0.001, angle: 0.1, curvature: null });
  expect(thresholdsOf(judging({ grade: 'a' }), 'parsec')).toBeNull();
  const against = new Uint8Array(3);
  expect(requestAgainst(rejudged(report, { gap: 2, angle: null, curvature: null }), against)).toEqual({ gap: 2, angle: 0.1, curvature: 5, against });
});

describe('a file', () => {
  it('is judged by other limits at once as the engine judges it', async () => {
    const engine = await Engine.load(wasm);
    engine.query('open', { file: bonnet, name: 'bonnet.step' });
    engine.query('act', { commands: [{ do: 'select', surface: '#285' }, { do: 'hold', mode: 'open' }, { do: 'points', rows_u: [0, 1, 2], by: [0, 0, 0.03] }] });
    const first = engine.query('check', requestOf(judging({ grade: 'none' }), 'mm'));
    expect(first.edges.length).toBe(16);
    const failed: number[] = [];
    for (const change of [{ grade: 'a' }, { grade: 'b' }, { grade: 'c' }, { grade: 'a', curvature: 1 }, { grade: 'own', gap: 0 }, { grade: 'own', angle: 0.5, gap: 1e-5 }] as const) {
      const asked = judging(change);
      const engineSays = engine.query('check', requestOf(asked, 'mm'));
      const said = rejudged(first, thresholdsOf(asked, 'mm')!);
      expect(said.thresholds).toEqual(engineSays.thresholds);
      expect(said.faults).toEqual(engineSays.faults);
      expect(said.passed).toBe(engineSays.passed);
      failed.push(said.faults.length);
    }
    expect(failed[0]).toBeGreaterThan(0);
    expect(failed[2]).toBe(0); // 0.03 mm
  });

  it('has the course of every edge only where it is asked for', async () => {
    const engine = await Engine.load(wasm);
    engine.query('open', { file: bonnet, name: 'bonnet.step' });
    const drawn = engine.query('check', { courses: true });
    for (const { course, start, end } of drawn.edges) expect([course![0], course!.at(-1)]).toEqual([start, end]);
    const plain = engine.query('check');
    expect(plain.edges.map(({ course }) => course)).toEqual(plain.edges.map(() => undefined));
    expect(JSON.parse(reportJson(drawn))).toEqual(plain);
  });
});
