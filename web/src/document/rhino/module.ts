/** The part of rhino3dm that is used here (openNURBS; its own declarations are looser than what it does). */

export interface RhinoPointList {
  readonly countU: number;
  readonly countV: number;
  /** (wx, wy, wz, w): homogeneous. */
  get(i: number, j: number): [number, number, number, number];
  set(i: number, j: number, point: number[]): void;
}

export interface RhinoKnotList {
  toList(): number[];
  set(k: number, knot: number): void;
  superfluousKnot(start: boolean): number;
}

export interface RhinoGeometry {
  readonly constructor: { readonly name: string };
}

export interface RhinoNurbs extends RhinoGeometry {
  readonly isRational: boolean;
  readonly orderU: number;
  readonly orderV: number;
  points(): RhinoPointList;
  knotsU(): RhinoKnotList;
  knotsV(): RhinoKnotList;
}

export interface RhinoSurface extends RhinoGeometry {
  toNurbsSurface(): RhinoNurbs | null | undefined;
}

export interface RhinoFace {
  readonly orientationIsReversed: boolean;
  underlyingSurface(): RhinoSurface;
}

export interface RhinoBrep extends RhinoGeometry {
  /** One face that is a whole surface, not trimmed. */
  readonly isSurface: boolean;
  faces(): { readonly count: number; get(k: number): RhinoFace };
  flip(): void;
}

export interface RhinoAttributes {
  name: string;
  readonly id: string;
  layerIndex: number;
  readonly isInstanceDefinitionObject: boolean;
}

export interface RhinoFile {
  readonly archiveVersion: number;
  objects(): {
    readonly count: number;
    get(k: number): { attributes(): RhinoAttributes; geometry(): RhinoGeometry };
    add(geometry: RhinoGeometry, attributes: RhinoAttributes): string;
    delete(id: string): void;
    findId(id: string): { attributes(): RhinoAttributes };
  };
  layers(): { readonly count: number; get(k: number): { name: string } };
  settings(): { modelUnitSystem: unknown };
  toByteArrayOptions(options: { version: number }): Uint8Array;
}

export interface Rhino {
  File3dm: { new (): RhinoFile; fromByteArray(bytes: Uint8Array): RhinoFile | null };
  File3dmWriteOptions: new () => { version: number };
  ObjectAttributes: new () => RhinoAttributes;
  NurbsSurface: (abstract new (...args: never[]) => RhinoNurbs) & {
    create(dimension: number, rational: boolean, orderU: number, orderV: number, countU: number, countV: number): RhinoNurbs;
  };
  Surface: abstract new (...args: never[]) => RhinoSurface;
  Brep: (abstract new (...args: never[]) => RhinoBrep) & { createFromSurface(surface: RhinoNurbs): RhinoBrep };
  UnitSystem: Record<string, unknown>;
}

/** `wasm`: where the module is, or its bytes. */
export async function loadRhino(wasm: string | Uint8Array): Promise<Rhino> {
  const { default: rhino3dm } = (await import('rhino3dm/rhino3dm.module.js')) as { default: (config: object) => Promise<Rhino> };
  return rhino3dm(typeof wasm === 'string' ? { locateFile: () => wasm } : { wasmBinary: wasm });
}
