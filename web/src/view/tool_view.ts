import * as THREE from 'three';

import type { ToolInfo } from '../engine/session_types';
import type { Palette } from './display';

/** A translucent picture of a tool, where the session says it is. */
export class ToolView {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  private form = '';

  constructor(public tool: ToolInfo) {
    this.object = new THREE.Mesh(
      new THREE.BufferGeometry(),
      new THREE.MeshStandardMaterial({ transparent: true, opacity: 0.42, roughness: 0.45, metalness: 0.05, depthWrite: false }),
    );
    this.object.renderOrder = 5;
  }

  show(tool: ToolInfo, origin: readonly number[], sceneSize: number, palette: Palette, selected: boolean): void {
    this.tool = tool;
    const form = JSON.stringify([tool.shape, tool.radius, tool.minor, tool.height, tool.top_radius, tool.thickness,
      tool.sizes, tool.exponents, tool.shape === 'plane' ? sceneSize : 0]);
    if (form !== this.form) {
      this.form = form;
      this.object.geometry.dispose();
      this.object.geometry = toolGeometry(tool, sceneSize);
    }
    this.object.position.set(
      tool.position[0] - origin[0]!, tool.position[1] - origin[1]!, tool.position[2] - origin[2]!);
    this.object.quaternion.set(...tool.rotation);
    this.object.scale.set(...tool.scale);
    this.object.material.color.set(selected ? palette.toolSelected : palette.tool);
    this.object.material.side = tool.shape === 'plane' || tool.shape === 'bowl' ? THREE.DoubleSide : THREE.FrontSide;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}

/** The tube of a torus across and along its axis. */
function tubeOf({ minor = 0.25 }: ToolInfo): [number, number] {
  return Array.isArray(minor) ? minor : [minor, minor];
}

function toolGeometry(tool: ToolInfo, sceneSize: number): THREE.BufferGeometry {
  const upright = (geometry: THREE.BufferGeometry) => geometry.rotateX(Math.PI / 2); // three's y is the tool's z
  const radius = tool.radius ?? 1;
  const height = tool.height ?? 2 * radius;
  switch (tool.shape) {
    case 'sphere':
      return new THREE.SphereGeometry(radius, 40, 24);
    case 'ellipsoid':
      return upright(new THREE.SphereGeometry(1, 40, 24)).scale(...tool.sizes!);
    case 'box':
      return new THREE.BoxGeometry(2 * tool.sizes![0], 2 * tool.sizes![1], 2 * tool.sizes![2]);
    case 'cylinder':
      return upright(new THREE.CylinderGeometry(radius, radius, height, 48));
    case 'cone':
      return upright(new THREE.CylinderGeometry(tool.top_radius ?? 0, radius, height, 48)).translate(0, 0, height / 2);
    case 'capsule':
      return upright(new THREE.CapsuleGeometry(radius, height, 12, 40));
    case 'torus':
      return new THREE.TorusGeometry(radius, tubeOf(tool)[0], 20, 64);
    case 'plane':
      return new THREE.PlaneGeometry(1.4 * sceneSize, 1.4 * sceneSize);
    case 'bowl': {
      const inner = radius - (tool.thickness ?? 0.1 * radius);
      const arc = (r: number, k: number) => new THREE.Vector2(r * Math.sin((k * Math.PI) / 48), -r * Math.cos((k * Math.PI) / 48));
      const profile = Array.from({ length: 25 }, (_, k) => arc(radius, k));
      for (let k = 24; k >= 0; --k) profile.push(arc(inner, k));
      return upright(new THREE.LatheGeometry(profile, 48));
    }
    case 'superellipsoid':
    case 'supertoroid':
      return superquadric(tool);
    default:
      return new THREE.SphereGeometry(tool.size ?? radius, 16, 12);
  }
}

/** Thesis § 2.1.6: every trigonometric factor raised to an exponent, its sign kept. */
function superquadric(tool: ToolInfo): THREE.BufferGeometry {
  const [e1, e2] = tool.exponents ?? [1, 1];
  const power = (x: number, e: number) => Math.sign(x) * Math.abs(x) ** e;
  const torus = tool.shape === 'supertoroid';
  const rows = 40;
  const columns = 64;
  const positions: number[] = [];
  const index: number[] = [];
  for (let k = 0; k <= rows; ++k) {
    const eta = torus ? (2 * Math.PI * k) / rows : -Math.PI / 2 + (Math.PI * k) / rows;
    for (let l = 0; l <= columns; ++l) {
      const omega = (2 * Math.PI * l) / columns;
      const across = power(Math.cos(eta), e1);
      const along = power(Math.sin(eta), e1);
      if (torus) {
        const [radial, axial] = tubeOf(tool);
        const r = (tool.radius ?? 1) + radial * across;
        positions.push(r * power(Math.cos(omega), e2), r * power(Math.sin(omega), e2), axial * along);
      } else {
        const [a, b, c] = tool.sizes ?? [1, 1, 1];
        positions.push(a * across * power(Math.cos(omega), e2), b * across * power(Math.sin(omega), e2), c * along);
      }
      if (k < rows && l < columns) {
        const at = k * (columns + 1) + l;
        index.push(at, at + 1, at + columns + 2, at, at + columns + 2, at + columns + 1);
      }
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}
