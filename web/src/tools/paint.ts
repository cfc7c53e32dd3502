import * as THREE from 'three';

import type { Command, MaterialSamples, SurfaceInfo } from '../engine/session_types';
import { blocks, mark, region } from '../view/net';
import { disc, lineFractions } from '../view/surface_view';
import type { Hit, Viewer } from '../view/viewer';
import type { Viewport } from '../view/viewport';
import { blended, difference, samplePlaces, sampleCounts } from './material_paint';
import type { PointerTool } from './pointers';
import { Ring } from './ring';

export interface PaintSettings {
  alpha: number;
  beta: number;
  /** Share of the brush's radius over which the paint fades. */
  softness: number;
}

export interface PaintActions {
  execute(commands: Command[]): Promise<unknown>;
  /** The present material of a surface. */
  material(surface: number, counts: [number, number]): Promise<MaterialSamples>;
  select(surface: number): Promise<void>;
}

const clayMaterial = { alpha: 0.1, beta: 0.001 };

export type PaintKind = 'pin' | 'freeze' | 'material';

interface Stroke {
  viewport: Viewport;
  surface: number;
  kind: PaintKind;
  erase: boolean;
  /** Spans, row by row; for pins, control points. */
  marked: Uint8Array;
  /** For material: the positions of its samples, and how much paint each has received. */
  places: Float32Array;
  share: Float32Array;
  start: Hit;
  at: { x: number; y: number };
  moved: boolean;
}

/**
 * Marks a part of the surface by dragging over it: control points under the brush, or whole knot spans that it touches.
 * On release this becomes commands: one history entry.
 */
export class Paint implements PointerTool {
  settings: PaintSettings = { alpha: 0.05, beta: 0.05, softness: 0.4 };
  kind: PaintKind = 'freeze';

  private stroke: Stroke | null = null;
  private shown = '';
  private readonly ring: Ring;
  private readonly dots: THREE.Points<THREE.BufferGeometry, THREE.PointsMaterial>;

