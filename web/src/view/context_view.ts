import * as THREE from 'three';

import type { Context, GreyFace } from '../engine/context';
import type { Display, Palette } from './display';
import { type Placing, type Standing, still } from './placing';
import { reliefLayer } from './relief';

/** A place of the other faces. */
export interface GreyHit {
  face: GreyFace;
  /** In the coordinates of its part, relative to the session's origin. */
  point: THREE.Vector3;
  /** Where the face that was hit stands. */
  standing: Standing;
}

/** Grey faces that stand together: corners of their triangles, and their places. */
export interface GreyPiece {
  positions: Float32Array;
  indices: Uint32Array;
  standings: readonly Standing[];
}

/** Drawn at once: those of the places that are mirrored alike. */
interface Drawn {
  mesh: THREE.InstancedMesh<THREE.BufferGeometry, THREE.MeshLambertMaterial>;
  faces: readonly GreyFace[];
  standings: readonly Standing[];
}

const mirror = new THREE.Matrix4().makeScale(-1, 1, 1);

/** The other faces of the opened file, in grey, to show what is sculpted in its surroundings. They hide what is behind them. */
export class ContextView {
  readonly group = new THREE.Group();
  /** Id of the face that was clicked last, if nothing else was since. */
  chosen: string | null = null;
  pieces: readonly GreyPiece[] = [];

  private readonly material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });
  private drawn: Drawn[] = [];
  private at: Standing | null = null; // of the chosen face

  constructor() {
    this.group.visible = false;
  }

  /** Null: nothing. */
  show(context: Context | null, placing: Placing): void {
    for (const { mesh } of this.drawn) {
      mesh.geometry.dispose();
      mesh.dispose();
    }
    this.group.clear();
    this.drawn = [];
    this.pieces = [];
    this.chosen = this.at = null;
    if (!context) return;
    const position = new THREE.BufferAttribute(context.positions, 3);
    const normal = new THREE.BufferAttribute(context.normals, 3);
    this.pieces = [...together(context, placing)].map(([standings, { faces, indices }]) => {
      for (const mirrored of [false, true]) {
        const some = standings.filter((s) => s.matrix.determinant() < 0 === mirrored);
        if (some.length === 0) continue;
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute('position', position);
        geometry.setAttribute('normal', normal);
        geometry.setIndex(new THREE.BufferAttribute(indices, 1));
        const mesh = new THREE.InstancedMesh(geometry, this.material, some.length);
        // The front of triangles follows from the matrix of the mesh, not from those of its instances.
        if (mirrored) mesh.applyMatrix4(mirror);
        some.forEach(({ matrix }, k) => mesh.setMatrixAt(k, mirrored ? mirror.clone().multiply(matrix) : matrix));
        mesh.frustumCulled = false;
        mesh.layers.enable(reliefLayer);
        this.group.add(mesh);
        this.drawn.push({ mesh, faces, standings: some });
      }
      return { positions: context.positions, indices, standings };
    });
    this.group.updateMatrixWorld();
  }

  get triangles(): number {
    return this.drawn.reduce((sum, { mesh }) => sum + ((mesh.geometry.index?.count ?? 0) / 3) * mesh.count, 0);
  }

  /** Round everything that is shown; null where that is nothing. */
  box(): THREE.Box3 | null {
    if (!this.group.visible) return null;
    const box = new THREE.Box3();
    for (const { positions, indices, standings } of this.pieces) {
      const own = boxOf(positions, indices, 0, indices.length);
      for (const s of standings) box.union(s === still ? own : own.clone().applyMatrix4(s.matrix));
    }
    return box.isEmpty() ? null : box;
  }

  /** Round the chosen face; null where there is none. */
  chosenBox(): THREE.Box3 | null {
    if (!this.group.visible || this.chosen === null) return null;
    for (const { mesh, faces, standings } of this.drawn) {
      let first = 0;
      for (const face of faces) {
        const end = first + face.triangles;
        if (face.id === this.chosen) {
          const at = this.at && standings.includes(this.at) ? this.at : standings[0]!;
          const box = boxOf(mesh.geometry.getAttribute('position').array as Float32Array, mesh.geometry.index!.array as Uint32Array, 3 * first, 3 * end);
          return box.isEmpty() ? null : box.applyMatrix4(at.matrix);
        }
        first = end;
      }
    }
    return null;
  }

  /** Round some faces, in one of the places where they stand; null where none is among them. */
  boxAt(ids: ReadonlySet<string>, at: Standing): THREE.Box3 | null {
    const box = new THREE.Box3();
    for (const { mesh, faces, standings } of this.drawn) {
      if (!standings.includes(at)) continue;
      let first = 0;
      for (const face of faces) {
        const end = first + face.triangles;
        if (ids.has(face.id)) box.union(boxOf(mesh.geometry.getAttribute('position').array as Float32Array, mesh.geometry.index!.array as Uint32Array, 3 * first, 3 * end));
        first = end;
      }
    }
    return box.isEmpty() ? null : box.applyMatrix4(at.matrix);
  }

  /** A click on it, or, with null, on something else. */
  choose(hit: GreyHit | null): void {
    this.chosen = hit?.face.id ?? null;
    this.at = hit?.standing ?? null;
  }

  /** Whether it stands before what the ray meets at this distance. Faces that touch there do not. */
  hides(ray: THREE.Raycaster, distance: number): boolean {
    if (!this.group.visible) return false;
    const { far } = ray;
    ray.far = 0.999 * distance;
    const hit = this.drawn.some(({ mesh }) => ray.intersectObject(mesh, false).length > 0);
    ray.far = far;
    return hit;
  }

  /** The nearest face on the ray, up to a distance. */
  hit(ray: THREE.Raycaster, distance: number): GreyHit | null {
    if (!this.group.visible) return null;
    const hit = ray.intersectObjects(this.drawn.map(({ mesh }) => mesh), false)[0];
    if (hit?.faceIndex == null || hit.distance > distance) return null;
    const { faces, standings } = this.drawn.find(({ mesh }) => mesh === hit.object)!;
    const standing = standings[hit.instanceId ?? 0]!;
    let first = 0;
    for (const face of faces) {
      first += face.triangles;
      if (hit.faceIndex < first) return { face, point: hit.point.clone().applyMatrix4(standing.inverse), standing };
    }
    return null;
  }

  restyle(display: Display, palette: Palette): void {
    this.group.visible = display.context && this.drawn.length > 0;
    this.material.color.set(palette.context);
  }
}

