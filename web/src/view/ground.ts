import * as THREE from 'three';

import type { Palette } from './display';
import type { Viewport } from './viewport';

const leastPixels = 26; // between two lines

/** 1, 2 or 5 times a power of ten: the largest that is not above x. */
export function roundStep(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  const digit = x / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/** 1, 2 or 5 times a power of ten: the smallest that is not below x. */
export function roundStepAbove(x: number): number {
  const below = roundStep(x);
  return below >= x * (1 - 1e-12) ? below : roundStep(2.6 * below);
}

/**
 * A grid of whole lengths: on the ground below the scene, or behind it in a view along an axis. Its lines lie at multiples
 * of `step` in the file's coordinates, and the step follows the zoom of each view.
 */
export class Ground {
  readonly mesh: THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>;
  /** Length of a cell in the view that was prepared last, file units. */
  step = 1;

  constructor() {
    this.mesh = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
      transparent: true,
      depthWrite: false,
      side: THREE.DoubleSide,
      uniforms: {
        step: { value: 1 }, offset: { value: new THREE.Vector2() }, middle: { value: new THREE.Vector2() },
        u: { value: new THREE.Vector3(1, 0, 0) }, v: { value: new THREE.Vector3(0, 1, 0) },
        fade: { value: 1 }, thin: { value: new THREE.Color() }, strong: { value: new THREE.Color() },
      },
      vertexShader: /* glsl */ `
        uniform vec3 u, v;
        varying vec2 place;
        void main() {
          vec4 world = modelMatrix * vec4(position, 1.0);
          place = vec2(dot(world.xyz, u), dot(world.xyz, v));
          gl_Position = projectionMatrix * viewMatrix * world;
        }`,
      fragmentShader: /* glsl */ `
        uniform float step, fade;
        uniform vec2 offset, middle;
        uniform vec3 thin, strong;
        varying vec2 place;
        // How much of a pixel lines at whole numbers of x cover; none if they are too dense.
        float lines(vec2 x) {
          vec2 width = max(fwidth(x), vec2(1e-6));
          vec2 near = abs(fract(x - 0.5) - 0.5) / width;
          vec2 shown = (1.0 - smoothstep(0.3, 1.1, near)) * (1.0 - smoothstep(0.12, 0.4, width));
          return max(shown.x, shown.y);
        }
        void main() {
          vec2 x = (place + offset) / step;
          float far = fade > 0.0 ? smoothstep(0.25, 1.0, length(place - middle) / fade) : 0.0;
          float a = lines(x), b = lines(x / 5.0);
          float cover = max(0.75 * a, b) * (1.0 - far);
          if (cover < 0.01) discard;
          gl_FragColor = vec4(mix(thin, strong, b), cover);
          #include <colorspace_fragment>
        }`,
    }));
    this.mesh.renderOrder = -10;
    this.mesh.frustumCulled = false;
  }

  restyle(palette: Palette): void {
    this.mesh.material.uniforms.thin!.value.set(palette.grid);
    this.mesh.material.uniforms.strong!.value.set(palette.gridStrong);
  }

  /** Places the grid for this view: `lowest` is the height of the ground, `radius` that of the scene, both scene coordinates. */
  prepare(view: Viewport, lowest: number, radius: number, origin: readonly number[]): void {
    const { uniforms } = this.mesh.material;
    const pixel = view.pixel();
    this.step = roundStepAbove(leastPixels * pixel);
    const normal = view.axial ? view.camera.getWorldDirection(new THREE.Vector3()).negate() : new THREE.Vector3(0, 0, 1);
    // The plane of the lines, and its position.
    const [u, v]: [number, number] = Math.abs(normal.z) > 0.5 ? [0, 1] : Math.abs(normal.y) > 0.5 ? [0, 2] : [1, 2];
    const axis = (k: number) => new THREE.Vector3().setComponent(k, 1);
    uniforms.u!.value.copy(axis(u));
    uniforms.v!.value.copy(axis(v));
    uniforms.step!.value = this.step;
    uniforms.offset!.value.set(origin[u]! % (5 * this.step), origin[v]! % (5 * this.step));
    uniforms.middle!.value.set(view.target.getComponent(u), view.target.getComponent(v));
    const size = view.axial ? 4 * pixel * Math.hypot(view.size().width, view.size().height) : 60 * this.step + 4 * radius;
    uniforms.fade!.value = view.axial ? 0 : Math.min(size, Math.max(36 * this.step, 0.02 * radius));
    this.mesh.position.copy(view.target);
    if (view.axial) this.mesh.position.addScaledVector(normal, -10 * radius);
    else this.mesh.position.z = lowest;
    this.mesh.scale.setScalar(size);
    this.mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    this.mesh.updateMatrixWorld();
  }
}
