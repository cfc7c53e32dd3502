import * as THREE from 'three';

import type { ToolInfo, ToolPicture } from '../engine/session_types';
import type { Palette } from './display';

/** A translucent picture of a tool: its shape as the engine draws it, where the session says it is. */
export class ToolView {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  private unbounded = false;
  private extent = 1; // side of the square that represents a plane

  constructor(public tool: ToolInfo) {
    this.object = new THREE.Mesh(
      new THREE.BufferGeometry(),
      new THREE.MeshStandardMaterial({ transparent: true, opacity: 0.42, roughness: 0.45, metalness: 0.05, depthWrite: false }),
    );
    this.object.renderOrder = 5;
  }

  /** Another shape. */
  set picture(picture: ToolPicture) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(picture.positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(picture.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(picture.indices, 1));
    this.object.geometry.dispose();
    this.object.geometry = geometry;
    this.object.material.side = picture.open ? THREE.DoubleSide : THREE.FrontSide;
    this.unbounded = picture.unbounded;
    this.extent = 1;
  }

  show(tool: ToolInfo, origin: readonly number[], sceneSize: number, palette: Palette, selected: boolean): void {
    this.tool = tool;
    const side = 1.4 * sceneSize;
    if (this.unbounded && side !== this.extent) {
      this.object.geometry.scale(side / this.extent, side / this.extent, 1);
      this.extent = side;
    }
    this.object.position.set(
      tool.position[0] - origin[0]!, tool.position[1] - origin[1]!, tool.position[2] - origin[2]!);
    this.object.quaternion.set(...tool.rotation);
    this.object.scale.set(...tool.scale);
    this.object.material.color.set(selected ? palette.toolSelected : palette.tool);
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
