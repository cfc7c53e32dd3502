import * as THREE from 'three';

import type { Hit, Viewer } from '../view/viewer';

/** The circle around the pointer that shows how far a brush reaches. */
export class Ring {
  private readonly group = new THREE.Group(); // stands where the part does that is pointed at
  private readonly line: THREE.LineLoop<THREE.BufferGeometry, THREE.LineBasicMaterial>;

  constructor(private readonly viewer: Viewer) {
    const circle = Array.from({ length: 64 }, (_, k) => {
      const a = (2 * Math.PI * k) / 64;
      return new THREE.Vector3(Math.cos(a), Math.sin(a), 0);
    });
    this.line = new THREE.LineLoop(
      new THREE.BufferGeometry().setFromPoints(circle),
      new THREE.LineBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 }),
    );
    this.line.renderOrder = 20;
    this.line.visible = false;
    this.line.frustumCulled = false;
    this.group.matrixAutoUpdate = false;
    this.group.add(this.line);
    viewer.marks.add(this.group);
  }

  show({ point, normal, standing }: Pick<Hit, 'point' | 'normal' | 'standing'>, reach: number): void {
    this.group.matrix.copy(standing.matrix);
    this.group.matrixWorldNeedsUpdate = true;
    this.line.visible = true;
    this.line.position.copy(point);
    this.line.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    this.line.scale.setScalar(reach);
    this.line.material.color.set(this.viewer.palette.toolSelected);
    this.viewer.redraw();
  }

  hide(): void {
    if (!this.line.visible) return;
    this.line.visible = false;
    this.viewer.redraw();
  }
}
