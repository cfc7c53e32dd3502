import * as THREE from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';

import type { Bounds } from './bounds';
import { pixelSize } from './camera';
import { directionOf, isSide, type NamedView, type Side, sideFrom, sides } from './directions';
import { type Standing, still } from './placing';

export type ViewName = 'perspective' | 'top' | 'front' | 'right';
/** Where a camera stands, scene coordinates; `height` is what it sees of the plane through the target. */
export interface Placement {
  position: THREE.Vector3Tuple;
  target: THREE.Vector3Tuple;
  /** What is upwards on the screen. */
  up: THREE.Vector3Tuple;
  height: number;
  parallel: boolean;
}

/** Of nothing but the scene itself. */
const inScene = new THREE.Matrix4();
const upright = new THREE.Vector3(0, 0, 1);
const margin = 1.04; // round a box that fills a view

/** One of the windows onto the scene: a part of the page, a camera, the means to move tools in it. */
export class Viewport {
  readonly element: HTMLElement;
  readonly label = document.createElement('button');
  readonly gizmo: TransformControls;
  camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  /** What the camera looks at, scene coordinates. */
  readonly target = new THREE.Vector3();
  /** The place of the part that tools work on: `ray` and `unproject` are in its coordinates. */
  workplace: Standing = still;
  /** Looks along an axis of the file, and never turns away from it. */
  readonly axial: boolean;

  private side: Side;
  private extent = 1; // half the height that an orthographic camera sees
  private reach = 1; // from the target to the camera when it was fitted
  private readonly bar = document.createElement('span');

  constructor(readonly name: ViewName, scene: THREE.Scene, private readonly changed: () => void) {
    this.axial = name !== 'perspective';
    this.side = name === 'perspective' ? 'front' : name;
    this.element = document.createElement('div');
    this.element.className = `viewport view-${name}`;
    this.element.tabIndex = -1;
    this.label.type = 'button';
    this.label.className = 'viewport-label';
    this.bar.className = 'viewport-scale';
    this.element.append(this.label, this.bar);
    this.camera = name === 'perspective' ? new THREE.PerspectiveCamera(35, 1, 0.01, 1000) : new THREE.OrthographicCamera();
    this.gizmo = new TransformControls(this.camera, this.element);
    this.gizmo.setSize(0.75);
    this.gizmo.addEventListener('change', changed);
    this.gizmo.getHelper().visible = false;
    scene.add(this.gizmo.getHelper());
    this.aim(directionOf('perspective'));
  }

  size(): { width: number; height: number } {
    return { width: Math.max(1, this.element.clientWidth), height: Math.max(1, this.element.clientHeight) };
  }

  /** Looks at a sphere from the present direction, filling the window; from farther away where corners of its box would be outside. */
  fit({ centre, radius, box }: Bounds): void {
    const { camera } = this;
    const r = Math.max(radius, 1e-9);
    const { width, height } = this.size();
    const aspect = Math.max(0.1, width / height);
    const direction = camera.position.clone().sub(this.target);
    if (!(direction.lengthSq() > 0)) direction.copy(directionOf('perspective'));
    this.reach = 4 * r;
    if (camera instanceof THREE.PerspectiveCamera) {
      const half = THREE.MathUtils.degToRad(camera.fov / 2);
      // A sheet seen from above needs less height than its sphere, but all of the width.
      this.reach = r / Math.sin(Math.min(half * 1.14, Math.atan(Math.tan(half) * aspect)));
    } else {
      this.extent = 1.1 * Math.max(r, r / aspect);
      camera.zoom = 1;
    }
    if (box && camera instanceof THREE.PerspectiveCamera) this.reach = Math.max(this.reach, this.needed(box, centre, direction.normalize(), aspect));
    this.target.copy(centre);
    camera.position.copy(centre).addScaledVector(direction.normalize(), this.reach);
    this.aim(direction);
    this.resize();
  }

  /** From how far a perspective view from a direction has all corners of a box within it. */
  private needed(box: THREE.Box3, centre: THREE.Vector3, direction: THREE.Vector3, aspect: number): number {
    const turned = new THREE.Matrix4().lookAt(direction, new THREE.Vector3(), this.camera.up).invert();
    const half = Math.tan(THREE.MathUtils.degToRad((this.camera as THREE.PerspectiveCamera).fov / 2));
    let most = 0;
    for (const x of [box.min.x, box.max.x]) for (const y of [box.min.y, box.max.y]) for (const z of [box.min.z, box.max.z]) {
      const at = new THREE.Vector3(x, y, z).sub(centre).applyMatrix4(turned);
      most = Math.max(most, at.z + (margin * Math.max(Math.abs(at.y), Math.abs(at.x) / aspect)) / half);
    }
    return most;
  }

  /** Turns to a view with a name, or so that it looks from a direction, about the present target. A view along an axis keeps to the six sides. */
  turn(to: NamedView | THREE.Vector3): void {
    const side = typeof to === 'string' ? (isSide(to) ? to : null) : sideFrom(to);
    if (side) this.side = side;
    this.aim(typeof to === 'string' ? directionOf(to) : to.clone().normalize(), side ? sides[side].up : upright);
    this.moved();
  }

  /** `up`: what is upwards where the direction is vertical; as it is if it is not given. */
  private aim(direction: THREE.Vector3, up = new THREE.Vector3(0, 1, 0).applyQuaternion(this.camera.quaternion)): void {
    const distance = this.camera.position.distanceTo(this.target) || 1;
    const from = this.axial ? sides[this.side].from : direction;
    this.camera.up.copy(this.axial ? sides[this.side].up : Math.abs(from.z) > 1 - 1e-9 ? up : upright);
    this.camera.position.copy(this.target).addScaledVector(from, distance);
    this.camera.lookAt(this.target);
    this.camera.updateMatrixWorld();
    this.showTitle();
  }

