import * as THREE from 'three';

import type { BodyInfo } from '../engine/generated';
import type { BodyPicture } from '../engine/session_types';
import type { Display, Palette } from './display';
import { disc } from './surface_view';

const line = () => {
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ transparent: true }));
  lines.frustumCulled = false;
  return lines;
};

const dots = () => {
  const points = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ sizeAttenuation: false, depthTest: false, alphaMap: disc(), alphaTest: 0.5 }));
  points.frustumCulled = false;
  points.renderOrder = 11;
  return points;
};

const heldColour = 0xe0b13a; // as an edge that is held in position

/** Curves, volumes and the block of a lattice as lines, with the control polygon of the selected one. */
export class BodyView {
  readonly group = new THREE.Group();
  /** The one under the pointer. */
  hovered: number | null = null;
  /** The control points of the selected one are shown. */
  editing = false;
  bodies: BodyPicture[] = [];
  lattice: BodyPicture | null = null;
  private selected: number | null = null;
  private info: BodyInfo | null = null;
  private readonly rest = line();
  private readonly lit = line();
  private readonly chosen = line();
  private readonly net = line();
  private readonly points = dots();
  private readonly held = dots();

  constructor() {
    this.group.add(this.rest, this.lit, this.chosen, this.net, this.points, this.held);
  }

  /** `infos`: of the bodies, in their order. */
  show(bodies: BodyPicture[], lattice: BodyPicture | null, selected: number | null, infos: readonly BodyInfo[]): void {
    Object.assign(this, { bodies, lattice, selected, info: infos[selected ?? -1] ?? null });
  }

  /** Places of the control points that can be dragged. */
  get control(): Float32Array | null {
    return (this.lattice ?? this.bodies[this.selected ?? -1])?.points ?? null;
  }

  restyle(display: Display, palette: Palette): void {
    const { bodies, selected, hovered, lattice } = this;
    const of = (which: (k: number) => boolean) => bodies.filter((_, k) => which(k));
    const held = [...of((k) => k === selected), ...(lattice ? [lattice] : [])];
    const parts = [
      [this.rest, of((k) => k !== selected && k !== hovered).map((b) => b.lines), palette.net, 0.8],
      [this.lit, of((k) => k !== selected && k === hovered).map((b) => b.lines), palette.toolSelected, 0.75],
      [this.chosen, held.map((b) => b.lines), palette.toolSelected, lattice ? 0.55 : 1],
      [this.net, held.map((b) => b.net), palette.net, this.editing ? 0.8 : 0.4],
    ] as const;
    for (const [part, ends, colour, opacity] of parts) {
      part.geometry.dispose();
      part.geometry = new THREE.BufferGeometry();
      part.geometry.setAttribute('position', new THREE.BufferAttribute(joined(ends), 3));
      part.visible = ends.length > 0;
      part.material.color.set(colour);
      part.material.opacity = opacity;
    }
    const { control, info } = this;
    const ends = info && !lattice && control ? heldPoints(info.net, info.sides).flatMap((k) => [...control.subarray(3 * k, 3 * k + 3)]) : [];
    const dotted = [[this.points, this.editing && control ? control : new Float32Array(), palette.net, 3], [this.held, new Float32Array(ends), heldColour, 6]] as const;
    for (const [part, places, colour, larger] of dotted) {
      part.visible = places.length > 0;
      part.geometry.dispose();
      part.geometry = new THREE.BufferGeometry();
      part.geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
      part.material.color.set(colour);
      part.material.size = (display.pointSize + larger) * Math.min(window.devicePixelRatio, 2);
    }
  }

  /** Of each. */
  boxes(): THREE.Box3[] {
    return this.bodies.map(({ lines }) => new THREE.Box3().setFromArray(lines));
  }
}

function joined(parts: readonly Float32Array[]): Float32Array {
  const all = new Float32Array(parts.reduce((sum, p) => sum + p.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** Numbers of the control points on ends or sides, "u0" to "w1"; the last direction of the net is fastest. */
export function heldPoints(net: readonly number[], sides: readonly string[]): number[] {
  const count = net.reduce((product, n) => product * n, 1);
  return Array.from({ length: count }, (_, k) => k).filter((k) => sides.some((side) => {
    const d = 'uvw'.indexOf(side[0]!), stride = net.slice(d + 1).reduce((product, n) => product * n, 1);
    return Math.floor(k / stride) % net[d]! === (side[1] === '0' ? 0 : net[d]! - 1);
  }));
}
