import type { CheckRequest, EdgeCheck, EdgeFault, EdgeFigure, EdgeMeasures, EdgeThresholds } from '@knead/generated';
import { format, parseLength, unitInWords } from './units';

/** What is measured at edges: gap, angle, relative difference in curvature. */
export const measures = ['gap', 'angle', 'curvature'] as const;
export type Measure = (typeof measures)[number];
export type EdgeOrder = 'worst' | 'id' | Measure;
export type EdgeClass = 'none' | 'a' | 'b' | 'c' | 'own';

/** What edges are judged by: a class, or numbers of one's own; a number for curvature goes with both. */
export interface Judging {
  grade: EdgeClass;
  gap: number | null;
  angle: number | null;
  curvature: number | null;
  /** Of the coordinates, where the file does not say it. */
  unit: string;
}

const meantSmooth = 5; // degrees, as the engine's `meant_smooth`
/** Gap in mm and angle in degrees of the classes, as the engine's (docs/check.md). */
const grades = { a: [0.01, 0.1], b: [0.02, 0.2], c: [0.05, 0.5] } as const;
const isGrade = (grade: EdgeClass): grade is keyof typeof grades => grade in grades;
const isUnknown = (unit: string): boolean => unit === '' || unit === 'unknown';

/** As `knead check` is asked. `unit`: of the file. */
export function requestOf({ grade, gap, angle, curvature, unit: given }: Judging, unit: string): CheckRequest {
  const bend = curvature === null ? {} : { curvature };
  if (grade === 'none') return { courses: true };
  if (isGrade(grade)) return { courses: true, class: grade, ...bend, ...(isUnknown(unit) ? { unit: given } : {}) };
  return { courses: true, ...(gap === null ? {} : { gap }), ...(angle === null ? {} : { angle }), ...bend };
}

/** What the engine makes of that; null where a class has no length in the unit of the file. */
export function thresholdsOf({ grade, gap, angle, curvature, unit: given }: Judging, unit: string): EdgeThresholds | null {
  if (grade === 'none') return { gap: null, angle: null, curvature: null };
  if (!isGrade(grade)) return { gap, angle, curvature };
  const length = parseLength(`${grades[grade][0]} mm`, isUnknown(unit) ? given : unit);
  return length === null ? null : { gap: length, angle: grades[grade][1], curvature };
}

/**
 * A report by other thresholds, from the figures that are known. Kinds and counts of edges stay those of the thresholds before,
 * and so do edges that are joined within a tolerance: the engine has the last word.
 */
export function rejudged(report: EdgeCheck, thresholds: EdgeThresholds): EdgeCheck {
  const faults = report.edges.flatMap((edge) => measures.flatMap((measure): EdgeFault[] => {
    const value = valueOf(edge, measure) ?? 0, limit = thresholds[measure];
    return limit !== null && isJudged(edge, measure) && value > limit ? [{ edge: edge.id, measure, value, limit, before: null }] : [];
  }));
  return { ...report, thresholds, faults, passed: faults.length === 0 };
}

/** The same thresholds against an earlier version; where there are none the tolerances stand for them. */
export const requestAgainst = (report: EdgeCheck, against: Uint8Array): CheckRequest => ({
  gap: limitOf(report, 'gap'), angle: limitOf(report, 'angle'), curvature: limitOf(report, 'curvature'), against,
});

/** Where a measure is largest: of gaps between the faces, and between them and the curve, the larger one. */
export function figureOf(edge: EdgeMeasures, measure: Measure): EdgeFigure | null {
  if (measure === 'angle') return edge.angle;
  if (measure === 'curvature') return edge.relative_curvature;
  return edge.gap && edge.off_curve && edge.off_curve.value > edge.gap.value ? edge.off_curve : edge.gap;
}
export const valueOf = (edge: EdgeMeasures, measure: Measure): number | null => figureOf(edge, measure)?.value ?? null;

/** The threshold of a measure, or, where it is not judged, the tolerance. */
export function limitOf({ thresholds, gap_tolerance, angle_tolerance, curvature_tolerance }: EdgeCheck, measure: Measure): number {
  return thresholds[measure] ?? { gap: gap_tolerance, angle: angle_tolerance, curvature: curvature_tolerance }[measure];
}

/** Whether a measure of an edge has a limit: angles and curvatures only where the edge is meant to be smooth. */
export function isJudged({ kind, angle }: EdgeMeasures, measure: Measure): boolean {
  if (measure === 'gap') return kind !== 'unknown';
  return !['unknown', 'open', 'non-manifold'].includes(kind) && angle !== null && angle.value < meantSmooth;
}
export const isAbove = (report: EdgeCheck, edge: EdgeMeasures, measure: Measure): boolean =>
  isJudged(edge, measure) && (valueOf(edge, measure) ?? 0) > limitOf(report, measure);

/** Above a threshold that was asked for, not only above the tolerance. */
export const isFault = (report: EdgeCheck, edge: EdgeMeasures, measure: Measure): boolean =>
  report.thresholds[measure] !== null && isAbove(report, edge, measure);

