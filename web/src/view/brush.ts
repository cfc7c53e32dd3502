import * as THREE from 'three';

import type { Command } from '../engine/session_types';
import type { Viewer } from './viewer';
import type { Viewport } from './viewport';

export type Mode = 'look' | 'push' | 'pull' | 'grab' | 'pin' | 'place';

export interface BrushSettings {
  /** Radius of the ball, file units. */
  radius: number;
  /** How deep it goes, in radii. */
  strength: number;
}

/** What the pointer asks of the session. */
export interface BrushActions {
  /** A new act of these commands; resolves once they are done, false if they failed. */
  begin(commands: Command[]): Promise<boolean>;
  /** Goes on with the act; what comes too fast is left out. */
  follow(commands: () => Command[], join: boolean): void;
  /** Ends the act. */
  end(commands: Command[]): Promise<void>;
  /** Takes the act back. */
  cancel(): Promise<void>;
  place(point: THREE.Vector3, normal: THREE.Vector3): void;
  select(surface: number): Promise<void>;
  pickTool(name: string | null): void;
  settingsChanged(): void;
}

export const brushName = 'brush';
const mostSteps = 8; // between two places of the pointer that the session has seen

interface Stroke {
  viewport: Viewport;
  pointer: number;
  surface: number;
  kind: 'ball' | 'grab';
  inward: boolean;
  frozen: THREE.Mesh[];
  begun: Promise<boolean>;
  start: THREE.Vector3;
  /** Where the ball is for the session. */
  last: { point: THREE.Vector3; normal: THREE.Vector3 };
  at: [number, number];
  cancelled: boolean;
  moved: boolean;
}

/** Turns pointer events into strokes: a ball pressed along the surface, or a point dragged. */
export class Brush {
  mode: Mode = 'push';
  settings: BrushSettings = { radius: 1, strength: 0.5 };

  private stroke: Stroke | null = null;
  private readonly ring: THREE.LineLoop<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  private press: { x: number; y: number } | null = null;

