import * as THREE from 'three';

import type { Combs } from '../engine/session_types';

const line = () => {
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ transparent: true, depthTest: false }));
  lines.frustumCulled = false;
  lines.visible = false;
  lines.renderOrder = 2;
  return lines;
};

/** Curvature combs of all surfaces, over everything, as half of them stand below: teeth away from the centre of curvature, and the curve through their tips. */
export class CombView {
  readonly group = new THREE.Group();
  /** Of all that is shown; 0: nothing is. */
  largest = 0;
  private readonly teeth = line();
  private readonly tips = line();
  private combs: Combs[] = [];

  constructor() {
    this.group.add(this.teeth, this.tips);
  }

  show(combs: Combs[]): void {
    this.combs = combs;
    this.largest = Math.max(0, ...combs.map((c) => c.largest));
  }

  /** `longest`: of a tooth of the largest curvature, file units. */
  restyle(longest: number, colour: number): void {
    this.teeth.visible = this.tips.visible = this.largest > 0;
    if (this.largest === 0) return;
    const [teeth, tips]: [number[], number[]] = [[], []];
    const scale = longest / this.largest;
    for (const { places, vectors, joined } of this.combs) {
      const tip = (k: number) => [0, 1, 2].map((d) => places[3 * k + d]! - scale * vectors[3 * k + d]!);
      joined.forEach((joins, k) => {
        teeth.push(...places.subarray(3 * k, 3 * k + 3), ...tip(k));
        if (joins) tips.push(...tip(k - 1), ...tip(k));
      });
    }
    for (const [part, ends, opacity] of [[this.teeth, teeth, 0.5], [this.tips, tips, 1]] as const) {
      part.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(ends), 3));
      part.material.color.set(colour);
      part.material.opacity = opacity;
    }
  }
}
