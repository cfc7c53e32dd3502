import type { Rhino, RhinoBrep, RhinoFile, RhinoGeometry, RhinoNurbs } from './module';
import { type Patch, patchOf } from './patch';

/** Where in the file a surface comes from: the object, and the face where the object is a polysurface. */
export interface RhinoSource {
  object: number;
  face: number | null;
  name: string;
  patch: Patch;
}

export interface RhinoContents {
  surfaces: RhinoSource[];
  /** As the session names it; mm if the session lacks the file's unit, which is then in `otherUnit`. */
  unit: string;
  otherUnit: string | null;
  /** What cannot be sculpted, as text: "2 meshes". */
  skipped: string[];
}

/** Names of units in the session and in Rhino. */
export const rhinoUnits: Record<string, string> = {
  um: 'Microns', mm: 'Millimeters', cm: 'Centimeters', m: 'Meters', km: 'Kilometers', dm: 'Decimeters',
  inch: 'Inches', foot: 'Feet', yard: 'Yards', mile: 'Miles', mil: 'Mils', microinch: 'Microinches',
};

export function openRhino(rhino: Rhino, bytes: Uint8Array): RhinoFile {
  const file = rhino.File3dm.fromByteArray(bytes);
  if (!file) throw new Error('this is no Rhino file that can be read; open a .3dm of version 2 or later');
  return file;
}

const plural: Record<string, string> = {
  Mesh: 'meshes', SubD: 'subdivision surfaces', Extrusion: 'extrusions', Brep: 'solids', Point: 'points', InstanceReference: 'blocks',
};

function kind(geometry: RhinoGeometry): string {
  const name = geometry.constructor.name;
  return plural[name] ?? (/Curve$/.test(name) ? 'curves' : /Text|Dim|Annotation|Leader/.test(name) ? 'annotations' : 'other objects');
}

/** All surfaces in the order of the file: the same every time, so that they can be found again on saving. */
export function readRhino(rhino: Rhino, file: RhinoFile): RhinoContents {
  const surfaces: RhinoSource[] = [];
  const skipped = new Map<string, number>();
  const skip = (what: string) => skipped.set(what, (skipped.get(what) ?? 0) + 1);
  const objects = file.objects();
  for (let k = 0; k < objects.count; ++k) {
    const geometry = objects.get(k).geometry();
    const attributes = objects.get(k).attributes();
    const label = attributes.name || `${geometry.constructor.name === 'Brep' ? 'polysurface' : 'surface'} ${k + 1}`;
    if (attributes.isInstanceDefinitionObject) {
      skip('objects inside blocks');
      continue;
    }
    const add = (nurbs: RhinoNurbs | null | undefined, face: number | null, name: string) => {
      if (nurbs) surfaces.push({ object: k, face, name, patch: patchOf(nurbs) });
      else skip(kind(geometry));
    };
    if (geometry instanceof rhino.NurbsSurface) add(geometry, null, label);
    else if (geometry instanceof rhino.Brep) {
      const faces = (geometry as RhinoBrep).faces();
      for (let f = 0; f < faces.count; ++f) {
        add(faces.get(f).underlyingSurface().toNurbsSurface(), f, faces.count > 1 ? `${label}, face ${f + 1}` : label);
      }
    } else if (geometry instanceof rhino.Surface) add(geometry.toNurbsSurface(), null, label);
    else skip(kind(geometry));
  }
  return { surfaces, ...unitOf(rhino, file), skipped: [...skipped].map(([what, count]) => `${count} ${what}`) };
}

function unitOf(rhino: Rhino, file: RhinoFile): { unit: string; otherUnit: string | null } {
  const system = file.settings().modelUnitSystem;
  const name = Object.keys(rhino.UnitSystem).find((key) => rhino.UnitSystem[key] === system) ?? 'unknown';
  const known = Object.entries(rhinoUnits).find(([, rhinos]) => rhinos === name);
  return known ? { unit: known[0], otherUnit: null } : { unit: 'mm', otherUnit: name };
}
