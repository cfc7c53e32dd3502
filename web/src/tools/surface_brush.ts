import * as THREE from 'three';

import type { BrushCommand } from '@knead/generated';
import type { Command, Vector3 } from '../engine/session_types';
import type { GridPicker } from '../view/picking';
import type { Hit, Viewer } from '../view/viewer';
import type { Viewport } from '../view/viewport';
import type { BrushActions } from './brush';
import { axisOf, pressureOf } from './pen';
import type { PointerTool } from './pointers';
import { Ring } from './ring';

export type BrushKind = BrushCommand['kind'];

/** As `axisOf`, of a surface that stands elsewhere. */
function leaning(event: PointerEvent, camera: THREE.Camera, { normal, standing: { matrix, inverse } }: Hit): Vector3 {
  const axis = new THREE.Vector3(...axisOf(event, camera, normal.clone().transformDirection(matrix)));
  return axis.lengthSq() > 0 ? axis.transformDirection(inverse).toArray() : [0, 0, 0];
}

/** In the order of the picker: what is done along a path, about a place, and to the mask. */
export const brushKinds: readonly (readonly [BrushKind, string])[] = [
  ['inflate', 'Along the normal of each point. Alt: inwards'], ['pull', 'Out of the surface. Alt pushes'], ['push', 'Into the surface. Alt pulls'],
  ['flatten', 'Towards the plane that fits what is under it'], ['smooth', 'Towards the fair shape'], ['pinch', 'Towards the path, within the surface'],
  ['crease', 'A sharp valley along the path. Alt: a crest'], ['ridge', 'A sharp crest along the path. Alt: a valley'],
  ['grab', 'Takes a point and what is round it along'], ['twist', 'Turns about a point: drag sideways'], ['scale', 'Larger or smaller about a point: drag sideways'],
  ['stamp', 'A shape or an image as a height: drag sideways to turn it. Alt presses it in'],
  ['mask', 'Paints what is to stay as it is. Alt frees'], ['unmask', 'Frees what is masked. Alt masks'],
];

export interface SurfaceBrushSettings {
  kind: BrushKind;
  /** Of what has a height in radii, of the others the share of the way that points go. */
  strength: number;
  /** Length of the rope by which the pointer draws the brush, in radii. */
  steady: number;
  /** The plane in which a stroke is repeated; `at` in file units. */
  mirror: { axis: 'x' | 'y' | 'z'; at: number } | null;
  /** What the pressure of a pen scales. */
  presses: NonNullable<BrushCommand['presses']>;
  /** Whether a pen that leans leans what the brush does. */
  tilt: boolean;
  /** What a stamp presses: the shape of a tool, or the heights of an image. */
  stamp: { shape: string } | { image: string; pattern: number[][] };
  /** Strokes around the axis z through the middle of what is selected. */
  radial: number;
}

const opposite: Partial<Record<BrushKind, BrushKind>> = {
  push: 'pull', pull: 'push', crease: 'ridge', ridge: 'crease', mask: 'unmask', unmask: 'mask',
};
const heights: readonly BrushKind[] = ['push', 'pull', 'inflate', 'crease', 'ridge', 'stamp'];
const shares: readonly BrushKind[] = ['flatten', 'smooth', 'pinch', 'mask', 'unmask'];
const aboutPlaces: readonly BrushKind[] = ['grab', 'twist', 'scale', 'stamp'];
/** Of the radius, at full strength. */
const fullHeight = 0.5;
/** Pixels by which a twist turns one degree and a scale grows by e. */
const perDegree = 2, perFactor = 160;

interface Stroke {
  viewport: Viewport;
  frozen: (GridPicker | null)[];
  /** All but the path and what the hand changes. */
  fields: Omit<BrushCommand, 'path' | 'surfaces'>;
  start: THREE.Vector3;
  pressed: number;
  /** Points of the path not yet sent to the session, each with the id of its surface and how a pen is held there. */
  ahead: { at: [number, number]; surface: string; pressure: number | null; axis: Vector3 | null }[];
  begun: Promise<boolean>;
  cancelled: boolean;
}

