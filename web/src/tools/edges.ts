import * as THREE from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';

import type { SurfaceInfo, Vector3 } from '../engine/session_types';
import type { Viewer } from '../view/viewer';
import type { Viewport } from '../view/viewport';
import type { PointerTool } from './pointers';

export const edgeNames = ['u0', 'u1', 'v0', 'v1'] as const;
export type Edge = (typeof edgeNames)[number];
export type Continuity = 'free' | 'position' | 'clamped' | 'curvature' | 'symmetry';

export const edgeTitles: Record<Edge, string> = { u0: 'Edge u = 0', u1: 'Edge u = 1', v0: 'Edge v = 0', v1: 'Edge v = 1' };
const colours: Record<Continuity, number> = {
  free: 0x8a97a5, position: 0xe0b13a, clamped: 0xe88433, curvature: 0xd6483d, symmetry: 0x9a6fd0,
};

/** What is requested of an edge. The rows by which a surface is held are separate. */
export function continuityOf(info: SurfaceInfo, edge: Edge): Continuity {
  let found: Continuity = 'free';
  for (const c of info.constraints) {
    if (c.do === 'edge' && (c.which === edge || c.which === 'all')) found = c.hold ?? 'position';
    if (c.do === 'symmetry' && c.edge === edge) found = 'symmetry';
  }
  return found;
}

/** Shows the edges of the selected surface in the colour of what is requested of them; a click on one changes it. */
export class Edges implements PointerTool {
  readonly active = false;
  /** A click on an edge, with its position on the page. */
  onEdge: (surface: number, edge: Edge, at: { x: number; y: number }) => void = () => {};

  private readonly lines: Line2[] = [];
  private hovered: Edge | null = null;
  private shown = false;

  constructor(private readonly viewer: Viewer, private readonly select: (surface: number) => Promise<void>) {}

  private get surface(): number | undefined {
    return this.viewer.frame?.state.selection[0];
  }

  /** Points along an edge, 3 numbers each, scene coordinates. */
  points(edge: Edge): Float32Array | null {
    const picture = this.surface === undefined ? null : this.viewer.surfaces[this.surface]?.picture;
    if (!picture) return null;
    const [m, n] = picture.counts;
    const count = edge[0] === 'u' ? n : m;
    const result = new Float32Array(3 * count);
    for (let k = 0; k < count; ++k) {
      const [i, j] = edge === 'u0' ? [0, k] : edge === 'u1' ? [m - 1, k] : edge === 'v0' ? [k, 0] : [k, n - 1];
      const at = 3 * (i! * n + j!);
      result.set(picture.positions.subarray(at, at + 3), 3 * k);
    }
    return result;
  }

  refresh(shown: boolean): void {
    if (!shown && !this.shown) return;
    this.shown = shown;
    const info = this.surface === undefined ? undefined : this.viewer.frame!.state.surfaces[this.surface];
    edgeNames.forEach((edge, k) => {
      const line = (this.lines[k] ??= this.line());
      const places = shown && info ? this.points(edge) : null;
      line.visible = places !== null;
      if (!places) return;
      line.geometry.dispose();
      line.geometry = new LineGeometry();
      line.geometry.setPositions(places);
      const continuity = continuityOf(info!, edge);
      line.material.color.set(colours[continuity]);
      line.material.linewidth = this.hovered === edge ? 7 : continuity === 'free' ? 2.5 : 4;
    });
    this.viewer.redraw();
  }

  private line(): Line2 {
    const line = new Line2(new LineGeometry(), new LineMaterial({ linewidth: 3, depthTest: false, transparent: true }));
    line.frustumCulled = false;
    line.renderOrder = 11;
    this.viewer.overlay.add(line);
    return line;
  }

  /** The edge under the pointer, within `reach` pixels. */
  at(viewport: Viewport, event: { clientX: number; clientY: number }, reach: number): Edge | null {
    let best: Edge | null = null;
    let nearest = reach;
    const p = new THREE.Vector3(event.clientX, event.clientY, 0);
    for (const edge of edgeNames) {
      const points = this.points(edge);
      if (!points) continue;
      const places = viewport.projectAll(points);
      for (let k = 0; 2 * k + 3 < places.length; ++k) {
        const segment = new THREE.Line3(new THREE.Vector3(places[2 * k], places[2 * k + 1], 0), new THREE.Vector3(places[2 * k + 2], places[2 * k + 3], 0));
        const distance = segment.closestPointToPoint(p, true, new THREE.Vector3()).distanceTo(p);
        if (distance < nearest) [nearest, best] = [distance, edge];
      }
    }
    return best;
  }

  press(): boolean {
    return false;
  }
  drag(): void {}
  release(): void {}
  cancel(): Promise<void> {
    return Promise.resolve();
  }

  click(viewport: Viewport, event: PointerEvent): void {
    const edge = this.at(viewport, event, event.pointerType === 'touch' ? 22 : 12);
    if (edge !== null) {
      this.onEdge(this.surface!, edge, { x: event.clientX, y: event.clientY });
      return;
    }
    const hit = this.viewer.pick(viewport, event);
    if (hit && !this.viewer.isSelected(hit.surface)) void this.select(hit.surface);
  }

  hover(viewport: Viewport | null, event?: PointerEvent): void {
    const edge = viewport && event ? this.at(viewport, event, 12) : null;
    if (viewport) viewport.element.style.cursor = edge ? 'pointer' : '';
    if (edge === this.hovered) return;
    this.hovered = edge;
    this.refresh(this.shown);
  }

  /** For symmetry about an edge: the plane perpendicular to the axis along which the edge's points differ least. */
  plane(edge: Edge): { point: Vector3; normal: Vector3 } {
    const points = this.points(edge)!;
    const box = new THREE.Box3().setFromArray(Array.from(points));
    const size = box.getSize(new THREE.Vector3()).toArray();
    const axis = size.indexOf(Math.min(...size));
    const middle = box.getCenter(new THREE.Vector3()).add(new THREE.Vector3(...this.viewer.origin));
    return { point: middle.toArray(), normal: new THREE.Vector3().setComponent(axis, 1).toArray() };
  }
}
