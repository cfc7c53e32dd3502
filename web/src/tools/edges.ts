import * as THREE from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';

import { type FaceEdge, hasEdges } from '../engine/context';
import type { Picture, SurfaceInfo, Vector3 } from '../engine/session_types';
import type { Viewer } from '../view/viewer';
import type { Viewport } from '../view/viewport';
import { type Continuity, continuityOf, type Edge, edgeNames, type HeldFace, isSide, type Meeting, meetingAt, type Side } from './held';
import type { PointerTool } from './pointers';

const colours: Record<Continuity, number> = {
  open: 0x8a97a5, follow: 0x4aa08c, position: 0xe0b13a, tangent: 0xe88433, curvature: 0xd6483d, symmetry: 0x9a6fd0,
};

const opening = 0xd64bb0; // free, though other faces meet there

/**
 * Shows the edges of the selected surface in the colour of what is asked of them; a click on one asks for something else.
 * Where faces of the file lie on it these are their edges, otherwise its sides.
 */
export class Edges implements PointerTool {
  readonly active = false;
  /** A click on an edge, with its position on the page. */
  onEdge: (surface: number, edge: Edge, at: { x: number; y: number }) => void = () => {};

  private readonly lines: Line2[] = [];
  private hovered: Edge | null = null;
  private shown = false;

  private readonly known = new Map<string, FaceEdge[]>(); // by the ids of surfaces
  private asked = '';

  constructor(
    private readonly viewer: Viewer,
    private readonly select: (surface: number) => Promise<void>,
    private readonly fetchEdges: (surface: number) => Promise<FaceEdge[]>,
    private readonly changed: () => void,
  ) {}

  /** Another file: its edges are others. */
  forget(): void {
    this.known.clear();
    this.asked = '';
  }

  private get info(): SurfaceInfo | undefined {
    return this.surface === undefined ? undefined : this.viewer.frame!.state.surfaces[this.surface];
  }

  /** Of the faces of the file on the selected surface; null as long as they are not known. */
  get faceEdges(): readonly FaceEdge[] | null {
    const { info } = this;
    if (!info || !hasEdges(info)) return [];
    return this.known.get(info.id) ?? null;
  }

  /** What can be clicked. */
  get edges(): readonly Edge[] {
    const ids = this.faceEdges?.map((e) => e.id as Edge) ?? [];
    return ids.length > 0 ? ids : edgeNames;
  }

  /** What happens at an edge of a face when it is let go. */
  meeting(edge: Edge): Meeting | null {
    const { info } = this;
    const known = this.faceEdges?.find((e) => e.id === edge);
    return info && known ? meetingAt(known, info.id) : null;
  }

  /** All selected surfaces and the edges of the faces on them; null as long as those of one are not known. */
  get held(): HeldFace[] | null {
    const faces: HeldFace[] = [];
    for (const info of this.selected.map(([, s]) => s)) {
      const known = hasEdges(info) ? this.known.get(info.id) : [];
      if (!known) return null;
      faces.push({ info, edges: known.map((e) => e.id as Edge), open: known.filter((e) => meetingAt(e, info.id).opens).map((e) => e.id as Edge) });
    }
    return faces;
  }

  private get selected(): (readonly [number, SurfaceInfo])[] {
    const state = this.viewer.frame?.state;
    return state ? state.selection.map((k) => [k, state.surfaces[k]!] as const) : [];
  }

  /** One surface after the other: each that becomes known has the next one asked for. */
  private async learn(): Promise<void> {
    const [surface, info] = this.selected.find(([, s]) => hasEdges(s) && !this.known.has(s.id)) ?? [];
    if (!info || surface === undefined || this.asked === info.id) return;
    this.asked = info.id;
    const edges = await this.fetchEdges(surface).catch(() => []);
    if (this.asked !== info.id) return; // another file, or another surface
    this.known.set(info.id, edges);
    this.asked = '';
    this.changed();
  }

  private get surface(): number | undefined {
    return this.viewer.frame?.state.selection[0];
  }

