import * as THREE from 'three';

import type { Command } from '../engine/session_types';
import type { BodyPicture, LatticeSettings } from '../engine/session_types';
import { pickBody } from '../view/body_picking';
import { nearestPoint } from '../view/near';
import { gridIndices, wholeRows } from '../view/net';
import { disc } from '../view/surface_view';
import type { Viewer } from '../view/viewer';
import type { Viewport } from '../view/viewport';
import type { PointerTool } from './pointers';

export interface PointActions {
  /** Adds a history entry; false if it failed. */
  begin(commands: Command[]): Promise<boolean>;
  follow(commands: () => Command[], join: boolean): void;
  end(commands: Command[]): Promise<void>;
  cancel(): Promise<void>;
  select(surface: number): Promise<void>;
  selectBody(body: number): Promise<void>;
  /** A lattice that was put round the surfaces anew is that which is pulled on from now on. */
  pulled(): void;
  changed(): void;
}

export type Lock = 'x' | 'y' | 'z' | 'normal' | null;

interface Hold {
  viewport: Viewport;
  start: THREE.Vector3;
  normal: THREE.Vector3;
  by: THREE.Vector3;
  pointer: { x: number; y: number };
  /** Set once the first command has been sent; null while the pointer has not moved. */
  begun: Promise<boolean> | null;
  cancelled: boolean;
}

/** Picks control points of the selected surface, curve or volume, or of the lattice, by click, box and row, and drags them. */
export class PointEditor implements PointerTool {
  /** Flat indices i n + j. */
  readonly chosen = new Set<number>();
  lock: Lock = null;
  /** The block of space whose points are dragged instead, and what is in it follows; null: none. */
  lattice: LatticeSettings | null = null;
  /** The block as it was when the drag began. */
  private block: BodyPicture | null = null;

  private of = ''; // the surface and net that they are indices of
  private hold: Hold | null = null;
  private box: { viewport: Viewport; x: number; y: number; add: boolean; element: HTMLElement } | null = null;
  private readonly marks: THREE.Points<THREE.BufferGeometry, THREE.PointsMaterial>;
  private readonly axis: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;

