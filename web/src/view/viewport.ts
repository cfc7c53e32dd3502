import * as THREE from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';

import { pixelSize } from './camera';

export type ViewName = 'perspective' | 'top' | 'front' | 'right';
/** Where a view along an axis looks from. */
export type Side = 'top' | 'bottom' | 'front' | 'back' | 'right' | 'left';

const sides: Record<Side, { from: THREE.Vector3; up: THREE.Vector3 }> = {
  top: { from: new THREE.Vector3(0, 0, 1), up: new THREE.Vector3(0, 1, 0) },
  bottom: { from: new THREE.Vector3(0, 0, -1), up: new THREE.Vector3(0, -1, 0) },
  front: { from: new THREE.Vector3(0, -1, 0), up: new THREE.Vector3(0, 0, 1) },
  back: { from: new THREE.Vector3(0, 1, 0), up: new THREE.Vector3(0, 0, 1) },
  right: { from: new THREE.Vector3(1, 0, 0), up: new THREE.Vector3(0, 0, 1) },
  left: { from: new THREE.Vector3(-1, 0, 0), up: new THREE.Vector3(0, 0, 1) },
};
const oblique = new THREE.Vector3(0.55, -0.85, 0.62).normalize();

/** One of the windows onto the scene: a part of the page, a camera, the means to move tools in it. */
export class Viewport {
  readonly element: HTMLElement;
  readonly label = document.createElement('button');
  readonly gizmo: TransformControls;
  readonly camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  /** What the camera looks at, scene coordinates. */
  readonly target = new THREE.Vector3();
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
    this.aim(oblique);
  }

  size(): { width: number; height: number } {
    return { width: Math.max(1, this.element.clientWidth), height: Math.max(1, this.element.clientHeight) };
  }

  /** Looks at a sphere from the present direction, filling the window. */
  fit(centre: THREE.Vector3, radius: number): void {
    const { camera } = this;
    const r = Math.max(radius, 1e-9);
    const { width, height } = this.size();
    const aspect = Math.max(0.1, width / height);
    const direction = camera.position.clone().sub(this.target);
    if (!(direction.lengthSq() > 0)) direction.copy(oblique);
    this.reach = 4 * r;
    if (camera instanceof THREE.PerspectiveCamera) {
      const half = THREE.MathUtils.degToRad(camera.fov / 2);
      // A sheet seen from above needs less height than its sphere, but all of the width.
      this.reach = r / Math.sin(Math.min(half * 1.14, Math.atan(Math.tan(half) * aspect)));
    } else {
      this.extent = 1.1 * Math.max(r, r / aspect);
      camera.zoom = 1;
    }
    this.target.copy(centre);
    camera.position.copy(centre).addScaledVector(direction.normalize(), this.reach);
    this.aim(direction);
    this.resize();
  }

  /** Turns to a side or to the oblique view, about the present target. A view along an axis keeps to the six sides. */
  turn(to: Side | 'perspective'): void {
    if (to !== 'perspective') this.side = to;
    const from = to === 'perspective' ? oblique : sides[to].from.clone();
    // A camera that stays upright cannot look straight from above or below.
    if (!this.axial && (to === 'top' || to === 'bottom')) from.y = -0.004;
    this.aim(from.normalize());
    this.moved();
  }

  private aim(direction: THREE.Vector3): void {
    const distance = this.camera.position.distanceTo(this.target) || 1;
    const from = this.axial ? sides[this.side].from : direction;
    this.camera.up.copy(this.axial ? sides[this.side].up : new THREE.Vector3(0, 0, 1));
    this.camera.position.copy(this.target).addScaledVector(from, distance);
    this.camera.lookAt(this.target);
    this.camera.updateMatrixWorld();
    const title = this.axial ? this.side : 'perspective';
    this.label.textContent = title[0]!.toUpperCase() + title.slice(1);
    this.label.title = 'Double click: this view alone, or all four';
    this.label.setAttribute('aria-label', `${this.label.textContent} view: double click or Enter for it alone, or all four`);
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

  /** The ray under a pointer. */
  ray(event: { clientX: number; clientY: number }, to: THREE.Raycaster): THREE.Raycaster {
    to.setFromCamera(this.normalised(event.clientX, event.clientY), this.camera);
    return to;
  }

  /** The point under a place of the page, in the plane through `at` that faces the viewer. */
  unproject(x: number, y: number, at: THREE.Vector3): THREE.Vector3 {
    const { ray } = this.ray({ clientX: x, clientY: y }, new THREE.Raycaster());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new THREE.Vector3()), at);
    return ray.intersectPlane(plane, new THREE.Vector3()) ?? at.clone();
  }

  /** Where points of the scene, 3 numbers each, lie on the page, 2 numbers each; NaN behind the camera. */
  projectAll(points: ArrayLike<number>): Float32Array {
    const box = this.element.getBoundingClientRect();
    const places = new Float32Array((2 * points.length) / 3);
    const p = new THREE.Vector3();
    for (let k = 0; 3 * k < points.length; ++k) {
      p.set(points[3 * k]!, points[3 * k + 1]!, points[3 * k + 2]!).project(this.camera);
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
