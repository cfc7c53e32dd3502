import * as THREE from 'three';

/** Motions of a camera that looks at `target`; the point that they act about keeps its place on the screen. */
export interface View {
  readonly camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  readonly target: THREE.Vector3;
}

const steepest = 0.004; // radians from the vertical: beyond, the picture would turn over

/** Turns about the vertical by `turn` and tips by `tip`, radians, both about `pivot`. */
export function orbit({ camera, target }: View, turn: number, tip: number, pivot: THREE.Vector3): void {
  const towards = target.clone().sub(camera.position);
  const angle = towards.angleTo(new THREE.Vector3(0, 0, -1)); // from straight down
  const allowed = THREE.MathUtils.clamp(angle + tip, steepest, Math.PI - steepest) - angle;
  const vertical = new THREE.Vector3(0, 0, 1);
  const right = new THREE.Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
  const rotation = new THREE.Quaternion().setFromAxisAngle(vertical, turn)
    .multiply(new THREE.Quaternion().setFromAxisAngle(right, allowed));
  const about = pivot.clone(); // it may be the target itself
  for (const point of [camera.position, target]) point.sub(about).applyQuaternion(rotation).add(about);
  camera.up.set(0, 0, 1);
  camera.lookAt(target);
  camera.updateMatrixWorld();
}

/** Length of a pixel at the depth of `at`; `height` of the view in pixels. */
export function pixelSize({ camera }: View, at: THREE.Vector3, height: number): number {
  if (camera instanceof THREE.OrthographicCamera) return (camera.top - camera.bottom) / camera.zoom / height;
  const depth = at.clone().sub(camera.position).dot(camera.getWorldDirection(new THREE.Vector3()));
  return (2 * Math.max(depth, 1e-12) * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2))) / height;
}

/** Moves what is seen by pixels; a point at the depth of `at` stays under the pointer. */
export function pan(view: View, dx: number, dy: number, at: THREE.Vector3, height: number): void {
  const { camera, target } = view;
  const size = pixelSize(view, at, height);
  const shift = new THREE.Vector3(-dx * size, dy * size, 0).applyQuaternion(camera.quaternion);
  camera.position.add(shift);
  target.add(shift);
  camera.updateMatrixWorld();
}

/** Shows everything `factor` times as large (perspective: from correspondingly nearer); `at` keeps its place on the screen. */
export function zoom({ camera, target }: View, factor: number, at: THREE.Vector3): void {
  if (camera instanceof THREE.OrthographicCamera) {
    const towards = camera.getWorldDirection(new THREE.Vector3());
    camera.zoom *= factor;
    const shift = at.clone().sub(target).multiplyScalar(1 - 1 / factor);
    shift.addScaledVector(towards, -shift.dot(towards));
    camera.position.add(shift);
    target.add(shift);
    camera.updateProjectionMatrix();
  } else {
    const about = at.clone();
    for (const point of [camera.position, target]) point.sub(about).divideScalar(factor).add(about);
  }
  camera.updateMatrixWorld();
}