/** Leads the brushes of the session over the surface, from the shape that stood when the button went down. */
export class SurfaceBrush implements PointerTool {
  settings: SurfaceBrushSettings = { kind: 'inflate', strength: 0.5, steady: 0, mirror: null, radial: 1, presses: 'depth', tilt: false, stamp: { shape: 'torus' } };

  private stroke: Stroke | null = null;
  private readonly ring: Ring;

  /** `size` is the radius that all brushes have; `resize` multiplies it. */
  constructor(private readonly viewer: Viewer, private readonly actions: BrushActions, private readonly size: () => number,
              private readonly resize: (factor: number) => void) {
    this.ring = new Ring(viewer);
  }

  get active(): boolean {
    return this.stroke !== null;
  }

  /** The middle of what is selected, file units. */
  middle(): Vector3 {
    const state = this.viewer.frame?.state;
    const chosen = state?.surfaces.filter((_, k) => (state.selection.length > 0 ? state.selection.includes(k) : k === 0)) ?? [];
    if (chosen.length === 0) return [0, 0, 0];
    return [0, 1, 2].map((k) => (Math.min(...chosen.map((s) => s.lower[k]!)) + Math.max(...chosen.map((s) => s.upper[k]!))) / 2) as Vector3;
  }

  wheel(event: WheelEvent): boolean {
    if (!this.stroke && !event.shiftKey && !event.altKey) return false;
    const factor = Math.exp(-Math.sign(event.deltaY !== 0 ? event.deltaY : event.deltaX) * 0.12);
    if (event.altKey) this.settings.strength = Math.min(1, Math.max(0.02, this.settings.strength * factor));
    else if (!this.stroke) this.resize(factor); // a stroke keeps its size
    this.actions.settingsChanged();
    return true;
  }

  press(viewport: Viewport, event: PointerEvent): boolean {
    const hit = this.viewer.pick(viewport, event);
    if (!hit) return false;
    const { state } = this.viewer.frame!;
    if (!state.selection.includes(hit.surface)) {
      void this.actions.select(hit.surface);
      return true;
    }
    const stroke: Stroke = {
      viewport, frozen: this.viewer.pickers, fields: this.fields(event), start: hit.point.clone(), pressed: event.clientX,
      ahead: [this.pointOf(hit, viewport, event)], begun: Promise.resolve(true), cancelled: false,
    };
    this.stroke = stroke;
    stroke.begun = this.actions.begin([this.on(stroke, true)]);
    return true;
  }

  private pointOf(hit: Hit, viewport: Viewport, event: PointerEvent): Stroke['ahead'][number] {
    const { kind, presses, tilt } = this.settings;
    const pen = event.pointerType === 'pen';
    return {
      at: hit.fractions, surface: this.viewer.frame!.state.surfaces[hit.surface]!.id,
      pressure: presses === 'none' || aboutPlaces.includes(kind) ? null : pressureOf(event),
      axis: pen && tilt ? leaning(event, viewport.camera, hit) : null,
    };
  }