  private showTitle(): void {
    const title = this.axial ? this.side : this.parallel ? 'parallel' : 'perspective';
    this.label.textContent = title[0]!.toUpperCase() + title.slice(1);
    this.label.title = 'Double click: this view alone, or all four';
    this.label.setAttribute('aria-label', `${this.label.textContent} view: double click or Enter for it alone, or all four`);
  }

  get parallel(): boolean {
    return this.camera instanceof THREE.OrthographicCamera;
  }

  /** Parallel projection or perspective; what lies at the depth of the target keeps its size. A view along an axis is always parallel. */
  set parallel(on: boolean) {
    if (!this.axial && on !== this.parallel) this.restore({ ...this.placement(), parallel: on });
  }

  placement(): Placement {
    const { camera, target, parallel } = this;
    const height = this.pixel() * this.size().height;
    const up = new THREE.Vector3(0, 1, 0).applyQuaternion(camera.quaternion);
    return { position: camera.position.toArray(), target: target.toArray(), up: up.toArray(), height, parallel };
  }

  /** Stands where `placement` was taken. Not for a view along an axis. */
  restore({ position, target, up, height, parallel }: Placement): void {
    if (parallel !== this.parallel) this.camera = this.gizmo.camera = parallel ? new THREE.OrthographicCamera() : new THREE.PerspectiveCamera(35, 1);
    const { camera } = this;
    const from = new THREE.Vector3(...position).sub(new THREE.Vector3(...target)).normalize();
    this.target.set(...target);
    let distance = this.reach; // a parallel camera stands before everything
    if (camera instanceof THREE.PerspectiveCamera) distance = height / 2 / Math.tan(THREE.MathUtils.degToRad(camera.fov / 2));
    else [this.extent, camera.zoom] = [height / 2, 1];
    camera.position.copy(this.target).addScaledVector(from, distance);
    this.aim(from, new THREE.Vector3(...up));
    this.moved();
  }

  /** The camera was moved by hand. */
  moved(): void {
    this.resize();
    this.changed();
  }

  resize(): void {
    const { width, height } = this.size();
    const aspect = Math.max(0.1, width / height);
    const distance = this.camera.position.distanceTo(this.target);
    if (this.camera instanceof THREE.PerspectiveCamera) {
      this.camera.aspect = aspect;
      this.camera.near = distance / 300;
      this.camera.far = Math.max(60 * distance, 20 * this.reach);
    } else {
      this.camera.top = this.extent;
      this.camera.bottom = -this.extent;
      this.camera.right = this.extent * aspect;
      this.camera.left = -this.extent * aspect;
      this.camera.near = -20 * this.reach;
      this.camera.far = 20 * this.reach;
    }
    this.camera.updateProjectionMatrix();
  }

  /** Length of a pixel at the target. */
  pixel(): number {
    return pixelSize(this, this.target, this.size().height);
  }

  /** The bar in the corner: a length of the grid, and how many pixels it takes. */
  showScale(text: string, pixels: number): void {
    const width = `${Math.round(pixels)}px`;
    if (this.bar.textContent !== text) this.bar.textContent = text;
    if (this.bar.style.width !== width) this.bar.style.width = width;
  }

  private normalised(x: number, y: number): THREE.Vector2 {
    const box = this.element.getBoundingClientRect();
    return new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
  }

  /** The ray under a pointer, in the scene. */
  sceneRay(event: { clientX: number; clientY: number }, to: THREE.Raycaster): THREE.Raycaster {
    to.setFromCamera(this.normalised(event.clientX, event.clientY), this.camera);
    return to;
  }

  /** The point of the scene under a place of the page, in the plane through `at` that faces the viewer. */
  unprojectInScene(x: number, y: number, at: THREE.Vector3): THREE.Vector3 {
    const { ray } = this.sceneRay({ clientX: x, clientY: y }, new THREE.Raycaster());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new THREE.Vector3()), at);
    return ray.intersectPlane(plane, new THREE.Vector3()) ?? at.clone();
  }

  /** As `sceneRay`, in the coordinates of the part that is worked on. */
  ray(event: { clientX: number; clientY: number }, to: THREE.Raycaster): THREE.Raycaster {
    this.sceneRay(event, to).ray.applyMatrix4(this.workplace.inverse);
    return to;
  }

  /** As `unprojectInScene`, in the coordinates of the part that is worked on. */
  unproject(x: number, y: number, at: THREE.Vector3): THREE.Vector3 {
    return this.unprojectInScene(x, y, at.clone().applyMatrix4(this.workplace.matrix)).applyMatrix4(this.workplace.inverse);
  }

  /** Where points, 3 numbers each, lie on the page, 2 numbers each; NaN behind the camera. `matrix` takes them to the scene. */
  projectAll(points: ArrayLike<number>, matrix = inScene): Float32Array {
    const box = this.element.getBoundingClientRect();
    const places = new Float32Array((2 * points.length) / 3);
    const p = new THREE.Vector3();
    for (let k = 0; 3 * k < points.length; ++k) {
      p.set(points[3 * k]!, points[3 * k + 1]!, points[3 * k + 2]!).applyMatrix4(matrix).project(this.camera);
      const seen = p.z > -1 && p.z < 1;
      places[2 * k] = seen ? box.left + ((p.x + 1) / 2) * box.width : NaN;
      places[2 * k + 1] = box.top + ((1 - p.y) / 2) * box.height;
    }
    return places;
  }

  dispose(): void {
    this.gizmo.dispose();
  }
}
