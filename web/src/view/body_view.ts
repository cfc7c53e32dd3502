import * as THREE from 'three';

import type { BodyPicture } from '../engine/session_types';
import type { Palette } from './display';

const line = () => {
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ transparent: true }));
  lines.frustumCulled = false;
  return lines;
};

/** Curves and volumes as lines, with the control polygon of the selected one. */
export class BodyView {
  readonly group = new THREE.Group();
  private readonly rest = line();
  private readonly chosen = line();
  private readonly net = line();
  private bodies: BodyPicture[] = [];

  constructor() {
    this.group.add(this.rest, this.chosen, this.net);
  }

  show(bodies: BodyPicture[], selected: number | null, palette: Palette): void {
    this.bodies = bodies;
    const parts = [
      [this.rest, bodies.filter((_, k) => k !== selected).map((b) => b.lines), palette.net, 0.8],
      [this.chosen, bodies.filter((_, k) => k === selected).map((b) => b.lines), palette.toolSelected, 1],
      [this.net, bodies.filter((_, k) => k === selected).map((b) => b.net), palette.net, 0.4],
    ] as const;
    for (const [part, ends, colour, opacity] of parts) {
      part.geometry.dispose();
      part.geometry = new THREE.BufferGeometry();
      part.geometry.setAttribute('position', new THREE.BufferAttribute(joined(ends), 3));
      part.visible = ends.length > 0;
      part.material.color.set(colour);
      part.material.opacity = opacity;
    }
  }

  /** Of each. */
  boxes(): THREE.Box3[] {
    return this.bodies.map(({ lines }) => new THREE.Box3().setFromArray(lines));
  }
}

function joined(parts: readonly Float32Array[]): Float32Array {
  const all = new Float32Array(parts.reduce((sum, p) => sum + p.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
