import * as THREE from 'three';

import { type MeasuredPoint, type MeasureKind, measureKinds, newReading, pinnedReadings, type Reading } from '../document/readings';
import type { Vector3 } from '../engine/session_types';
import type { Viewer } from '../view/viewer';
import { disc } from '../view/surface_view';
import type { Viewport } from '../view/viewport';
import type { PointerTool } from './pointers';

const colour = 0xf2c14e;

/** Who knows the numbers: at a place of a surface, and of a grey face near a point of the file. */
export interface Reader {
  reading(surface: number, at: [number, number]): Promise<MeasuredPoint>;
  faceReading(face: string, near: Vector3): Promise<MeasuredPoint>;
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
    private readonly engine: Reader,
    private readonly changed: () => void,
  ) {
    for (const part of [this.points, this.lines]) {
      part.frustumCulled = false;
      part.renderOrder = 15;
      part.visible = false;
      viewer.overlay.add(part);
    }
  }

  /** The pinned ones first. */
  get readings(): Reading[] {
    return [...pinnedReadings(this.viewer.frame?.state.readings ?? []), ...this.loose];
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
    if (hit) void this.pick(engine.reading(hit.surface, hit.fractions));
    else if (grey) void this.pick(engine.faceReading(grey.face.id, grey.point.toArray().map((x, d) => x + viewer.origin[d]!) as Vector3));
    return true;
  }

  hover(viewport: Viewport | null): void {
    if (viewport) viewport.element.style.cursor = 'crosshair';
  }

  private async pick(read: Promise<MeasuredPoint>): Promise<void> {
    const asked = ++this.asked;
    const point = await read.catch(() => null);
    if (!point || asked !== this.asked) return;
    this.picked.push(point);
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