  private fields(event: PointerEvent): Stroke['fields'] {
    const { settings } = this;
    const kind = event.shiftKey ? 'smooth' : event.altKey ? (opposite[settings.kind] ?? settings.kind) : settings.kind;
    const radius = this.size();
    const inward = event.altKey && (settings.kind === 'inflate' || settings.kind === 'stamp');
    const [x, y, z] = this.middle();
    const fields: Stroke['fields'] = { do: 'brush', kind, radius };
    if (event.pointerType === 'pen' && settings.presses !== 'depth' && !aboutPlaces.includes(kind)) fields.presses = settings.presses;
    if (heights.includes(kind)) fields.height = (inward ? -1 : 1) * fullHeight * settings.strength * radius;
    if (kind === 'stamp') Object.assign(fields, 'shape' in settings.stamp ? { shape: settings.stamp.shape } : { pattern: settings.stamp.pattern });
    if (shares.includes(kind)) fields.strength = kind === 'mask' || kind === 'unmask' ? 1 : settings.strength;
    if (settings.steady > 0 && !aboutPlaces.includes(kind)) fields.steady = settings.steady;
    if (settings.mirror) {
      const k = 'xyz'.indexOf(settings.mirror.axis);
      const on = (value: number) => [0, 1, 2].map((i) => (i === k ? value : 0)) as Vector3;
      fields.mirror = [on(settings.mirror.at), on(1)];
    }
    if (settings.radial > 1) Object.assign(fields, { radial: settings.radial, axis: [[x, y, z], [0, 0, 1]] });
    return fields;
  }

  /** What the hand changes as it goes, of the kinds that act about a place. */
  private carried(stroke: Stroke, event: PointerEvent): Partial<BrushCommand> {
    const aside = event.clientX - stroke.pressed;
    if (stroke.fields.kind === 'twist' || stroke.fields.kind === 'stamp') return { angle: aside / perDegree };
    if (stroke.fields.kind === 'scale') return { factor: Math.exp(aside / perFactor) };
    return { by: stroke.viewport.unproject(event.clientX, event.clientY, stroke.start).sub(stroke.start).toArray() };
  }

  drag(event: PointerEvent): void {
    const { stroke } = this;
    if (!stroke) return;
    if (aboutPlaces.includes(stroke.fields.kind)) {
      Object.assign(stroke.fields, this.carried(stroke, event));
      void this.followOn(stroke);
      return;
    }
    const hit = this.viewer.pick(stroke.viewport, event, stroke.frozen);
    if (!hit || !this.viewer.isSelected(hit.surface)) return;
    this.ring.show(hit, this.size());
    stroke.ahead.push(this.pointOf(hit, stroke.viewport, event));
    void this.followOn(stroke);
  }

  private on(stroke: Stroke, open: boolean): Command {
    const points = stroke.ahead.splice(0);
    const several = this.viewer.frame!.state.selection.length > 1;
    return {
      ...stroke.fields, path: points.map(({ at }) => at), ...(several ? { surfaces: points.map(({ surface }) => surface) } : {}),
      ...(points.some(({ pressure }) => pressure !== null) ? { pressure: points.map(({ pressure }) => pressure ?? 1) } : {}),
      ...(points.some(({ axis }) => axis) ? { tilt: points.map(({ axis }) => axis ?? [0, 0, 0]) } : {}),
      ...(open ? { open } : {}),
    } as Command;
  }

  private async followOn(stroke: Stroke): Promise<void> {
    const begun = await stroke.begun;
    if (begun && !stroke.cancelled && this.stroke === stroke) this.actions.follow(() => [this.on(stroke, true)], true);
  }

  release(): void {
    const { stroke } = this;
    if (!stroke) return;
    this.stroke = null;
    void (async () => {
      if ((await stroke.begun) && !stroke.cancelled) await this.actions.end([this.on(stroke, false)]);
    })();
  }

  click(viewport: Viewport, event: PointerEvent): boolean {
    const tool = this.viewer.pickTool(viewport, event);
    this.actions.pickTool(tool);
    return tool !== null;
  }

  /** Esc: as if the stroke had never been. */
  async cancel(): Promise<void> {
    const { stroke } = this;
    if (!stroke) return;
    stroke.cancelled = true;
    this.stroke = null;
    if (await stroke.begun) await this.actions.cancel();
  }

  hover(viewport: Viewport | null, event?: PointerEvent): void {
    const hit = viewport && event ? this.viewer.pick(viewport, event) : null;
    if (hit) this.ring.show(hit, this.size());
    else this.ring.hide();
  }
}
