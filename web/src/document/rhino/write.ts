import type { Rhino, RhinoAttributes, RhinoBrep, RhinoFile, RhinoGeometry, RhinoNurbs, RhinoSurface } from './module';
import { exchanged, placesOf } from './archive';
import { movePoints, nurbsOf, type Patch, samePatch, sameSpace } from './patch';
import { openRhino, readRhino, rhinoUnits, type RhinoSource } from './read';

export interface Written {
  bytes: Uint8Array;
  /** Surfaces that are now separate from the solid they are a face of, by name. */
  beside: string[];
  /** Surfaces that were exchanged under a face of a polysurface or a trimmed one, whose edges stay where they are. */
  within: string[];
}

const newest = 8;

/** A new file of these surfaces. */
export function writeRhino(rhino: Rhino, surfaces: { name: string; patch: Patch }[], unit: string): Written {
  const file = new rhino.File3dm();
  file.settings().modelUnitSystem = rhino.UnitSystem[rhinoUnits[unit] ?? 'Millimeters'];
  for (const { name, patch } of surfaces) addSurface(rhino, file, name, patch);
  return { bytes: bytesOf(rhino, file, newest), beside: [], within: [] };
}

function addSurface(rhino: Rhino, file: RhinoFile, name: string, patch: Patch): void {
  const attributes = new rhino.ObjectAttributes();
  attributes.name = name;
  file.objects().add(nurbsOf(rhino, patch), attributes);
}

/**
 * The file as it was opened with these shapes in place of its surfaces, one each in the order of `readRhino`, and
 * further ones added; surfaces that did not change, and everything else, stay as they are. The version of the file stays.
 *
 * A surface object keeps its attributes and its place; its control points are set, or, where knots or degree have
 * changed, the object is replaced. A polysurface of one untrimmed face is replaced by one of the new surface. rhino3dm gives
 * no other face to write to: under one among several, or a trimmed one, the control points are exchanged in the bytes of the
 * file, so that its trims stay. Where these are not the numbers of the surface (other knots, a plane, a surface that is found
 * twice; `refused`: by their numbers) the new surface is added with the attributes of the polysurface, which stays.
 */
export function rewriteRhino(rhino: Rhino, source: Uint8Array, surfaces: { name: string; patch: Patch }[], refused: ReadonlySet<number> = new Set()): Written {
  const file = openRhino(rhino, source);
  const { surfaces: opened } = readRhino(rhino, file);
  if (surfaces.length < opened.length) throw new Error('surfaces of the file are missing; save a new file instead');
  const objects = file.objects();
  const beside: string[] = [];
  const replaced: { attributes: RhinoAttributes; geometry: RhinoGeometry }[] = [];
  const added: { attributes: RhinoAttributes; geometry: RhinoGeometry; name: string }[] = [];
  const inPlace: { k: number; was: Float64Array; now: Float64Array; among: [number, number] }[] = [];
  let touched = surfaces.length > opened.length;
  opened.forEach((before, k) => {
    const { patch } = surfaces[k]!;
    if (samePatch(before.patch, patch)) return;
    const within = refused.has(k) ? null : exchange(file, opened, k, patch);
    if (within && putInto(source, within)) {
      inPlace.push({ k, ...within });
      return;
    }
    touched = true;
    const geometry = objects.get(before.object).geometry(), attributes = objects.get(before.object).attributes();
    if (geometry instanceof rhino.NurbsSurface && sameSpace(before.patch, patch)) {
      movePoints(geometry.points(), before.patch, patch);
      return;
    }
    if (before.face === null) {
      replaced.push({ attributes, geometry: exactly(rhino, geometry, before, patch) });
      return;
    }
    const face = (geometry as RhinoBrep).faces().get(before.face);
    const nurbs = exactly(rhino, face.underlyingSurface(), before, patch);
    if ((geometry as RhinoBrep).isSurface) {
      const brep = rhino.Brep.createFromSurface(nurbs);
      if (face.orientationIsReversed) brep.flip();
      replaced.push({ attributes, geometry: brep });
    } else {
      added.push({ attributes, geometry: nurbs, name: `${before.name} (sculpted)` });
      beside.push(before.name);
    }
  });
  for (const { attributes, geometry, name } of added) {
    const id = objects.add(geometry, attributes); // with an id of its own
    objects.findId(id).attributes().name = name;
  }
  for (const { attributes, geometry } of replaced) {
    objects.delete(attributes.id); // its id is free for the new one then
    objects.add(geometry, attributes);
  }
  for (const { name, patch } of surfaces.slice(opened.length)) addSurface(rhino, file, name, patch);
  const version = file.archiveVersion >= 50 ? file.archiveVersion / 10 : file.archiveVersion;
  let bytes = touched ? bytesOf(rhino, file, Math.min(newest, Math.max(2, version))) : source;
  for (const one of inPlace) {
    const next = putInto(bytes, one);
    if (!next) return rewriteRhino(rhino, source, surfaces, new Set([...refused, one.k]));
    bytes = next;
  }
  // What was written is read: the surface is the new one, or it is added beside the polysurface after all.
  const wrong = inPlace.length > 0 ? missing(rhino, bytes, inPlace.map(({ k }) => ({ k, patch: surfaces[k]!.patch }))) : [];
  if (wrong.length > 0) return rewriteRhino(rhino, source, surfaces, new Set([...refused, ...wrong]));
  return { bytes, beside, within: inPlace.map(({ k }) => opened[k]!.name) };
}