/** How many times its limit a measure is; 0 where it has none. What has no threshold counts only where nothing has one. */
function times(report: EdgeCheck, edge: EdgeMeasures, measure: Measure): number {
  if (report.thresholds[measure] === null && measures.some((m) => report.thresholds[m] !== null)) return 0;
  const value = isJudged(edge, measure) ? (valueOf(edge, measure) ?? 0) : 0, limit = limitOf(report, measure);
  return value > 0 ? (limit > 0 ? value / limit : Infinity) : 0;
}

/** The edges of a kind, or all with "all", in an order: the worst are the largest multiples of their limits. */
export function ordered(report: EdgeCheck, order: EdgeOrder, kind: string): EdgeMeasures[] {
  const key = (edge: EdgeMeasures): number => {
    if (order === 'worst') return Math.max(...measures.map((m) => times(report, edge, m)));
    return order === 'id' ? 0 : (valueOf(edge, order) ?? -1);
  };
  const kept = report.edges.map((edge, at) => ({ edge, at, key: key(edge) })).filter(({ edge }) => kind === 'all' || edge.kind === kind);
  return kept.sort((a, b) => (a.key === b.key ? a.at - b.at : b.key - a.key)).map(({ edge }) => edge);
}

/** The edges with the largest excess over the limit of a measure, at most `count`. */
export const worstBy = (report: EdgeCheck, measure: Measure, count = 5): EdgeMeasures[] =>
  report.edges.filter((e) => isAbove(report, e, measure)).sort((a, b) => valueOf(b, measure)! - valueOf(a, measure)!).slice(0, count);

/** "°", "%" or the unit of the file after a space. */
export const suffix = (measure: Measure, unit: string): string =>
  ({ gap: isUnknown(unit) ? '' : ` ${unitInWords(unit)}`, angle: '°', curvature: ' %' })[measure];

/** What is rounding for the model is 0. */
export function shown(report: EdgeCheck, edge: EdgeMeasures, measure: Measure): string {
  const value = valueOf(edge, measure);
  if (value === null) return '–';
  const nothing = { gap: 1e-9 * report.size, angle: 1e-6, curvature: 1e-3 }[measure];
  return format(value < nothing ? 0 : value);
}

const counted = (n: number, one: string, many = `${one}s`) => `${n} ${n === 1 ? one : many}`;

/** The verdict in one line. `worse`: against the file as it was opened; null: not compared. */
export function verdict(report: EdgeCheck, grade: EdgeClass, worse: readonly EdgeFault[] | null): string {
  const { thresholds, faults, edges, unit } = report;
  if (edges.length === 0) return 'The document has no edges of faces.';
  const limits = measures.filter((m) => thresholds[m] !== null).map((m) => `${m} ${format(thresholds[m]!)}${suffix(m, unit)}`).join(', ');
  const of = isGrade(grade) ? `class ${grade.toUpperCase()}, ` : '';
  const bad = new Set(faults.map(({ edge }) => edge)).size;
  const by = measures.map((m) => [m, faults.filter((f) => f.measure === m).length] as const).filter(([, n]) => n > 0).map(([m, n]) => `${n} by ${m}`);
  const said = !limits ? `${counted(edges.length, 'edge')}, not judged: choose a class or limits.`
    : bad === 0 ? `Passed ${of}${limits}: no edge of ${edges.length} exceeds it.`
    : `Failed ${of}${limits}: ${bad} of ${counted(edges.length, 'edge')}, ${by.join(', ')}.`;
  const lost = worse === null ? 0 : new Set(worse.map(({ edge }) => edge)).size;
  return worse === null ? said : `${said} ${lost === 0 ? 'None is worse than as opened.' : `${counted(lost, 'edge is', 'edges are')} worse than as opened.`}`;
}

/** How far from its limit towards the largest value that there is: 0 to 1, by ratios. Null: within the limit, or not judged. */
export function shareOf(report: EdgeCheck, edge: EdgeMeasures, measure: Measure, most: number): number | null {
  if (!isAbove(report, edge, measure)) return null;
  const value = valueOf(edge, measure)!, limit = limitOf(report, measure);
  if (limit <= 0) return value / most;
  return most > limit ? Math.log(value / limit) / Math.log(most / limit) : 1;
}

/** The largest value among those above the limit; the limit where there are none. */
export const mostOf = (report: EdgeCheck, measure: Measure): number =>
  report.edges.reduce((most, e) => (isAbove(report, e, measure) ? Math.max(most, valueOf(e, measure)!) : most), limitOf(report, measure));

/** Seen apart also without red or green: amber, orange, magenta, violet, each darker than the one before. */
export const ramp = ['#ffb000', '#fe6100', '#dc267f', '#785ef0'] as const;

/** The JSON of `knead check --json`. */
export function reportJson(report: EdgeCheck): string {
  return `${JSON.stringify({ ...report, edges: report.edges.map(({ course: _, ...edge }) => edge) }, null, 2)}\n`;
}
