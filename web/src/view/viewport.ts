import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';

export type ViewName = 'perspective' | 'top' | 'front' | 'right';

const directions: Record<ViewName, THREE.Vector3> = {
  perspective: new THREE.Vector3(0.55, -0.85, 0.62).normalize(),
  top: new THREE.Vector3(0, 0, 1),
  front: new THREE.Vector3(0, -1, 0),
  right: new THREE.Vector3(1, 0, 0),
};

/** One of the windows onto the scene: a part of the page, a camera, the means to move it and to move tools in it. */
export class Viewport {
  readonly element: HTMLElement;
  readonly controls: OrbitControls;
  readonly gizmo: TransformControls;
  readonly camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  private extent = 1; // half the height of what an orthographic camera sees

  constructor(readonly name: ViewName, scene: THREE.Scene, changed: () => void) {
    this.element = document.createElement('div');
    this.element.className = `viewport view-${name}`;
    this.element.tabIndex = -1;
    const label = document.createElement('span');
    label.className = 'viewport-label';
    label.textContent = name[0]!.toUpperCase() + name.slice(1);
    this.element.append(label);
    this.camera =
      name === 'perspective' ? new THREE.PerspectiveCamera(35, 1, 0.01, 1000) : new THREE.OrthographicCamera();
    this.camera.up.set(0, 0, 1);
    if (name === 'top') this.camera.up.set(0, 1, 0);
    this.controls = new OrbitControls(this.camera, this.element);
    this.controls.zoomToCursor = true;
    this.controls.enableDamping = false;
    this.controls.enableRotate = name === 'perspective';
    this.controls.mouseButtons = {
      LEFT: name === 'perspective' ? THREE.MOUSE.ROTATE : THREE.MOUSE.PAN,
      MIDDLE: THREE.MOUSE.PAN,
      RIGHT: THREE.MOUSE.PAN,
    };
    this.controls.addEventListener('change', changed);
    this.gizmo = new TransformControls(this.camera, this.element);
    this.gizmo.setSize(0.75);
    this.gizmo.addEventListener('change', changed);
    this.gizmo.getHelper().visible = false;
    scene.add(this.gizmo.getHelper());
  }

  /** Looks at a sphere as from `direction`, filling the window. */
  fit(centre: THREE.Vector3, radius: number, direction: THREE.Vector3 = this.direction()): void {
    const { camera } = this;
    const r = Math.max(radius, 1e-9);
    const aspect = Math.max(0.1, this.element.clientWidth / Math.max(1, this.element.clientHeight));
    let distance = 4 * r;
    if (camera instanceof THREE.PerspectiveCamera) {
      const half = THREE.MathUtils.degToRad(camera.fov / 2);
      // A sheet seen from above needs less height than its sphere, but all of the width.
      distance = r / Math.sin(Math.min(half * 1.14, Math.atan(Math.tan(half) * aspect)));
    } else {
      this.extent = 1.1 * Math.max(r, r / aspect);
      camera.zoom = 1;
    }
    this.controls.target.copy(centre);
    camera.position.copy(centre).addScaledVector(direction, distance);
    camera.near = this.name === 'perspective' ? distance / 500 : -40 * r;
    camera.far = this.name === 'perspective' ? distance * 50 : 80 * r;
    this.resize();
    this.controls.update();
  }

  /** Turns the camera to one of the standard directions about the present centre. */
  turn(to: ViewName | 'back' | 'left' | 'bottom'): void {
    const direction =
      to === 'back' ? new THREE.Vector3(0, 1, 0)
      : to === 'left' ? new THREE.Vector3(-1, 0, 0)
      : to === 'bottom' ? new THREE.Vector3(0, -1e-4, -1)
      : to === 'top' ? new THREE.Vector3(0, -1e-4, 1)
      : directions[to];
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(direction.clone().normalize(), distance);
    this.controls.update();
  }

  /** From the centre towards the camera. */
  direction(): THREE.Vector3 {
    const d = this.camera.position.clone().sub(this.controls.target);
    return d.lengthSq() > 0 && this.name === 'perspective' ? d.normalize() : directions[this.name].clone();
  }

  resize(): void {
    const aspect = Math.max(0.1, this.element.clientWidth / Math.max(1, this.element.clientHeight));
    if (this.camera instanceof THREE.PerspectiveCamera) {
      this.camera.aspect = aspect;
    } else {
      this.camera.top = this.extent;
      this.camera.bottom = -this.extent;
      this.camera.right = this.extent * aspect;
      this.camera.left = -this.extent * aspect;
    }
    this.camera.updateProjectionMatrix();
  }

  /** The ray under a pointer. */
  ray(event: { clientX: number; clientY: number }, to: THREE.Raycaster): THREE.Raycaster {
    const box = this.element.getBoundingClientRect();
    const x = (2 * (event.clientX - box.left)) / box.width - 1;
    const y = 1 - (2 * (event.clientY - box.top)) / box.height;
    to.setFromCamera(new THREE.Vector2(x, y), this.camera);
    return to;
  }

  dispose(): void {
    this.gizmo.dispose();
    this.controls.dispose();
  }
}
