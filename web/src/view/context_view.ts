import * as THREE from 'three';

import type { Context, GreyFace } from '../engine/context';
import type { Display, Palette } from './display';
import { reliefLayer } from './relief';

/** A place of the other faces. */
export interface GreyHit {
  face: GreyFace;
  /** Scene coordinates. */
  point: THREE.Vector3;
}

/** The other faces of the opened file, in grey, to show what is sculpted in its surroundings. They hide what is behind them. */
export class ContextView {
  readonly mesh = new THREE.Mesh(
    new THREE.BufferGeometry(),
    new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 }),
  );

  /** Id of the face that was clicked last, if nothing else was since. */
  chosen: string | null = null;
  private faces: GreyFace[] = [];

  constructor() {
    this.mesh.visible = false;
    this.mesh.layers.enable(reliefLayer);
  }

  /** Null: nothing. */
  show(context: Context | null): void {
    this.mesh.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    if (context) {
      geometry.setAttribute('position', new THREE.BufferAttribute(context.positions, 3));
      geometry.setAttribute('normal', new THREE.BufferAttribute(context.normals, 3));
      geometry.setIndex(new THREE.BufferAttribute(context.indices, 1));
    }
    this.mesh.geometry = geometry;
    this.faces = context?.faces ?? [];
    this.chosen = null;
  }

  get triangles(): number {
    return (this.mesh.geometry.index?.count ?? 0) / 3;
  }

  /** Round everything that is shown; null where that is nothing. */
  box(): THREE.Box3 | null {
    if (!this.mesh.visible) return null;
    this.mesh.geometry.computeBoundingBox();
    return this.mesh.geometry.boundingBox;
  }

  /** Round the chosen face; null where there is none. */
  chosenBox(): THREE.Box3 | null {
    const { index, attributes: { position } } = this.mesh.geometry;
    if (!this.mesh.visible || !index || !position) return null;
    const box = new THREE.Box3();
    let first = 0;
    for (const face of this.faces) {
      const end = first + face.triangles;
      for (let k = 3 * first; face.id === this.chosen && k < 3 * end; ++k) {
        box.expandByPoint(new THREE.Vector3().fromBufferAttribute(position as THREE.BufferAttribute, index.getX(k)));
      }
      first = end;
    }
    return box.isEmpty() ? null : box;
  }

  /** Whether it stands before what the ray meets at this distance. Faces that touch there do not. */
  hides(ray: THREE.Raycaster, distance: number): boolean {
    if (!this.mesh.visible) return false;
    const { far } = ray;
    ray.far = 0.999 * distance;
    const hit = ray.intersectObject(this.mesh, false).length > 0;
    ray.far = far;
    return hit;
  }

  /** The nearest face on the ray, up to a distance. */
  hit(ray: THREE.Raycaster, distance: number): GreyHit | null {
    const hit = this.mesh.visible ? ray.intersectObject(this.mesh, false)[0] : undefined;
    if (hit?.faceIndex == null || hit.distance > distance) return null;
    let first = 0;
    for (const face of this.faces) {
      first += face.triangles;
      if (hit.faceIndex < first) return { face, point: hit.point };
    }
    return null;
  }

  restyle(display: Display, palette: Palette): void {
    this.mesh.visible = display.context && this.triangles > 0;
    this.mesh.material.color.set(palette.context);
  }
}
