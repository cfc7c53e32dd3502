import * as THREE from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

import type { Trim } from '../engine/context';
import type { Picture } from '../engine/session_types';
import type { GreyPiece } from './context_view';
import { placedPoints, planeOf, type Standing } from './placing';
import { cutOfContext, cutOfPicture, type PlaneNumbers } from './section_lines';

/** What a section is across: an axis of the file, or the direction of the view when it was chosen. */
export type SectionAxis = 'x' | 'y' | 'z' | 'view';
export const sectionAxes: readonly SectionAxis[] = ['x', 'y', 'z', 'view'];

/** What a section cuts. */
export interface Cuttable {
  surfaces: readonly { picture: Picture; trim: Trim; standings: readonly Standing[] }[];
  grey: readonly GreyPiece[];
}

const colour = 0xf0503c;

/** Hides everything on one side of a plane, and draws a line where the plane cuts. Off unless begun. */
export class Section {
  /** Null: there is none. */
  axis: SectionAxis | null = null;
  /** What lies on the side of the eye is kept, not hidden. */
  flipped = false;
  /** Of the plane along `normal`, scene coordinates. */
  offset = 0;
  readonly normal = new THREE.Vector3(1, 0, 0);
  /** The least and the largest useful offset. */
  range: [number, number] = [-1, 1];
  /** The cut lines and the frame of the plane. */
  readonly group = new THREE.Group();
  onChange: () => void = () => {};

  private towardsEye = 1; // of the normal, when the section began
  private readonly plane = new THREE.Plane();
  private readonly cut = thick(3);
  private readonly frame = new THREE.LineLoop(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.55 }));
  private box = new THREE.Box3();
  private outdated = true;

  constructor() {
    this.group.visible = false;
    for (const part of [this.cut, this.frame]) part.frustumCulled = false;
    this.cut.renderOrder = 4;
    this.group.add(this.cut, this.frame);
  }

  get on(): boolean {
    return this.axis !== null;
  }

  /** Through the middle of a box, so that what is between it and the eye is hidden. `eye`: the direction to it. */
  begin(axis: SectionAxis, box: THREE.Box3, eye: THREE.Vector3): void {
    this.axis = axis;
    this.flipped = false;
    if (axis === 'view') this.normal.copy(eye).normalize();
    else this.normal.set(0, 0, 0).setComponent('xyz'.indexOf(axis), 1);
    this.towardsEye = this.normal.dot(eye) < 0 ? -1 : 1;
    this.box.copy(box);
    const along = cornersOf(box).map((p) => p.dot(this.normal));
    this.range = [Math.min(...along), Math.max(...along)];
    this.move((this.range[0] + this.range[1]) / 2);
  }

  end(): void {
    if (!this.on) return;
    this.axis = null;
    this.change();
  }

  flip(): void {
    this.flipped = !this.flipped;
    this.change();
  }

  move(offset: number): void {
    this.offset = THREE.MathUtils.clamp(offset, ...this.range);
    this.change();
  }

  private change(): void {
    const sign = -this.towardsEye * (this.flipped ? -1 : 1); // the kept side is where the plane's values are positive
    this.plane.setComponents(...(this.normal.toArray().map((x) => sign * x) as THREE.Vector3Tuple), -sign * this.offset);
    this.outdated = true;
    this.onChange();
  }

  /** What it cuts has changed. */
  forget(): void {
    this.outdated = true;
  }

  hides(x: number, y: number, z: number): boolean {
    const { normal, constant } = this.plane;
    return this.on && normal.x * x + normal.y * y + normal.z * z + constant < 0;
  }

  /** Begins a ray where it enters what is shown. Answers how far it goes there; negative where it never does. */
  clip(ray: THREE.Ray): number {
    if (!this.on) return Infinity;
    const before = this.plane.distanceToPoint(ray.origin);
    const rate = this.plane.normal.dot(ray.direction);
    const far = -before / rate;
    if (before >= 0) return rate < 0 ? far : Infinity;
    if (!(rate > 0)) return -1;
    ray.origin.addScaledVector(ray.direction, far);
    return Infinity;
  }

  /** Before a picture: what is clipped, and the lines. */
  prepare(objects: readonly THREE.Object3D[], cuttable: () => Cuttable): void {
    const planes = this.on ? [this.plane] : null;
    for (const object of objects) {
      object.traverse((part) => {
        const { material } = part as THREE.Mesh;
        if (material && !Array.isArray(material) && material.clippingPlanes !== planes) material.clippingPlanes = planes;
      });
    }
    this.group.visible = this.on;
    if (!this.on || !this.outdated) return;
    this.outdated = false;
    this.draw(cuttable());
  }

  /** The corners of its frame, in turn. */
  corners(): THREE.Vector3[] {
    const { normal } = this;
    const u = (Math.abs(normal.z) < 0.9 ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0)).cross(normal).normalize();
    const v = normal.clone().cross(u);
    const all = cornersOf(this.box);
    const side = (d: THREE.Vector3, which: 'min' | 'max') => Math[which](...all.map((p) => p.dot(d)));
    return ([['min', 'min'], ['max', 'min'], ['max', 'max'], ['min', 'max']] as const).map(([a, b]) =>
      normal.clone().multiplyScalar(this.offset).addScaledVector(u, side(u, a)).addScaledVector(v, side(v, b)));
  }

  private draw({ surfaces, grey }: Cuttable): void {
    const { normal, constant } = this.plane;
    const numbers: PlaneNumbers = [normal.x, normal.y, normal.z, constant];
    const pieces: number[] = [];
    const cut = (standings: readonly Standing[], by: (plane: PlaneNumbers) => number[]) => {
      for (const at of standings) for (const x of placedPoints(by(planeOf(numbers, at)), at)) pieces.push(x);
    };
    for (const piece of grey) cut(piece.standings, (plane) => cutOfContext(piece, plane));
    for (const { picture, trim, standings } of surfaces) cut(standings, (plane) => cutOfPicture(picture, plane, trim));
    this.cut.geometry.dispose();
    this.cut.geometry = new LineSegmentsGeometry();
    this.cut.visible = pieces.length > 0;
    if (this.cut.visible) this.cut.geometry.setPositions(pieces);
    this.frame.geometry.setFromPoints(this.corners());
  }
}

function thick(linewidth: number): LineSegments2 {
  return new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ color: colour, linewidth }));
}

function cornersOf({ min, max }: THREE.Box3): THREE.Vector3[] {
  return [min, max].flatMap(({ x }) => [min, max].flatMap(({ y }) => [min, max].map(({ z }) => new THREE.Vector3(x, y, z))));
}

/** Lets clipping planes act on a material with shaders of its own, as they do on those of the library. */
export function clippable<M extends THREE.ShaderMaterial>(material: M): M {
  const begin = /void\s+main\s*\(\s*\)\s*\{/;
  material.clipping = true;
  material.vertexShader = material.vertexShader.replace(begin, `
    #include <clipping_planes_pars_vertex>
    void main() {
      {
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        #include <clipping_planes_vertex>
      }`);
  material.fragmentShader = material.fragmentShader.replace(begin, `
    #include <clipping_planes_pars_fragment>
    void main() {
      #include <clipping_planes_fragment>`);
  return material;
}
