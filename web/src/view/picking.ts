import * as THREE from 'three';

import type { Picture } from '../engine/session_types';

const block = 8; // cells of the grid per side of a box

export interface GridHit {
  point: THREE.Vector3;
  /** Towards the origin of the ray. */
  normal: THREE.Vector3;
  /** (s, t) of the domain. */
  fractions: [number, number];
  distance: number;
}

/** Where rays meet the drawn triangles of a picture, by boxes around blocks of them; built on first use. */
export class GridPicker {
  private boxes: Float32Array | null = null; // lower and upper corner of each block
  private readonly rows: number;
  private readonly columns: number;

  constructor(private readonly picture: Picture) {
    this.rows = Math.ceil((picture.counts[0] - 1) / block);
    this.columns = Math.ceil((picture.counts[1] - 1) / block);
  }

  private build(): Float32Array {
    const { counts: [m, n], positions } = this.picture;
    const boxes = new Float32Array(6 * this.rows * this.columns);
    for (let a = 0; a < this.rows; ++a) {
      for (let b = 0; b < this.columns; ++b) {
        const at = 6 * (a * this.columns + b);
        boxes.fill(Infinity, at, at + 3);
        boxes.fill(-Infinity, at + 3, at + 6);
        for (let k = a * block; k <= Math.min(m - 1, (a + 1) * block); ++k) {
          for (let l = b * block; l <= Math.min(n - 1, (b + 1) * block); ++l) {
            for (let d = 0; d < 3; ++d) {
              const x = positions[3 * (k * n + l) + d]!;
              if (x < boxes[at + d]!) boxes[at + d] = x;
              if (x > boxes[at + 3 + d]!) boxes[at + 3 + d] = x;
            }
          }
        }
      }
    }
    return boxes;
  }

  /** The nearest hit, or null. `shown`: fractions (s, t) at which there is something to hit; left out, everywhere. */
  hit(ray: THREE.Ray, shown?: (s: number, t: number) => boolean): GridHit | null {
    this.boxes ??= this.build();
    const { counts: [m, n], positions } = this.picture;
    const box = new THREE.Box3();
    const [a, b, c, d] = Array.from({ length: 4 }, () => new THREE.Vector3()) as [THREE.Vector3, THREE.Vector3, THREE.Vector3, THREE.Vector3];
    const point = new THREE.Vector3();
    let best: { point: THREE.Vector3; distance: number; corners: [number, number, number] } | null = null;
    const test = (corners: [number, number, number], p: THREE.Vector3, q: THREE.Vector3, r: THREE.Vector3) => {
      if (!ray.intersectTriangle(p, q, r, false, point)) return;
      const distance = point.distanceTo(ray.origin);
      if (best && distance >= best.distance) return;
      if (!shown || shown(...this.fractions(point, corners))) best = { point: point.clone(), distance, corners };
    };
    for (let row = 0; row < this.rows; ++row) {
      for (let column = 0; column < this.columns; ++column) {
        const at = 6 * (row * this.columns + column);
        box.min.fromArray(this.boxes, at);
        box.max.fromArray(this.boxes, at + 3);
        if (!ray.intersectsBox(box)) continue;
        for (let k = row * block; k < Math.min(m - 1, (row + 1) * block); ++k) {
          for (let l = column * block; l < Math.min(n - 1, (column + 1) * block); ++l) {
            const corner = k * n + l;
            a.fromArray(positions, 3 * corner);
            b.fromArray(positions, 3 * (corner + n));
            c.fromArray(positions, 3 * (corner + n + 1));
            d.fromArray(positions, 3 * (corner + 1));
            test([corner, corner + n, corner + n + 1], a, b, c);
            test([corner, corner + n + 1, corner + 1], a, c, d);
          }
        }
      }
    }
    const found = best as { point: THREE.Vector3; distance: number; corners: [number, number, number] } | null;
    if (!found) return null;
    [a, b, c].forEach((v, k) => v.fromArray(positions, 3 * found.corners[k]!));
    const normal = new THREE.Triangle(a, b, c).getNormal(new THREE.Vector3());
    if (normal.dot(ray.direction) > 0) normal.negate();
    return {
      point: found.point, normal, distance: found.distance,
      fractions: this.fractions(found.point, found.corners),
    };
  }

  /** Of a point of a triangle. */
  private fractions(point: THREE.Vector3, corners: [number, number, number]): [number, number] {
    const { counts: [, n], positions, s, t } = this.picture;
    const [a, b, c] = corners.map((corner) => new THREE.Vector3().fromArray(positions, 3 * corner)) as [THREE.Vector3, THREE.Vector3, THREE.Vector3];
    const weights = THREE.Triangle.getBarycoord(point, a, b, c, new THREE.Vector3())?.toArray() ?? [1, 0, 0];
    const mix = (of: (corner: number) => number) =>
      Math.min(1, Math.max(0, corners.reduce((sum, corner, k) => sum + weights[k]! * of(corner), 0)));
    return [mix((corner) => s[Math.floor(corner / n)]!), mix((corner) => t[corner % n]!)];
  }
}
