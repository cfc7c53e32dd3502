import * as THREE from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

import { boundsOf } from './bounds';
import type { Standing } from './placing';
import type { Viewer } from './viewer';

/** An edge of the file, in the coordinates of its part. */
export interface DrawnEdge {
  /** Ids of the faces there; they say where it stands. */
  faces: readonly string[];
  points: readonly (readonly number[])[];
  /** Null: quiet. */
  colour: string | null;
}

const quiet = '#7d8894';
const mostSegments = 300_000; // of all edges in all places
const least = 0.01; // of the scene: edges shorter than that are not zoomed to any closer

/** Draws edges of the whole file; those with a colour wide, and faintly through what hides them. */
export class EdgeLines {
  private readonly calm = segments(1.4, 6);
  private readonly loud = segments(4.5, 8);
  private readonly behind = segments(4.5, 7, 0.3);
  private readonly line = new Line2(new LineGeometry(), new LineMaterial({ color: 0xff4fa3, linewidth: 6, depthTest: false, transparent: true }));
  private drawn: readonly DrawnEdge[] = [];

  constructor(private readonly viewer: Viewer) {
    this.calm.name = 'quiet edges';
    this.loud.name = 'coloured edges';
    this.line.name = 'marked edge';
    this.line.frustumCulled = false;
    this.line.renderOrder = 12;
    this.line.visible = false;
    viewer.marks.add(this.calm, this.loud, this.behind, this.line);
  }

  /** How many edges have a colour. */
  get coloured(): number {
    return this.drawn.filter((e) => e.colour !== null).length;
  }

  show(edges: readonly DrawnEdge[]): void {
    if (edges.length === 0 && this.drawn.length === 0) return;
    this.drawn = edges;
    for (const [lines, some] of [[this.calm, edges.filter((e) => !e.colour)], [this.loud, edges.filter((e) => e.colour)]] as const) {
      const positions: number[] = [], colours: number[] = [];
      for (const edge of some) this.add(edge, positions, colours);
      lines.visible = positions.length > 0;
      lines.geometry.dispose();
      lines.geometry = new LineSegmentsGeometry();
      if (lines.visible) lines.geometry.setPositions(positions).setColors(colours);
    }
    this.behind.geometry = this.loud.geometry;
    this.behind.visible = this.loud.visible;
    this.viewer.redraw();
  }

  /** Where an edge stands: in each place of its part. */
  standings({ faces }: Pick<DrawnEdge, 'faces'>): readonly Standing[] {
    return this.viewer.placing.of(faces[0] ?? '');
  }

  private add(edge: DrawnEdge, positions: number[], colours: number[]): void {
    const { r, g, b } = new THREE.Color(edge.colour ?? quiet);
    for (const at of this.standings(edge)) {
      const points = this.placed(edge, at);
      for (let k = 0; k + 1 < points.length && positions.length < 6 * mostSegments; ++k) {
        positions.push(...points[k]!.toArray(), ...points[k + 1]!.toArray());
        colours.push(r, g, b, r, g, b);
      }
    }
  }

  private placed({ points }: Pick<DrawnEdge, 'points'>, at: Standing): THREE.Vector3[] {
    const [x, y, z] = this.viewer.origin;
    return points.map((p) => new THREE.Vector3(p[0]! - x, p[1]! - y, p[2]! - z).applyMatrix4(at.matrix));
  }

  private inWork(edge: DrawnEdge): THREE.Vector3[] {
    return this.placed(edge, this.viewer.placing.working(edge.faces[0] ?? ''));
  }

  /** Marks an edge in the place where its part is worked on. Null: none is marked. */
  mark(edge: DrawnEdge | null): void {
    const points = edge ? this.inWork(edge) : [];
    if (points.length < 2 && !this.line.visible) return;
    this.line.visible = points.length > 1;
    this.line.geometry.dispose();
    this.line.geometry = new LineGeometry();
    if (this.line.visible) this.line.geometry.setPositions(points.flatMap((p) => p.toArray()));
    this.viewer.redraw();
  }

  /** Shows an edge as large as it fits. */
  zoom(edge: DrawnEdge): void {
    const { centre, radius } = boundsOf([new THREE.Box3().setFromPoints(this.inWork(edge))]);
    this.viewer.fit({ centre, radius: Math.max(1.2 * radius, least * this.viewer.bounds().radius), lowest: 0 });
  }
}

function segments(linewidth: number, renderOrder: number, opacity = 1): LineSegments2 {
  const material = new LineMaterial({ linewidth, vertexColors: true, transparent: true, opacity, depthTest: opacity === 1, depthWrite: false,
    polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4 });
  const lines = new LineSegments2(new LineSegmentsGeometry(), material);
  Object.assign(lines, { frustumCulled: false, visible: false, renderOrder });
  return lines;
}