/** The faces that stand in the same places, and their triangles. */
function together({ faces, indices }: Context, placing: Placing): Map<readonly Standing[], { faces: GreyFace[]; indices: Uint32Array }> {
  const groups = new Map<readonly Standing[], { faces: GreyFace[]; from: number[] }>();
  const known = new Map<string, readonly Standing[]>(); // of faces of several parts, whose lists are made anew
  let first = 0;
  for (const face of faces) {
    const places = placing.of(face.id);
    const key = places.map((s) => `${s.part} ${s.place}`).join();
    if (!known.has(key)) known.set(key, places);
    const standings = known.get(key)!;
    const group = groups.get(standings) ?? { faces: [], from: [] };
    groups.set(standings, group);
    group.faces.push(face);
    group.from.push(first);
    first += face.triangles;
  }
  return new Map([...groups].map(([standings, { faces: own, from }]) => {
    const result = new Uint32Array(3 * own.reduce((sum, face) => sum + face.triangles, 0));
    let at = 0;
    own.forEach((face, k) => {
      result.set(indices.subarray(3 * from[k]!, 3 * (from[k]! + face.triangles)), at);
      at += 3 * face.triangles;
    });
    return [standings, { faces: own, indices: result }];
  }));
}

function boxOf(positions: Float32Array, indices: Uint32Array, first: number, end: number): THREE.Box3 {
  const box = new THREE.Box3();
  const p = new THREE.Vector3();
  for (let k = first; k < end; ++k) box.expandByPoint(p.fromArray(positions, 3 * indices[k]!));
  return box;
}
