import * as THREE from 'three';

import type { Palette } from './display';

/** 1, 2 or 5 times a power of ten: the largest that is not above x. */
export function roundStep(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  const digit = x / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/** A grid of whole lengths below the scene. */
export class Ground {
  readonly group = new THREE.Group();
  /** Length of a cell, file units. */
  step = 1;

  private readonly thin = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
  private readonly strong = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());

  constructor() {
    this.group.add(this.thin, this.strong);
    for (const part of [this.thin, this.strong]) {
      part.renderOrder = -1;
      part.frustumCulled = false; // what three keeps of its extent is that of the first drawing, when it may be empty
    }
  }

  /** For a scene of this size whose lowest point, in the scene's coordinates, is at z. */
  fit(size: number, z: number): void {
    this.step = roundStep(Math.max(size, 1e-12) / 12);
    const half = 15;
    const thin: number[] = [];
    const strong: number[] = [];
    for (let k = -half; k <= half; ++k) {
      const to = k % 5 === 0 ? strong : thin;
      const a = k * this.step;
      const b = half * this.step;
      to.push(a, -b, 0, a, b, 0, -b, a, 0, b, a, 0);
    }
    this.thin.geometry.setAttribute('position', new THREE.Float32BufferAttribute(thin, 3));
    this.strong.geometry.setAttribute('position', new THREE.Float32BufferAttribute(strong, 3));
    this.group.position.z = z;
  }

  restyle(palette: Palette): void {
    this.thin.material.color.set(palette.grid);
    this.strong.material.color.set(palette.gridStrong);
  }
}
