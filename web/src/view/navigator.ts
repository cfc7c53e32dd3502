import * as THREE from 'three';

import { orbit, pan, zoom } from './camera';
import { type Convention, type Motion, motionOf } from './conventions';
import type { Viewport } from './viewport';

interface Drag {
  viewport: Viewport;
  pointer: number;
  motion: Motion;
  pivot: THREE.Vector3;
  x: number;
  y: number;
}

type Place = { clientX: number; clientY: number };

const fingers = (places: Place[]) => ({
  x: places.reduce((sum, p) => sum + p.clientX, 0) / places.length,
  y: places.reduce((sum, p) => sum + p.clientY, 0) / places.length,
  apart: places.length > 1 ? Math.hypot(places[1]!.clientX - places[0]!.clientX, places[1]!.clientY - places[0]!.clientY) : 1,
  angle: places.length > 1 ? Math.atan2(places[1]!.clientY - places[0]!.clientY, places[1]!.clientX - places[0]!.clientX) : 0,
});

/** Moves the cameras: by mouse in one of the conventions, by wheel, or by one to three fingers. */
export class Navigator {
  convention: Convention = 'knead';

  private drag: Drag | null = null;
  private touch: { viewport: Viewport; pivot: THREE.Vector3; places: Map<number, Place> } | null = null;

  /** `pointAt`: the point under a pointer, or, off the surface, the point at the depth of the view's target. */
  constructor(private readonly pointAt: (viewport: Viewport, at: Place) => THREE.Vector3) {}

  get active(): boolean {
    return this.drag !== null || this.touch !== null;
  }

  press(viewport: Viewport, event: PointerEvent): boolean {
    const motion = event.pointerType === 'touch' ? (viewport.axial ? 'pan' : 'orbit') : motionOf(this.convention, event, viewport.axial);
    if (!motion || this.drag) return false;
    viewport.element.setPointerCapture(event.pointerId);
    this.drag = { viewport, pointer: event.pointerId, motion, pivot: this.pointAt(viewport, event), x: event.clientX, y: event.clientY };
    return true;
  }

  move(event: PointerEvent): void {
    const { drag } = this;
    if (!drag || event.pointerId !== drag.pointer) return;
    const { viewport } = drag;
    const dx = event.clientX - drag.x;
    const dy = event.clientY - drag.y;
    drag.x = event.clientX;
    drag.y = event.clientY;
    const { height } = viewport.size();
    if (drag.motion === 'orbit') orbit(viewport, (-Math.PI * dx) / height, (-Math.PI * dy) / height, drag.pivot);
    else if (drag.motion === 'pan') pan(viewport, dx, dy, drag.pivot, height);
    else zoom(viewport, Math.exp(-0.006 * dy), drag.pivot);
    viewport.moved();
  }

  release(event: PointerEvent): void {
    const { drag } = this;
    if (drag?.pointer !== event.pointerId) return;
    this.drag = null;
    if (drag.viewport.element.hasPointerCapture(event.pointerId)) drag.viewport.element.releasePointerCapture(event.pointerId);
  }

  cancel(): void {
    this.drag = null;
    this.touch = null;
  }

  /** Two fingers pan, zoom and turn; three orbit. Takes the list of touching fingers after each change and motion. */
  touched(viewport: Viewport, places: Map<number, Place>): void {
    const before = this.touch;
    const same = before && before.viewport === viewport && before.places.size === places.size
      && [...places.keys()].every((id) => before.places.has(id));
    this.drag = null;
    if (places.size < 2) {
      this.touch = null;
      return;
    }
    const now = fingers([...places.values()]);
    const pivot = same ? before.pivot : this.pointAt(viewport, { clientX: now.x, clientY: now.y });
    if (same) {
      const old = fingers([...places.keys()].map((id) => before.places.get(id)!));
      const { height } = viewport.size();
      if (places.size === 2) {
        pan(viewport, now.x - old.x, now.y - old.y, pivot, height);
        zoom(viewport, now.apart / Math.max(1, old.apart), viewport.unprojectInScene(now.x, now.y, pivot));
        let turn = now.angle - old.angle;
        if (turn > Math.PI) turn -= 2 * Math.PI;
        if (turn < -Math.PI) turn += 2 * Math.PI;
        if (!viewport.axial) orbit(viewport, turn, 0, pivot);
      } else if (!viewport.axial) {
        orbit(viewport, (-Math.PI * (now.x - old.x)) / height, (-Math.PI * (now.y - old.y)) / height, pivot);
      }
      viewport.moved();
    }
    this.touch = { viewport, pivot, places: new Map(places) };
  }

  wheel(viewport: Viewport, event: WheelEvent): void {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : event.deltaMode === WheelEvent.DOM_DELTA_PAGE ? 300 : 1;
    // A trackpad's pinch arrives as a wheel event with Ctrl, in finer steps.
    const rate = event.ctrlKey ? 0.01 : 0.0016;
    const amount = THREE.MathUtils.clamp(event.deltaY * lines * rate, -0.7, 0.7);
    zoom(viewport, Math.exp(-amount), this.pointAt(viewport, event));
    viewport.moved();
  }
}
