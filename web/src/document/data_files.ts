import { toBase64 } from './base64';

/** What the faces of a document can follow (docs/morph.md). */
export const dataKinds = ['scan', 'vectors', 'pair'] as const;
export type DataKind = (typeof dataKinds)[number];

/** A file of points: what it seems to be, and how many points it has, where that is told from a glance. */
export interface DataFile {
  name: string;
  bytes: Uint8Array;
  kind: DataKind;
  /** A mesh may be one of two. */
  mesh: boolean;
  points: number | null;
}

export const dataEndings = ['.xyz', '.csv', '.txt', '.asc', '.stl', '.obj', '.ply', '.vtk', '.vtu', '.vtp'] as const;
export const isDataName = (name: string): boolean => dataEndings.some((ending) => name.toLowerCase().endsWith(ending));

const glance = 200_000; // characters that say what a file is
const unit = 0.02; // by how much lengths of normals may differ from 1

const numbersIn = (line: string): number[] | null => {
  const words = line.split(/[\s,;]+/).filter(Boolean).map(Number);
  return words.length > 0 && words.every(Number.isFinite) ? words : null;
};
const linesOf = (text: string): string[] => text.split(/\r\n|\r|\n/).map((line) => line.replace(/#.*/, '').trim());
/** Whole lines. */
function startOf(bytes: Uint8Array): string {
  const text = new TextDecoder('latin1').decode(bytes.subarray(0, glance));
  return bytes.length > glance && text.includes('\n') ? text.slice(0, text.lastIndexOf('\n')) : text;
}

/** Lines of numbers: six of which the last three are not all of length 1 are displacements, others points. */
function kindOfLines(text: string): DataKind {
  const lines = linesOf(text).filter(Boolean);
  if (lines[0] && !numbersIn(lines[0])) return /\bd[xyz]\b/i.test(lines[0]) ? 'vectors' : 'scan'; // the names of columns
  const rows = lines.flatMap((line) => [numbersIn(line) ?? []]).filter((row) => row.length >= 6);
  const normals = rows.every(([, , , x, y, z]) => Math.abs(Math.hypot(x!, y!, z!) - 1) < unit);
  return rows.length > 0 && !normals ? 'vectors' : 'scan';
}

/** Whether a CSV file holds points, with names of columns or without: the net of a surface has an empty line between its rows. */
export function isTableOfPoints(bytes: Uint8Array): boolean {
  const lines = linesOf(startOf(bytes));
  const first = lines.find(Boolean) ?? '', columns = numbersIn(first);
  if (!columns) return /\bx\b.*\by\b.*\bz\b/i.test(first);
  const last = lines.map(Boolean).lastIndexOf(true);
  return columns.length === 6 || (columns.length === 3 && !lines.slice(0, last).includes(''));
}

/** How many lines begin with a word, blanks before it aside. */
function countLines(bytes: Uint8Array, word: string): number {
  const letters = new TextEncoder().encode(word);
  const blank = (byte: number | undefined) => byte === 32 || byte === 9;
  let found = 0;
  for (let at = 0; at < bytes.length;) {
    while (blank(bytes[at])) ++at;
    if (letters.every((letter, k) => bytes[at + k] === letter) && blank(bytes[at + letters.length])) ++found;
    const end = bytes.indexOf(10, at);
    at = end < 0 ? bytes.length : end + 1;
  }
  return found;
}

/** Points of a mesh, where its text says so. */
function pointsOf(bytes: Uint8Array, name: string): number | null {
  const start = startOf(bytes);
  const said = /element vertex (\d+)/.exec(start) ?? /^POINTS\s+(\d+)/m.exec(start) ?? /NumberOfPoints="(\d+)"/.exec(start);
  if (said) return Number(said[1]);
  if (/\.obj$/i.test(name)) return countLines(bytes, 'v');
  if (/\.stl$/i.test(name)) { // corners of triangles: of two meshes alike there are as many
    const triangles = bytes.length >= 84 ? new DataView(bytes.buffer, bytes.byteOffset).getUint32(80, true) : 0;
    return bytes.length === 84 + 50 * triangles ? 3 * triangles : countLines(bytes, 'vertex');
  }
  return null;
}

/** What a file of data seems to be, by its content. */
export function dataFile(name: string, bytes: Uint8Array): DataFile {
  const start = startOf(bytes);
  const vtk = /\.vt[kup]$/i.test(name);
  const mesh = vtk || /\.(stl|obj|ply)$/i.test(name);
  const field = vtk && (/^POINT_DATA[^]*^(VECTORS|FIELD)\b/m.test(start) || /<PointData[^>]*>[^]*NumberOfComponents="3"[^]*<\/PointData>/.test(start));
  return { name, bytes, mesh, kind: field ? 'vectors' : mesh ? 'scan' : kindOfLines(start), points: mesh ? pointsOf(bytes, name) : null };
}

/** The data after another file has come: it takes the place of those before, or is the second mesh of a pair. */
export function withFile(files: readonly DataFile[], kind: DataKind, next: DataFile): { files: DataFile[]; kind: DataKind } {
  const [first, second] = files;
  const waits = kind === 'pair' && first !== undefined && second === undefined;
  const alike = files.length === 1 && kind === 'scan' && first!.mesh && next.mesh && next.kind === 'scan' && first!.points !== null && first!.points === next.points;
  return waits || alike ? { files: [first!, next], kind: 'pair' } : { files: [next], kind: next.kind };
}

/** By the names of the fields of the command and of the query; null as long as something is missing. */
export function byField<T>(files: readonly DataFile[], kind: DataKind, as: (bytes: Uint8Array) => T): Partial<Record<'scan' | 'vectors' | 'from' | 'to', T>> | null {
  const [first, second] = files;
  if (!first || (kind === 'pair' && !second)) return null;
  return kind === 'pair' ? { from: as(first.bytes), to: as(second!.bytes) } : { [kind]: as(first.bytes) };
}

/** As the command takes it: text as it is, other bytes as base64. */
export function textOf(bytes: Uint8Array): string {
  try {
    const text = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(bytes);
    if (!text.includes('\0') && !text.startsWith('base64:')) return text;
  } catch {
    // It is no text.
  }
  return `base64:${toBase64(bytes)}`;
}