  constructor(private readonly viewer: Viewer, private readonly actions: BrushActions) {
    const circle = Array.from({ length: 64 }, (_, k) => {
      const a = (2 * Math.PI * k) / 64;
      return new THREE.Vector3(Math.cos(a), Math.sin(a), 0);
    });
    this.ring = new THREE.LineLoop(
      new THREE.BufferGeometry().setFromPoints(circle),
      new THREE.LineBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 }),
    );
    this.ring.renderOrder = 20;
    this.ring.visible = false;
    viewer.overlay.add(this.ring);
    for (const viewport of viewer.viewports) this.listen(viewport);
  }

  get active(): boolean {
    return this.stroke !== null;
  }

  private listen(viewport: Viewport): void {
    const { element } = viewport;
    // Before the controls of the camera see it.
    element.addEventListener('pointerdown', (e) => this.down(viewport, e), { capture: true });
    element.addEventListener('pointermove', (e) => this.move(viewport, e), { capture: true });
    element.addEventListener('pointerup', (e) => this.up(viewport, e), { capture: true });
    element.addEventListener('pointercancel', () => void this.cancel(), { capture: true });
    element.addEventListener('pointerleave', () => this.hover(null));
    element.addEventListener('wheel', (e) => this.wheel(e), { capture: true, passive: false });
    element.addEventListener('contextmenu', (e) => e.preventDefault());
  }

  private wheel(event: WheelEvent): void {
    if (!this.active && !event.shiftKey) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const delta = event.deltaY !== 0 ? event.deltaY : event.deltaX;
    this.settings.radius *= Math.exp(-Math.sign(delta) * 0.12);
    this.actions.settingsChanged();
  }

  private down(viewport: Viewport, event: PointerEvent): void {
    if (event.button !== 0 || this.active) return;
    this.press = { x: event.clientX, y: event.clientY };
    if (viewport.gizmo.axis !== null && viewport.gizmo.object) return; // the gizmo takes it
    if (this.mode === 'look' || this.mode === 'pin') return;
    const hit = this.viewer.pick(viewport, event);
    if (!hit) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    if (this.mode === 'place') {
      this.actions.place(hit.point, hit.normal);
      return;
    }
    viewport.element.setPointerCapture(event.pointerId);
    // The shape at the press is what the pointer moves along, so that a stroke keeps its depth.
    const frozen = this.viewer.surfaces.map((s) => {
      const mesh = new THREE.Mesh(s.mesh.geometry.clone(), new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
      mesh.userData.surface = s.mesh.userData.surface;
      return mesh;
    });
    const kind = this.mode === 'grab' ? 'grab' : 'ball';
    const inward = (this.mode === 'push') !== event.altKey;
    const stroke: Stroke = {
      viewport, pointer: event.pointerId, surface: hit.surface, kind, inward, frozen,
      begun: Promise.resolve(true), start: hit.point.clone(), last: hit, at: hit.fractions, cancelled: false, moved: false,
    };
    this.stroke = stroke;
    stroke.begun = (async () => {
      if (!this.viewer.frame!.state.selection.includes(hit.surface)) await this.actions.select(hit.surface);
      const first = kind === 'ball' ? this.ball(hit.point, hit.normal, inward) : [this.drag(stroke, new THREE.Vector3())];
      return this.actions.begin(first);
    })();
  }

  private move(viewport: Viewport, event: PointerEvent): void {
    const { stroke } = this;
    if (!stroke) {
      if (event.buttons === 0) this.hover(viewport, event);
      return;
    }
    event.stopImmediatePropagation();
    if (event.pointerId !== stroke.pointer) return;
    if (stroke.kind === 'ball') {
      const hit = this.viewer.pick(stroke.viewport, event, stroke.frozen);
      if (!hit) return;
      this.showRing(hit.point, hit.normal);
      void this.followOn(stroke, () => this.towards(stroke, hit), true);
    } else {
      const by = this.inViewPlane(stroke, event).sub(stroke.start);
      void this.followOn(stroke, () => [{ do: 'undo' }, this.drag(stroke, by)], false);
    }
    stroke.moved = true;
  }

  private async followOn(stroke: Stroke, commands: () => Command[], join: boolean): Promise<void> {
    const begun = await stroke.begun;
    if (begun && !stroke.cancelled && this.stroke === stroke) this.actions.follow(commands, join);
  }

  private up(viewport: Viewport, event: PointerEvent): void {
    const { stroke } = this;
    if (!stroke) {
      this.click(viewport, event);
      return;
    }
    if (event.pointerId !== stroke.pointer) return;
    event.stopImmediatePropagation();
    this.finish(stroke);
    void (async () => {
      if ((await stroke.begun) && !stroke.cancelled) {
        await this.actions.end(stroke.kind === 'ball' ? [{ do: 'remove', tool: brushName }] : []);
      }
    })();
  }

  /** A press and release in one place, not a stroke: selects what is there. */
  private click(viewport: Viewport, event: PointerEvent): void {
    const { press } = this;
    this.press = null;
    if (event.button !== 0 || !press || Math.hypot(event.clientX - press.x, event.clientY - press.y) > 4) return;
    if (viewport.gizmo.axis !== null && viewport.gizmo.object) return;
    if (this.mode === 'pin') {
      const surface = this.viewer.frame?.state.selection[0];
      if (surface === undefined) return;
      const point = this.viewer.pickControlPoint(viewport, event, surface);
      const columns = this.viewer.frame!.state.surfaces[surface]!.net[1];
      if (point !== null) {
        void this.actions.end([{ do: 'pin', control_points: [[Math.floor(point / columns), point % columns]] }]);
      } else {
        const hit = this.viewer.pick(viewport, event);
        if (hit && hit.surface === surface) void this.actions.end([{ do: 'pin', at: hit.fractions }]);
      }
      return;
    }
    const tool = this.viewer.pickTool(viewport, event);
    this.actions.pickTool(tool);
    if (tool) return;
    const hit = this.viewer.pick(viewport, event);
    if (hit && !this.viewer.frame!.state.selection.includes(hit.surface)) void this.actions.select(hit.surface);
  }

  /** Esc: as if the stroke had never been. */
  async cancel(): Promise<void> {
    const { stroke } = this;
    if (!stroke) return;
    stroke.cancelled = true;
    this.finish(stroke);
    if (await stroke.begun) await this.actions.cancel();
  }

  private finish(stroke: Stroke): void {
    this.stroke = null;
    this.press = null;
    for (const mesh of stroke.frozen) {
      mesh.geometry.dispose();
      (mesh.material as THREE.Material).dispose();
    }
    if (stroke.viewport.element.hasPointerCapture(stroke.pointer)) stroke.viewport.element.releasePointerCapture(stroke.pointer);
  }

  private ball(point: THREE.Vector3, normal: THREE.Vector3, inward: boolean): Command[] {
    const { radius, strength } = this.settings;
    const away = (1 - strength) * radius;
    const centre = point.clone().addScaledVector(normal, inward ? away : -away);
    const [x, y, z] = this.viewer.origin;
    return [
      { do: 'tool', name: brushName, shape: 'sphere', radius, position: [centre.x + x, centre.y + y, centre.z + z],
        mode: 'collision', plasticity: 1 },
      { do: 'step' },
    ];
  }

  /** From where the ball is to where the pointer is, so closely that a fast hand leaves a groove and not single dents. */
  private towards(stroke: Stroke, to: { point: THREE.Vector3; normal: THREE.Vector3 }): Command[] {
    const from = stroke.last;
    stroke.last = to;
    const count = Math.min(mostSteps, Math.max(1, Math.ceil(from.point.distanceTo(to.point) / (0.4 * this.settings.radius))));
    return Array.from({ length: count }, (_, k) => (k + 1) / count).flatMap((x) =>
      this.ball(from.point.clone().lerp(to.point, x), from.normal.clone().lerp(to.normal, x).normalize(), stroke.inward));
  }

  private drag(stroke: Stroke, by: THREE.Vector3): Command {
    return { do: 'drag', at: stroke.at, by: by.toArray(), radius: this.settings.radius, steps: 1 };
  }

  /** Where the pointer is in the plane through the start of the stroke that faces the viewer. */
  private inViewPlane(stroke: Stroke, event: PointerEvent): THREE.Vector3 {
    const ray = stroke.viewport.ray(event, new THREE.Raycaster()).ray;
    const facing = stroke.viewport.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(facing, stroke.start);
    return ray.intersectPlane(plane, new THREE.Vector3()) ?? stroke.start.clone();
  }

  private hover(viewport: Viewport | null, event?: PointerEvent): void {
    const brush = this.mode === 'push' || this.mode === 'pull' || this.mode === 'grab';
    const hit = brush && viewport && event && viewport.gizmo.axis === null ? this.viewer.pick(viewport, event) : null;
    if (hit) this.showRing(hit.point, hit.normal);
    else if (this.ring.visible) {
      this.ring.visible = false;
      this.viewer.redraw();
    }
  }

  private showRing(point: THREE.Vector3, normal: THREE.Vector3): void {
    const { radius, strength } = this.settings;
    // Where a ball that deep cuts the plane.
    const reach = this.mode === 'grab' ? radius : radius * Math.sqrt(Math.max(0.05, 1 - (1 - strength) ** 2));
    this.ring.visible = true;
    this.ring.position.copy(point);
    this.ring.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    this.ring.scale.setScalar(reach);
    this.ring.material.color.set(this.viewer.palette.toolSelected);
    this.viewer.redraw();
  }
}