  constructor(private readonly viewer: Viewer, private readonly radius: () => number, private readonly actions: PaintActions) {
    this.ring = new Ring(viewer);
    this.dots = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ sizeAttenuation: false, depthTest: false, alphaMap: disc(), alphaTest: 0.5 }));
    this.dots.visible = this.dots.frustumCulled = false;
    this.dots.renderOrder = 12;
    viewer.overlay.add(this.dots);
  }

  get active(): boolean {
    return this.stroke !== null;
  }

  press(viewport: Viewport, event: PointerEvent): boolean {
    const hit = this.viewer.pick(viewport, event);
    const state = this.viewer.frame?.state;
    if (!hit || !state) return false;
    if (!this.viewer.isSelected(hit.surface)) {
      void this.actions.select(hit.surface);
      return true;
    }
    const { picture } = this.viewer.surfaces[hit.surface]!;
    const [m, n] = state.surfaces[hit.surface]!.net;
    const size = this.kind === 'pin' ? m * n : (picture!.lines_u.length - 1) * (picture!.lines_v.length - 1);
    const counts = sampleCounts(state.surfaces[hit.surface]!);
    const places = this.kind === 'material' ? samplePlaces(picture!, counts) : new Float32Array(0);
    this.stroke = { places, share: new Float32Array(places.length / 3), viewport, surface: hit.surface, kind: this.kind, erase: event.altKey, marked: new Uint8Array(size), start: hit,
      at: { x: event.clientX, y: event.clientY }, moved: false };
    this.paint(this.stroke, hit);
    return true;
  }

  drag(event: PointerEvent): void {
    const { stroke } = this;
    if (!stroke) return;
    // Nothing between two positions of the pointer is left out.
    const { x, y } = stroke.at;
    const way = Math.hypot(event.clientX - x, event.clientY - y);
    if (way > 3) stroke.moved = true;
    const count = Math.min(12, Math.max(1, Math.ceil(way / 12)));
    for (let k = 1; k <= count; ++k) {
      const place = { clientX: x + ((event.clientX - x) * k) / count, clientY: y + ((event.clientY - y) * k) / count };
      const hit = this.viewer.pick(stroke.viewport, place);
      if (hit && hit.surface === stroke.surface && hit.standing === stroke.start.standing) this.paint(stroke, hit);
    }
    stroke.at = { x: event.clientX, y: event.clientY };
  }

  private paint(stroke: Stroke, hit: Hit): void {
    const view = this.viewer.surfaces[stroke.surface]!;
    const picture = view.picture!;
    const radius = this.radius();
    const near = (array: Float32Array, k: number) =>
      (array[k]! - hit.point.x) ** 2 + (array[k + 1]! - hit.point.y) ** 2 + (array[k + 2]! - hit.point.z) ** 2 <= radius * radius;
    if (stroke.kind === 'pin') {
      for (let k = 0; 3 * k < picture.net.length; ++k) if (near(picture.net, 3 * k)) stroke.marked[k] = 1;
      this.showDots(stroke);
    } else {
      const [s, t] = hit.fractions;
      const [linesS, linesT] = lineFractions(picture);
      mark(stroke.marked, [[s - 1e-5, s + 1e-5], [t - 1e-5, t + 1e-5]], linesS, linesT);
      const columns = picture.lines_v.length - 1;
      const n = picture.counts[1];
      // Points inside a span, none on its border: those belong to the next span as well.
      for (let a = 0; a + 1 < picture.lines_u.length; ++a) {
        for (let b = 0; b < columns; ++b) {
          if (stroke.marked[a * columns + b]) continue;
          search: for (let k = picture.lines_u[a]! + 1; k < picture.lines_u[a + 1]!; ++k) {
            for (let l = picture.lines_v[b]! + 1; l < picture.lines_v[b + 1]!; ++l) {
              if (!near(picture.positions, 3 * (k * n + l))) continue;
              stroke.marked[a * columns + b] = 1;
              break search;
            }
          }
        }
      }
      view.showPainted(stroke.marked, stroke.erase);
      const soft = Math.max(1e-3, this.settings.softness) * radius;
      for (let k = 0; k < stroke.share.length; ++k) {
        const d = hit.point.distanceTo(new THREE.Vector3().fromArray(stroke.places, 3 * k));
        const share = Math.min(1, Math.max(0, (radius - d) / soft));
        stroke.share[k] = Math.max(stroke.share[k]!, share);
      }
    }
    this.ring.show(hit, radius);
  }

  private showDots(stroke: Stroke): void {
    const { net } = this.viewer.surfaces[stroke.surface]!.picture!;
    const places: number[] = [];
    stroke.marked.forEach((on, k) => {
      if (on) places.push(...net.subarray(3 * k, 3 * k + 3));
    });
    this.dots.geometry.setAttribute('position', new THREE.Float32BufferAttribute(places, 3));
    this.dots.material.color.set(stroke.erase ? this.viewer.palette.point : this.viewer.palette.held);
    this.dots.material.size = (1.4 * this.viewer.display.pointSize + 5) * Math.min(window.devicePixelRatio, 2);
    this.dots.visible = places.length > 0;
    this.viewer.redraw();
  }

  release(): void {
    const { stroke } = this;
    if (!stroke) return;
    this.stroke = null;
    void this.execute(stroke).finally(() => this.clear(stroke));
  }

  private async execute(stroke: Stroke): Promise<void> {
    const { surfaces } = this.viewer.frame!.state;
    const info = surfaces[stroke.surface]!;
    let commands: Command[];
    if (stroke.kind === 'material') {
      const base = await this.actions.material(stroke.surface, sampleCounts(info));
      const usual = { alpha: this.settings.alpha, beta: this.settings.beta };
      const paint = stroke.erase ? clayMaterial : usual;
      commands = blended(base, stroke.share, paint.alpha, paint.beta);
    } else commands = this.commands(stroke, info);
    if (commands.length > 0) await this.actions.execute(commands);
  }

  /** In the mode `material`: tints spans whose material differs from that of most of the surface. */
  async refresh(shown: boolean, changes: number): Promise<void> {
    const of = shown ? `${changes}` : '';
    if (of === this.shown || this.active) return;
    this.shown = of;
    const { frame, surfaces } = this.viewer;
    for (const [k, info] of (frame?.state.surfaces ?? []).entries()) {
      const view = surfaces[k];
      if (!view?.picture) continue;
      const varies = shown && [...info.alpha, ...info.beta].includes(null);
      const material = varies ? await this.actions.material(k, sampleCounts(info)) : null;
      if (this.shown !== of) return; // something newer is to be shown
      view.showMaterial(material && difference(material, ...lineFractions(view.picture)));
    }
    this.viewer.redraw();
  }

  private clear(stroke: Stroke): void {
    this.dots.visible = false;
    this.viewer.surfaces[stroke.surface]?.showPainted(null, false);
    this.viewer.redraw();
  }

  private commands(stroke: Stroke, info: SurfaceInfo): Command[] {
    const picture = this.viewer.surfaces[stroke.surface]!.picture!;
    const [linesS, linesT] = lineFractions(picture);
    const [rows, columns] = [linesS.length - 1, linesT.length - 1];
    if (stroke.kind === 'pin') {
      const n = info.net[1];
      const points = [...stroke.marked].flatMap((on, k): [number, number][] => (on ? [[Math.floor(k / n), k % n]] : []));
      if (stroke.erase) {
        const gone = new Set(points.map(String));
        const stay = info.pinned.filter((p) => !gone.has(String(p)));
        return released('pins', [...(stay.length > 0 ? [{ do: 'pin' as const, control_points: stay }] : []), ...info.constraints.filter((c) => c.do === 'pin')]);
      }
      if (points.length > 0) return [{ do: 'pin', control_points: points }];
      return stroke.moved ? [] : [{ do: 'pin', at: stroke.start.fractions }];
    }
    const freeze = (cells: Uint8Array): Command[] =>
      blocks(cells, rows, columns).map((block) => ({ do: 'freeze', region: region(block, linesS, linesT, true) }));
    if (!stroke.erase) return freeze(stroke.marked);
    const frozen = new Uint8Array(rows * columns);
    for (const c of info.constraints) if (c.do === 'freeze') mark(frozen, c.region, linesS, linesT);
    if (!frozen.some((on, k) => on && stroke.marked[k])) return [];
    stroke.marked.forEach((on, k) => {
      if (on) frozen[k] = 0;
    });
    return released('freeze', freeze(frozen));
  }

  cancel(): Promise<void> {
    const { stroke } = this;
    this.stroke = null;
    if (stroke) this.clear(stroke);
    return Promise.resolve();
  }

  hover(viewport: Viewport | null, event?: PointerEvent): void {
    const hit = viewport && event ? this.viewer.pick(viewport, event) : null;
    if (hit) this.ring.show(hit, this.radius());
    else this.ring.hide();
  }
}

/** Frees one kind of what is held; the part that is to stay is requested again. */
export const released = (what: 'pins' | 'freeze' | 'symmetry', stay: readonly Command[]): Command[] => [{ do: 'release', what: [what] }, ...stay];
