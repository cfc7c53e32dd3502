import type { CheckedEdgeInfo } from '@knead/generated';
import { format, parseLength } from './units';

/** How faces meet, judged: an edge with its surface. */
export interface CheckedEdge extends CheckedEdgeInfo {
  /** Number of the surface that was asked about. */
  surface: number;
}
export type EdgeOrder = 'worst' | 'id' | 'gap' | 'angle' | 'curvature';

const smooth = 0.5; // degrees: what was within this was meant to be smooth
const creased = 0.1; // degrees more than as opened

/** A thousandth of a millimetre in the unit of the file; where that is unknown, nothing. */
export const allowedGap = (unit: string): number => parseLength('0.001mm', unit) ?? 0;

/** Two faces meet there, or more, and not to the tolerance. */
export const gapes = (e: CheckedEdgeInfo, allowed: number): boolean => e.faces.length > 1 && e.gap > allowed;

/** It was smooth when it was opened, and is not any more. */
export const brokeSmooth = (e: CheckedEdgeInfo): boolean =>
  e.angle !== null && e.opened_angle !== null && e.opened_angle <= smooth && e.angle > Math.max(smooth, e.opened_angle + creased);

/** Each edge once; gaps first, then lost smoothness, then what differs most. */
export function ordered(edges: readonly CheckedEdge[], order: EdgeOrder, allowed: number): CheckedEdge[] {
  const once = [...new Map([...edges].reverse().map((e) => [e.id, e])).values()].reverse();
  const number = (id: string) => Number(id.slice(1)) || 0;
  const keys: Record<EdgeOrder, (e: CheckedEdge) => number[]> = {
    worst: (e) => [gapes(e, allowed) ? e.gap : 0, brokeSmooth(e) ? e.angle! : 0, e.unknown ? 1 : 0, e.faces.length > 1 ? e.gap : 0],
    gap: (e) => [e.faces.length > 1 ? e.gap : -1],
    angle: (e) => [e.angle ?? -1],
    curvature: (e) => [e.curvature ?? -1],
    id: (e) => [-number(e.id)],
  };
  const key = keys[order];
  return once.sort((a, b) => {
    const [x, y] = [key(a), key(b)];
    const k = x.findIndex((value, i) => value !== y[i]);
    return k < 0 ? number(a.id) - number(b.id) : y[k]! - x[k]!;
  });
}

/** What a designer wants to know first. */
export function edgesInWords(edges: readonly CheckedEdgeInfo[], unit: string): string {
  const allowed = allowedGap(unit);
  const meeting = edges.filter((e) => e.faces.length > 1 && !e.unknown);
  const bound = edges.filter((e) => e.faces.length < 2 && !e.unknown).length;
  const open = meeting.filter((e) => gapes(e, allowed));
  const sharp = meeting.filter(brokeSmooth).length;
  const unknown = edges.filter((e) => e.unknown).length;
  const count = (n: number, one: string, many = `${one}s`) => `${n} ${n === 1 ? one : many}`;
  const worst = open.reduce((most, e) => Math.max(most, e.gap), 0);
  const said: string[] = [];
  if (meeting.length > 0 && open.length === 0) said.push('All edges closed to 0.001 mm.');
  if (open.length > 0) said.push(`${count(open.length, 'edge is', 'edges are')} open by more than 0.001 mm, the widest by ${format(worst)} ${unit}.`);
  if (sharp > 0) said.push(`${count(sharp, 'edge that was', 'edges that were')} smooth ${sharp === 1 ? 'has' : 'have'} a crease.`);
  if (bound > 0) said.push(`${count(bound, 'edge bounds', 'edges bound')} one face only.`);
  if (unknown > 0) said.push(`${count(unknown, 'edge')} could not be checked.`);
  return said.join(' ');
}
