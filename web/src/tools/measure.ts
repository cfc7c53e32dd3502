import * as THREE from 'three';

import { type MeasuredPoint, type MeasureKind, measureKinds, newReading, pinnedReadings, type Reading } from '../document/readings';
import type { Client } from '../engine/client';
import type { Vector3 } from '../engine/session_types';
import { type Standing, still } from '../view/placing';
import type { Viewer } from '../view/viewer';
import { disc } from '../view/surface_view';
import type { Viewport } from '../view/viewport';
import type { PointerTool } from './pointers';

const colour = 0xf2c14e;

const rigid = 1e-9; // how much lengths of a part and the model may differ for a reading to be both

/** What was measured on a part, as it is where the part stands. */
export function inModel(point: MeasuredPoint, at: Standing, origin: readonly number[]): MeasuredPoint {
  if (at === still) return point;
  const p = new THREE.Vector3(...point.point.map((x, d) => x - origin[d]!) as Vector3).applyMatrix4(at.matrix);
  const n = new THREE.Vector3(...point.normal);
  if (n.lengthSq() > 0) n.applyNormalMatrix(new THREE.Matrix3().getNormalMatrix(at.matrix));
  return {
    ...point, point: p.toArray().map((x, d) => x + origin[d]!) as Vector3, normal: n.toArray(),
    curvature: point.curvature && point.curvature.map((k) => k / at.scale) as [number, number],
    place: Math.abs(at.scale - 1) < rigid ? `${at.part} ${at.place}` : null,
  };
}

/** Picks points of surfaces and grey faces, and measures at them. The numbers are the engine's: the picture says only which point is meant. */
export class Measure implements PointerTool {
  readonly active = false;
  kind: MeasureKind = 'distance';
  /** Of a reading under way. */
  picked: MeasuredPoint[] = [];

  private loose: Reading[] = [];
  private asked = 0;
  private readonly points = new THREE.Points(new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ size: 9, sizeAttenuation: false, color: colour, alphaMap: disc(), alphaTest: 0.5, depthTest: false, transparent: true }));
  private readonly lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: colour, depthTest: false, transparent: true }));

  constructor(
    private readonly viewer: Viewer,
    private readonly engine: Pick<Client, 'query'>,
    private readonly changed: () => void,
  ) {
    for (const part of [this.points, this.lines]) {
      part.frustumCulled = false;
      part.renderOrder = 15;
      part.visible = false;
      viewer.marks.add(part);
    }
  }

  /** The pinned ones first. */
  get readings(): Reading[] {
    const { viewer } = this;
    const pinned = pinnedReadings(viewer.frame?.state.readings ?? []).map((r): Reading => ({
      ...r, points: r.points.map((p) => inModel(p, viewer.working(p.surface), viewer.origin)),
    }));
    return [...pinned, ...this.loose];
  }

  /** Another document. */
  clear(): void {
    this.loose = [];
    this.forget();
  }

  /** Drops the points of a reading under way; false if there were none. */
  forget(): boolean {
    ++this.asked;
    const had = this.picked.length > 0;
    this.picked = [];
    return had;
  }

  /** It is pinned now, or not wanted any more. */
  drop(reading: Reading): void {
    this.loose = this.loose.filter((r) => r.name !== reading.name);
  }

  choose(kind: MeasureKind): void {
    this.kind = kind;
    this.forget();
    this.changed();
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
    const { viewer, engine } = this;
    const hit = viewer.pick(viewport, event);
    const grey = hit ? null : viewer.pickGrey(viewport, event);
    if (hit) void this.pick(engine.query('reading', { surface: hit.surface, at: hit.fractions }), hit.standing);
    else if (grey) void this.pick(engine.query('face_reading', { face: grey.face.id, near: grey.point.toArray().map((x, d) => x + viewer.origin[d]!) as Vector3 }), grey.standing);
    return true;
  }

  hover(viewport: Viewport | null): void {
    if (viewport) viewport.element.style.cursor = 'crosshair';
  }

  private async pick(read: Promise<MeasuredPoint>, at: Standing): Promise<void> {
    const asked = ++this.asked;
    const point = await read.catch(() => null);
    if (!point || asked !== this.asked) return;
    this.picked.push(inModel(point, at, this.viewer.origin));
    if (this.picked.length === measureKinds[this.kind]) {
      this.loose.push(newReading(this.kind, this.picked, this.readings));
      this.picked = [];
    }
    this.changed();
  }

  /** Draws the points, and lines between those of a reading. */
  refresh(): void {
    const { origin } = this.viewer;
    const inScene = ({ point }: { point: Vector3 }) => new THREE.Vector3(...point.map((x, d) => x - origin[d]!) as Vector3);
    const groups = [...this.readings.map((r) => r.points), this.picked];
    const dots = groups.flat().map(inScene);
    const ends = groups.flatMap((points) => points.slice(1).flatMap((p, k) => [inScene(points[k]!), inScene(p)]));
    if (dots.length === 0 && !this.points.visible) return;
    this.lines.geometry.dispose();
    this.lines.geometry = new THREE.BufferGeometry().setFromPoints(ends);
    this.points.geometry.dispose();
    this.points.geometry = new THREE.BufferGeometry().setFromPoints(dots);
    this.points.visible = dots.length > 0;
    this.lines.visible = ends.length > 0;
    this.viewer.redraw();
  }
}