/** The numbers of those surfaces that a file does not hold. */
function missing(rhino: Rhino, bytes: Uint8Array, wanted: { k: number; patch: Patch }[]): number[] {
  const { surfaces } = readRhino(rhino, openRhino(rhino, bytes));
  return wanted.filter(({ patch }) => !surfaces.some((s) => samePatch(s.patch, patch))).map(({ k }) => k);
}

/** All control points, homogeneous where it is rational, as the file has them. */
function numbersOf(nurbs: RhinoNurbs): Float64Array {
  const list = nurbs.points();
  const numbers: number[] = [];
  for (let i = 0; i < list.countU; ++i) for (let j = 0; j < list.countV; ++j) numbers.push(...list.get(i, j).slice(0, nurbs.isRational ? 4 : 3));
  return Float64Array.from(numbers);
}

/** The control points under a face, as they are in the file and as they are to be; which of so many surfaces with the same ones it is. Null for what is no such face. */
function exchange(file: RhinoFile, opened: readonly RhinoSource[], k: number, patch: Patch): { was: Float64Array; now: Float64Array; among: [number, number] } | null {
  const before = opened[k]!;
  const geometry = file.objects().get(before.object).geometry();
  if (before.face === null || (geometry as RhinoBrep).isSurface || !sameSpace(before.patch, patch)) return null;
  const nurbs = (geometry as RhinoBrep).faces().get(before.face).underlyingSurface().toNurbsSurface();
  if (!nurbs) return null;
  const was = numbersOf(nurbs);
  movePoints(nurbs.points(), before.patch, patch);
  const alike = opened.flatMap((other, l) => (samePatch(other.patch, before.patch) ? [l] : []));
  return { was, now: numbersOf(nurbs), among: [alike.indexOf(k), alike.length] };
}

/** Null where it is not certain which numbers of the file are meant. */
function putInto(bytes: Uint8Array, { was, now, among: [index, count] }: { was: Float64Array; now: Float64Array; among: [number, number] }): Uint8Array | null {
  const places = placesOf(bytes, was);
  return places.length === count ? exchanged(bytes, places[index]!, now) : null;
}

/** The new surface; control points that did not move keep the bits of the file, where weights times places would round. */
function exactly(rhino: Rhino, geometry: RhinoGeometry, before: RhinoSource, patch: Patch): RhinoNurbs {
  const copy = sameSpace(before.patch, patch) ? (geometry as RhinoSurface).toNurbsSurface() : null;
  if (!copy) return nurbsOf(rhino, patch);
  movePoints(copy.points(), before.patch, patch);
  return copy;
}

function bytesOf(rhino: Rhino, file: RhinoFile, version: number): Uint8Array {
  const options = new rhino.File3dmWriteOptions();
  options.version = version;
  return file.toByteArrayOptions(options);
}
