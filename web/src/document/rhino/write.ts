import type { Rhino, RhinoAttributes, RhinoBrep, RhinoFile, RhinoGeometry, RhinoNurbs, RhinoSurface } from './module';
import { movePoints, nurbsOf, type Patch, samePatch, sameSpace } from './patch';
import { openRhino, readRhino, rhinoUnits, type RhinoSource } from './read';

export interface Written {
  bytes: Uint8Array;
  /** Surfaces that are now separate from the solid they are a face of, by name. */
  beside: string[];
}

const newest = 8;

/** A new file of these surfaces. */
export function writeRhino(rhino: Rhino, surfaces: { name: string; patch: Patch }[], unit: string): Written {
  const file = new rhino.File3dm();
  file.settings().modelUnitSystem = rhino.UnitSystem[rhinoUnits[unit] ?? 'Millimeters'];
  for (const { name, patch } of surfaces) addSurface(rhino, file, name, patch);
  return { bytes: bytesOf(rhino, file, newest), beside: [] };
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
 * changed, the object is replaced. A polysurface of one untrimmed face is replaced by one of the new surface. A face
 * among several, or trimmed, cannot be replaced through rhino3dm: its new surface is added with the attributes of the
 * polysurface, which stays.
 */
export function rewriteRhino(rhino: Rhino, source: Uint8Array, surfaces: { name: string; patch: Patch }[]): Written {
  const file = openRhino(rhino, source);
  const { surfaces: opened } = readRhino(rhino, file);
  if (surfaces.length < opened.length) throw new Error('surfaces of the file are missing; save a new file instead');
  const objects = file.objects();
  const beside: string[] = [];
  const replaced: { attributes: RhinoAttributes; geometry: RhinoGeometry }[] = [];
  const added: { attributes: RhinoAttributes; geometry: RhinoGeometry; name: string }[] = [];
  opened.forEach((before, k) => {
    const { patch } = surfaces[k]!;
    if (samePatch(before.patch, patch)) return;
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
  return { bytes: bytesOf(rhino, file, Math.min(newest, Math.max(2, version))), beside };
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
