import type { EdgesInfo } from '@knead/generated';
import { format, parseLength, unitInWords } from './units';

/** Edges of a saved file, each once with its largest deviation, the widest first, and what of that is still taken for closed. */
function deviating(surfaces: readonly EdgesInfo[], unit: string) {
  const thousandth = parseLength('0.001mm', unit) ?? 0;
  const edges = new Map<string, { deviation: number; allowed: number }>();
  for (const { edges: all, tolerance } of surfaces) {
    for (const { id, deviation } of all) {
      const known = edges.get(id);
      if (!known || deviation > known.deviation) edges.set(id, { deviation, allowed: Math.max(tolerance, thousandth) });
    }
  }
  return { thousandth, edges: [...edges.values()].sort((a, b) => b.deviation - a.deviation) };
}

/** How many edges of a file would be open, and how wide; empty where none is. Lengths of `surfaces` in `unit`. */
export function partedEdges(surfaces: readonly EdgesInfo[], unit: string): string {
  const open = deviating(surfaces, unit).edges.filter((e) => e.deviation > e.allowed);
  if (open.length === 0) return '';
  const widest = `${format(open[0]!.deviation)} ${unitInWords(unit)}`;
  return open.length === 1 ? `one edge parted by ${widest}` : `${open.length} edges parted, the widest by ${widest}`;
}

/** Whether the faces of a saved file still meet, in words; empty if none was moved. Lengths of `surfaces` in `unit`. */
export function closedEdges(surfaces: readonly EdgesInfo[], unit: string): string {
  const said = surfaces.filter((s) => s.unknown).map((s) => `Whether ${s.surface} still meets its neighbours is not known: ${s.unknown}.`);
  const { edges, thousandth } = deviating(surfaces, unit);
  const parted = partedEdges(surfaces, unit);
  if (parted) said.unshift(`Saved with open edges: ${parted}.`);
  else if (edges.length > 0) {
    const allowed = Math.max(...edges.map((e) => e.allowed));
    said.unshift(`All edges closed to ${allowed === thousandth ? '0.001 mm' : `${format(allowed)} ${unitInWords(unit)}`}.`);
  }
  return said.join(' ');
}
