import * as THREE from 'three';

import type { BodyInfo } from '@knead/generated';
import type { BodyPicture } from '../engine/session_types';
import type { Display, Palette } from './display';
import { boxOf, type DrawnBody, drawnBodies } from './near';
import { placedPoints, Placing, type Standing, still } from './placing';
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
  /** Of the selected one, or of what the lattice is round. */
  workplace: Standing = still;
  private selected: number | null = null;
  private infos: readonly BodyInfo[] = [];
  private placing = new Placing();
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
  show(bodies: BodyPicture[], lattice: BodyPicture | null, selected: number | null, infos: readonly BodyInfo[], placing: Placing): void {
    Object.assign(this, { bodies, lattice, selected, infos, placing });
  }

  /** All of them, in all their places. */
  get drawn(): DrawnBody[] {
    return drawnBodies(this.bodies, this.infos, this.placing);
  }

  /** The control points that can be dragged, in the coordinates of their part. */
  get control(): Float32Array | null {
    return (this.lattice ?? this.bodies[this.selected ?? -1])?.points ?? null;
  }

  restyle(display: Display, palette: Palette): void {
    const { drawn, bodies, selected, hovered, lattice, workplace } = this;
    const of = (which: (k: number) => boolean) => drawn.filter(({ body }) => which(body)).map(({ picture, standing }) => placedPoints(picture.lines, standing));
    const held = [...bodies.filter((_, k) => k === selected), ...(lattice ? [lattice] : [])];
    const here = (points: Float32Array) => placedPoints(points, workplace);
    const parts = [
      [this.rest, of((k) => k !== selected && k !== hovered), palette.net, 0.8],
      [this.lit, of((k) => k !== selected && k === hovered), palette.toolSelected, 0.75],
      [this.chosen, [...of((k) => k === selected), ...(lattice ? [here(lattice.lines)] : [])], palette.toolSelected, lattice ? 0.55 : 1],
      [this.net, held.map((b) => here(b.net)), palette.net, this.editing ? 0.8 : 0.4],
    ] as const;
    for (const [part, ends, colour, opacity] of parts) {
      part.geometry.dispose();
      part.geometry = new THREE.BufferGeometry();
      part.geometry.setAttribute('position', new THREE.BufferAttribute(joined(ends), 3));
      part.visible = ends.length > 0;
      part.material.color.set(colour);
      part.material.opacity = opacity;
    }
    const { control, infos } = this, info = infos[selected ?? -1];
    const ends = info && !lattice && control ? heldPoints(info.net, info.sides).flatMap((k) => [...control.subarray(3 * k, 3 * k + 3)]) : [];
    const dotted = [[this.points, this.editing && control ? here(control) : new Float32Array(), palette.net, 3], [this.held, here(new Float32Array(ends)), heldColour, 6]] as const;
    for (const [part, places, colour, larger] of dotted) {
      part.visible = places.length > 0;
      part.geometry.dispose();
      part.geometry = new THREE.BufferGeometry();
      part.geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
      part.material.color.set(colour);
      part.material.size = (display.pointSize + larger) * Math.min(window.devicePixelRatio, 2);
    }
  }

  /** Of each in each of its places. */
  boxes(): THREE.Box3[] {
    return this.drawn.map(boxOf);
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
