import type { Rhino, RhinoFile, RhinoGeometry } from '@studio/document/rhino/module';

type Vector = [number, number, number];

/** A Rhino file of boxes, each a polysurface of six faces, by their lower and upper corners. */
export function boxes(rhino: Rhino, ...corners: [string, Vector, Vector][]): Uint8Array {
  const made = rhino as never as {
    File3dm: new () => RhinoFile;
    Brep: { createFromBoundingBox(box: object): RhinoGeometry };
    BoundingBox: new (lower: number[], upper: number[]) => object;
  };
  const file = new made.File3dm();
  for (const [name, lower, upper] of corners) {
    const attributes = new rhino.ObjectAttributes();
    attributes.name = name;
    file.objects().add(made.Brep.createFromBoundingBox(new made.BoundingBox(lower, upper)), attributes);
  }
  return file.toByteArrayOptions(Object.assign(new rhino.File3dmWriteOptions(), { version: 7 }));
}