  constructor(private readonly viewer: Viewer, private readonly actions: PointActions) {
    this.marks = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ sizeAttenuation: false, depthTest: false, alphaMap: disc(), alphaTest: 0.5 }));
    this.axis = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ depthTest: false, transparent: true, opacity: 0.8 }));
    for (const part of [this.marks, this.axis]) {
      part.frustumCulled = false;
      part.visible = false;
      part.renderOrder = 12;
      viewer.overlay.add(part);
    }
  }

  get active(): boolean {
    return this.hold !== null || this.box !== null;
  }

  /** The surface whose points are picked: the first selected one. */
  get surface(): number | undefined {
    return this.viewer.bodies.control ? undefined : this.viewer.frame?.state.selection[0];
  }

  /** Of a curve, a volume and a lattice all points in one row. */
  get net(): [number, number] {
    const { surface, viewer } = this;
    if (viewer.bodies.control) return [viewer.bodies.control.length / 3, 1];
    return surface === undefined ? [0, 0] : viewer.frame!.state.surfaces[surface]!.net;
  }

  /** What the points belong to, for the page; null where nothing is selected. */
  get kind(): 'surface' | 'curve' | 'volume' | 'lattice' | null {
    const { bodies, frame } = this.viewer;
    if (bodies.lattice) return 'lattice';
    if (bodies.control) return frame!.state.bodies[frame!.state.body!]!.kind;
    return this.surface === undefined ? null : 'surface';
  }

  /** Whether the block that is shown has been pulled, and is pulled on. */
  get pulled(): boolean {
    return this.viewer.bodies.lattice?.pulled ?? false;
  }

  /** Places of all points that can be picked, scene coordinates. */
  get places(): Float32Array | null {
    return this.viewer.bodies.control ?? this.viewer.surfaces[this.surface ?? -1]?.picture?.net ?? null;
  }

  /** After every frame: the chosen points are shown where they are now, or forgotten if the net has changed. */
  refresh(shown: boolean): void {
    const { surface, viewer } = this, { state } = viewer.frame ?? {};
    this.freezeBlock();
    const id = surface === undefined ? `${this.kind} ${state?.bodies[state.body ?? -1]?.id}` : state!.surfaces[surface]!.id;
    const of = `${id} ${this.net.join()}`;
    if (of !== this.of) this.chosen.clear();
    this.of = of;
    const net = this.places;
    this.marks.visible = shown && this.chosen.size > 0 && net !== null;
    if (!this.marks.visible) return;
    const places = new Float32Array(3 * this.chosen.size);
    [...this.chosen].forEach((k, at) => places.set(net!.subarray(3 * k, 3 * k + 3), 3 * at));
    this.marks.geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
    this.marks.material.color.set(this.viewer.palette.toolSelected);
    this.marks.material.size = (1.4 * this.viewer.display.pointSize + 5) * Math.min(window.devicePixelRatio, 2);
  }

  choose(points: Iterable<number>, add = false): void {
    if (!add) this.chosen.clear();
    for (const k of points) this.chosen.add(k);
    this.actions.changed();
  }

  /** The rows, along v (constant i) or u (constant j), that contain the chosen points. */
  chooseRows(direction: 'u' | 'v'): void {
    const [m, n] = this.net;
    const rows = new Set([...this.chosen].map((k) => (direction === 'v' ? Math.floor(k / n) : k % n)));
    this.choose(gridIndices(m, n).filter((k) => rows.has(direction === 'v' ? Math.floor(k / n) : k % n)));
  }

  /** The points to which a command applies. */
  which(): ReturnType<typeof wholeRows> {
    const [m, n] = this.net;
    if (this.kind !== 'surface') return { which: [...this.chosen].sort((a, b) => a - b) };
    return wholeRows([...this.chosen].sort((a, b) => a - b), m, n);
  }

  press(viewport: Viewport, event: PointerEvent): boolean {
    if (!this.places) return false;
    const touch = event.pointerType === 'touch';
    const point = this.at(viewport, event, touch ? 20 : 10);
    if (point === null) {
      if (touch || event.altKey) return false;
      const element = document.createElement('div');
      element.className = 'select-box';
      viewport.element.append(element);
      this.box = { viewport, x: event.clientX, y: event.clientY, add: event.shiftKey, element };
      return true;
    }
    if (this.kind === 'surface' && (event.ctrlKey || event.metaKey || event.altKey)) {
      if (!event.shiftKey) this.chosen.clear();
      this.chosen.add(point);
      this.chooseRows(event.altKey ? 'v' : 'u');
      return true;
    }
    if (event.shiftKey) {
      if (!this.chosen.delete(point)) this.chosen.add(point);
      this.actions.changed();
      return true;
    }
    if (!this.chosen.has(point)) this.choose([point]);
    const start = new THREE.Vector3().fromArray(this.places, 3 * point);
    const { lattice } = this.viewer.bodies;
    this.block = lattice && { ...lattice, net: lattice.net.slice(), points: lattice.points.slice() };
    this.hold = {
      viewport, start, normal: this.normalAt(start), by: new THREE.Vector3(), pointer: { x: event.clientX, y: event.clientY },
      begun: null, cancelled: false,
    };
    return true;
  }

  private at(viewport: Viewport, event: { clientX: number; clientY: number }, reach: number): number | null {
    return this.places ? nearestPoint(this.viewer.places(viewport, this.places), event, reach) : null;
  }

  /** While a point of the block is dragged the block is that of the beginning, with the point where the pointer is. */
  private freezeBlock(): void {
    const { block, hold, viewer } = this;
    if (!block || !hold) return;
    const shown = { ...block, net: block.net.slice(), points: block.points.slice() };
    for (const k of this.chosen) {
      const before = new THREE.Vector3().fromArray(block.points, 3 * k), after = before.clone().add(hold.by);
      after.toArray(shown.points, 3 * k);
      for (let at = 0; at < shown.net.length; at += 3) {
        if (before.equals(new THREE.Vector3().fromArray(block.net, at))) after.toArray(shown.net, at);
      }
    }
    viewer.bodies.lattice = shown;
    viewer.bodies.restyle(viewer.display, viewer.palette);
    viewer.redraw();
  }

  /** Of the drawn surface where it is nearest to a point; upwards where there is none. */
  normalAt(point: THREE.Vector3): THREE.Vector3 {
    if (this.surface === undefined) return new THREE.Vector3(0, 0, 1);
    const { positions, normals } = this.viewer.surfaces[this.surface!]!.picture!;
    let nearest = Infinity;
    let best = 0;
    for (let k = 0; k < positions.length; k += 3) {
      const d = (positions[k]! - point.x) ** 2 + (positions[k + 1]! - point.y) ** 2 + (positions[k + 2]! - point.z) ** 2;
      if (d < nearest) [nearest, best] = [d, k];
    }
    return new THREE.Vector3().fromArray(normals, best);
  }

  drag(event: PointerEvent): void {
    const { box } = this;
    if (box) {
      const corner = box.viewport.element.getBoundingClientRect();
      const [left, top] = [Math.min(box.x, event.clientX), Math.min(box.y, event.clientY)];
      box.element.style.left = `${left - corner.left}px`;
      box.element.style.top = `${top - corner.top}px`;
      box.element.style.width = `${Math.abs(event.clientX - box.x)}px`;
      box.element.style.height = `${Math.abs(event.clientY - box.y)}px`;
      return;
    }
    const { hold } = this;
    if (!hold) return;
    if (!hold.begun && Math.hypot(event.clientX - hold.pointer.x, event.clientY - hold.pointer.y) < 3) return;
    hold.pointer = { x: event.clientX, y: event.clientY };
    this.send(hold);
  }

  /** A key while dragging: restricts the motion to one axis, or frees it again. */
  setLock(lock: Lock): void {
    this.lock = this.lock === lock ? null : lock;
    if (this.hold) this.send(this.hold);
    this.actions.changed();
  }

  private send(hold: Hold): void {
    hold.by = this.moved(hold);
    this.showAxis(hold);
    const { block, lattice } = this, which = this.which();
    const command = (): Command => {
      const by = hold.by.toArray();
      if (!lattice || !block || !('which' in which)) return { do: 'points', ...which, by };
      const { net, margin } = lattice;
      return { do: 'lattice', net, margin, which: which.which, by, ...(block.pulled ? { again: true } : {}) };
    };
    this.freezeBlock();
    hold.begun ??= this.actions.begin([command()]);
    void hold.begun.then((good) => {
      if (good && !hold.cancelled) this.actions.follow(() => [{ do: 'undo' }, command()], false);
    });
  }

  private direction(hold: Hold): THREE.Vector3 | null {
    if (!this.lock) return null;
    return this.lock === 'normal' ? hold.normal : new THREE.Vector3(Number(this.lock === 'x'), Number(this.lock === 'y'), Number(this.lock === 'z'));
  }

  /** In the plane facing the viewer, or to the point of the axis nearest to the ray. */
  private moved(hold: Hold): THREE.Vector3 {
    const { viewport, start, pointer } = hold;
    const axis = this.direction(hold);
    if (!axis) return viewport.unproject(pointer.x, pointer.y, start).sub(start);
    const { ray } = viewport.ray({ clientX: pointer.x, clientY: pointer.y }, new THREE.Raycaster());
    const w = start.clone().sub(ray.origin);
    const [b, d, e] = [axis.dot(ray.direction), axis.dot(w), ray.direction.dot(w)];
    const denominator = 1 - b * b;
    return axis.clone().multiplyScalar(denominator > 1e-4 ? (b * e - d) / denominator : 0);
  }

  private showAxis(hold: Hold | null): void {
    const axis = hold && this.direction(hold);
    this.axis.visible = axis !== null;
    if (!hold || !axis) return;
    const length = 1000 * hold.viewport.pixel();
    const ends = [hold.start.clone().addScaledVector(axis, -length), hold.start.clone().addScaledVector(axis, length)];
    this.axis.geometry.setFromPoints(ends);
    this.axis.material.color.set(this.viewer.palette.toolSelected);
    this.viewer.redraw();
  }

  release(event: PointerEvent): void {
    const { box, hold } = this;
    this.box = null;
    this.hold = this.block = null;
    this.lock = null;
    this.showAxis(null);
    if (box) {
      box.element.remove();
      this.chooseBox(box, event);
    } else if (hold?.begun) {
      if (this.lattice) this.actions.pulled();
      void hold.begun.then((good) => (good && !hold.cancelled ? this.actions.end([]) : undefined));
    }
  }

  private chooseBox(box: NonNullable<PointEditor['box']>, event: PointerEvent): void {
    if (!this.places) return;
    const places = this.viewer.places(box.viewport, this.places);
    const [x0, x1] = [Math.min(box.x, event.clientX), Math.max(box.x, event.clientX)];
    const [y0, y1] = [Math.min(box.y, event.clientY), Math.max(box.y, event.clientY)];
    if (x1 - x0 < 4 && y1 - y0 < 4) {
      // A click on another surface selects that surface.
      const hit = this.viewer.pick(box.viewport, event), body = pickBody(this.viewer, box.viewport, event);
      if (body && body.body !== this.viewer.frame!.state.body) {
        this.viewer.workAt(body.standing);
        return void this.actions.selectBody(body.body);
      }
      if (hit && !this.viewer.isSelected(hit.surface)) void this.actions.select(hit.surface);
      else if (!box.add) this.choose([]);
      return;
    }
    const inside: number[] = [];
    for (let k = 0; 2 * k < places.length; ++k) {
      const [x, y] = [places[2 * k]!, places[2 * k + 1]!];
      if (x >= x0 && x <= x1 && y >= y0 && y <= y1) inside.push(k);
    }
    this.choose(inside, box.add);
  }

  /** The row along u through the point; with Shift, along v. */
  doubleClick(viewport: Viewport, event: MouseEvent): void {
    const point = this.kind === 'surface' ? this.at(viewport, event, 10) : null;
    if (point === null) return;
    this.chosen.clear();
    this.chosen.add(point);
    this.chooseRows(event.shiftKey ? 'v' : 'u');
  }

  async cancel(): Promise<void> {
    const { hold } = this;
    this.box?.element.remove();
    this.box = null;
    this.hold = this.block = null;
    this.lock = null;
    this.showAxis(null);
    if (!hold?.begun) return;
    hold.cancelled = true;
    if (await hold.begun) await this.actions.cancel();
  }

  hover(viewport: Viewport | null, event?: PointerEvent): void {
    if (!viewport || !event || !this.places) return;
    viewport.element.style.cursor = this.at(viewport, event, 10) === null ? '' : 'move';
  }
}