  /** Points along an edge, 3 numbers each, scene coordinates. */
  points(edge: Edge): Float32Array | null {
    const picture = this.surface === undefined ? null : this.viewer.surfaces[this.surface]?.picture;
    if (!picture) return null;
    if (!isSide(edge)) return alongCourse(picture, this.faceEdges?.find((e) => e.id === edge)?.course ?? []);
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
    void this.learn();
    if (!shown && !this.shown) return;
    this.shown = shown;
    const { info } = this;
    const edges = shown && info && !this.viewer.waiting ? this.edges : [];
    for (const line of this.lines.slice(edges.length)) line.visible = false;
    edges.forEach((edge, k) => {
      const line = (this.lines[k] ??= this.line());
      const places = this.points(edge);
      line.visible = places !== null && places.length > 3;
      if (!line.visible) return;
      line.geometry.dispose();
      line.geometry = new LineGeometry();
      line.geometry.setPositions(places!);
      const continuity = continuityOf(info!, edge);
      const opens = continuity === 'open' && this.meeting(edge)?.opens;
      line.material.color.set(opens ? opening : colours[continuity]);
      line.material.linewidth = this.hovered === edge ? 7 : continuity === 'open' && !opens ? 2.5 : 4;
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
    if (this.viewer.waiting) return null;
    for (const edge of this.edges) {
      const points = this.points(edge);
      if (!points) continue;
      const places = this.viewer.places(viewport, points);
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

  click(viewport: Viewport, event: PointerEvent): boolean {
    const edge = this.at(viewport, event, event.pointerType === 'touch' ? 22 : 12);
    if (edge !== null) {
      this.onEdge(this.surface!, edge, { x: event.clientX, y: event.clientY });
      return true;
    }
    const hit = this.viewer.pick(viewport, event);
    if (hit && !this.viewer.isSelected(hit.surface)) void this.select(hit.surface);
    return hit !== null;
  }

  hover(viewport: Viewport | null, event?: PointerEvent): void {
    const edge = viewport && event ? this.at(viewport, event, 12) : null;
    if (viewport) viewport.element.style.cursor = edge ? 'pointer' : '';
    if (edge === this.hovered) return;
    this.hovered = edge;
    this.refresh(this.shown);
  }

  /** For symmetry about an edge: the plane across the axis along which the edge's places differ least. */
  plane(edge: Side): { point: Vector3; normal: Vector3 } {
    const points = this.points(edge)!;
    const box = new THREE.Box3().setFromArray(Array.from(points));
    const size = box.getSize(new THREE.Vector3()).toArray();
    const axis = size.indexOf(Math.min(...size));
    const middle = box.getCenter(new THREE.Vector3()).add(new THREE.Vector3(...this.viewer.origin));
    return { point: middle.toArray(), normal: new THREE.Vector3().setComponent(axis, 1).toArray() };
  }
}

/** Places on the drawn surface along a course of fractions, 3 numbers each: between the points of the picture, where it is flat. */
export function alongCourse({ counts: [m, n], positions, s, t }: Picture, course: readonly number[]): Float32Array {
  const result = new Float32Array(1.5 * course.length);
  for (let k = 0; 2 * k < course.length; ++k) {
    const [i, a] = cell(s, course[2 * k]!);
    const [j, b] = cell(t, course[2 * k + 1]!);
    for (let d = 0; d < 3; ++d) {
      const at = (row: number, column: number) => positions[3 * (Math.min(row, m - 1) * n + Math.min(column, n - 1)) + d]!;
      result[3 * k + d] = (1 - a) * ((1 - b) * at(i, j) + b * at(i, j + 1)) + a * ((1 - b) * at(i + 1, j) + b * at(i + 1, j + 1));
    }
  }
  return result;
}

/** The cell of ascending lines that holds a fraction, and how far in; beyond the ends a closed surface goes on at its beginning. */
function cell(lines: Float32Array, fraction: number): [number, number] {
  const x = fraction < 0 || fraction > 1 ? fraction - Math.floor(fraction) : fraction;
  let [low, high] = [0, lines.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (lines[middle]! <= x) low = middle;
    else high = middle;
  }
  const width = lines[high]! - lines[low]!;
  return [low, width > 0 ? Math.min(1, Math.max(0, (x - lines[low]!) / width)) : 0];
}
