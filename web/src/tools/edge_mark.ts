import * as THREE from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';

import { boundsOf } from '../view/bounds';
import type { Viewer } from '../view/viewer';
import { alongCourse } from './edges';

const least = 0.01; // of the scene: edges shorter than that are not zoomed to any closer

/** A line along one edge of a face, which follows the surface. */
export class EdgeMark {
  /** What is marked: the surface by its id, and the course of the edge on it. */
  private marked: { surface: string; course: readonly number[] } | null = null;
  private readonly line = new Line2(new LineGeometry(), new LineMaterial({ color: 0xff4fa3, linewidth: 6, depthTest: false, transparent: true }));

  constructor(private readonly viewer: Viewer) {
    this.line.frustumCulled = false;
    this.line.name = 'marked edge';
    this.line.renderOrder = 12;
    this.line.visible = false;
    this.line.matrixAutoUpdate = false;
    viewer.marks.add(this.line);
  }

  show(surface: string, course: readonly number[]): void {
    this.marked = { surface, course };
    this.refresh();
  }

  hide(): void {
    this.marked = null;
    this.refresh();
  }

  private points(): Float32Array | null {
    const { marked, viewer } = this;
    const index = marked ? (viewer.frame?.state.surfaces.findIndex((s) => s.id === marked.surface) ?? -1) : -1;
    const picture = viewer.surfaces[index]?.picture;
    return marked && picture ? alongCourse(picture, marked.course) : null;
  }

  refresh(): void {
    const points = this.points();
    const shown = points !== null && points.length > 3;
    this.line.matrix.copy(this.viewer.placing.working(this.marked?.surface ?? '').matrix);
    this.line.matrixWorldNeedsUpdate = true;
    if (!shown && !this.line.visible) return;
    this.line.visible = shown;
    this.line.geometry.dispose();
    this.line.geometry = new LineGeometry();
    if (shown) this.line.geometry.setPositions(points);
    this.viewer.redraw();
  }

  /** Shows the marked edge as large as it fits. */
  zoom(): void {
    const points = this.points();
    if (!points) return;
    const { centre, radius } = boundsOf([new THREE.Box3().setFromArray(points).applyMatrix4(this.line.matrix)]);
    this.viewer.fit({ centre, radius: Math.max(1.2 * radius, least * this.viewer.bounds().radius), lowest: 0 });
  }
}
