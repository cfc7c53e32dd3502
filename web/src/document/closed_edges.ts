import type { EdgesInfo } from '@knead/generated';
import { format, parseLength } from './units';

/** Whether the faces of a saved file still meet, in words; empty if none was moved. Lengths of `surfaces` in `unit`. */
export function closedEdges(surfaces: readonly EdgesInfo[], unit: string): string {
  const said = surfaces.filter((s) => s.unknown).map((s) => `Whether ${s.surface} still meets its neighbours is not known: ${s.unknown}.`);
  const thousandth = parseLength('0.001mm', unit) ?? 0;
  const edges = surfaces.flatMap((s) => s.edges.map((e) => ({ ...e, allowed: Math.max(s.tolerance, thousandth) })));
  const open = edges.filter((e) => e.deviation > e.allowed).sort((a, b) => b.deviation - a.deviation);
  const length = (value: number) => `${format(value)} ${unit}`;
  if (open.length > 0) {
    const some = open.slice(0, 3).map((e) => `${e.id} (${length(e.deviation)})`).join(', ');
    const count = open.length === 1 ? 'One edge is' : `${open.length} edges are`;
    said.unshift(`${count} open: ${some}${open.length > 3 ? ', …' : ''}.`);
  } else if (edges.length > 0) {
    const allowed = Math.max(...edges.map((e) => e.allowed));
    said.unshift(`All edges closed to ${allowed === thousandth ? '0.001 mm' : length(allowed)}.`);
  }
  return said.join(' ');
}
