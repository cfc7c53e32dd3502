import * as THREE from 'three';

import type { Assembly } from '../engine/context';

/**
 * One place where a part stands. The session works in the coordinates of parts, as the file has them, and so do the
 * tools; `matrix` takes them to the scene, which has those of the model, both relative to the session's origin.
 */
export interface Standing {
  part: number;
  place: number;
  matrix: THREE.Matrix4;
  inverse: THREE.Matrix4;
  /** Length in the scene of a length of the part. */
  scale: number;
}

/** Of everything where there is no assembly. */
export const still: Standing = { part: -1, place: 0, matrix: new THREE.Matrix4(), inverse: new THREE.Matrix4(), scale: 1 };

/** Of one surface or face as many are drawn as the graphics can bear. */
export const mostDrawn = 500;

const unmoved: readonly Standing[] = [still];

/** A place by three rows of four numbers, for positions that are relative to an origin. */
function standing(part: number, place: number, rows: readonly number[], origin: readonly number[]): Standing {
  const row = (r: number) => rows.slice(4 * r, 4 * r + 4) as [number, number, number, number];
  const moved = (r: number): number => {
    const [a, b, c, d] = row(r);
    return a * origin[0]! + b * origin[1]! + c * origin[2]! + d - origin[r]!;
  };
  const linear = (r: number) => row(r).slice(0, 3) as [number, number, number];
  const matrix = new THREE.Matrix4().set(...linear(0), moved(0), ...linear(1), moved(1), ...linear(2), moved(2), 0, 0, 0, 1);
  return { part, place, matrix, inverse: matrix.clone().invert(), scale: Math.cbrt(Math.abs(matrix.determinant())) };
}

/** Where the parts of the opened assembly stand, and in which of its places each of them is worked on. */
export class Placing {
  assembly: Assembly | null = null;
  private standings: Standing[][] = []; // by part
  private parts = new Map<string, number[]>(); // by the ids of surfaces, faces and curves
  private chosen = new Map<number, number>(); // places by part

  /** Another file; null: without an assembly. */
  open(assembly: Assembly | null, origin: readonly number[]): void {
    this.assembly = assembly;
    this.parts = new Map();
    this.chosen = new Map();
    this.standings = (assembly?.parts ?? []).map((part, k) => {
      for (const id of [...part.surfaces, ...part.faces, ...part.curves]) this.parts.set(id, [...(this.parts.get(id) ?? []), k]);
      return part.places.slice(0, mostDrawn).map((place, l) => standing(k, l, place.matrix, origin));
    });
  }

  /** Places of parts that are not drawn. */
  get left(): number {
    return (this.assembly?.parts ?? []).reduce((sum, part) => sum + Math.max(0, part.places.length - mostDrawn), 0);
  }

  /** Some part stands several times, or not at its own origin. */
  get placed(): boolean {
    return this.standings.some((places) => places.length !== 1 || !places[0]!.matrix.equals(still.matrix));
  }

  ofPart(part: number): readonly Standing[] {
    return this.standings[part] ?? [];
  }

  /** Where a surface, a face or a curve stands, by its id. */
  of(id: string): readonly Standing[] {
    const parts = this.parts.get(id);
    if (!parts) return unmoved;
    return parts.length === 1 ? this.standings[parts[0]!]! : parts.flatMap((part) => this.standings[part]!);
  }

  /** The place in which it is worked on: that of the last click, at first the first one. */
  working(id: string): Standing {
    const all = this.of(id);
    return all.find((s) => (this.chosen.get(s.part) ?? 0) === s.place) ?? all[0] ?? still;
  }

  /** From now on its part is worked on here. False where it was. */
  work({ part, place }: Standing): boolean {
    if (part < 0 || (this.chosen.get(part) ?? 0) === place) return false;
    this.chosen.set(part, place);
    return true;
  }
}

/** A box in the scene. */
export const placedBox = (box: THREE.Box3 | null, at: Standing): THREE.Box3 | null =>
  box && (at === still ? box : box.clone().applyMatrix4(at.matrix));

/** The plane (a, b, c, d), a x + b y + c z + d = 0, of the scene in the coordinates of a part; (a, b, c) need not have length 1. */
export function planeOf([a, b, c, d]: readonly [number, number, number, number], { matrix: { elements: e } }: Standing): [number, number, number, number] {
  const along = (k: number) => a * e[k]! + b * e[k + 1]! + c * e[k + 2]!;
  return [along(0), along(4), along(8), along(12) + d];
}

/** Points of a part, three numbers each, in the scene. */
export function placedPoints<P extends number[] | Float32Array>(points: P, at: Standing): P {
  if (at === still) return points;
  const p = new THREE.Vector3();
  const result = points.slice() as P;
  for (let k = 0; k < points.length; k += 3) p.fromArray(points, k).applyMatrix4(at.matrix).toArray(result, k);
  return result;
}
