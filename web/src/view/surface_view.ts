import * as THREE from 'three';

import type { Picture, SurfaceInfo } from '../engine/session_types';
import { type Display, type Palette, palettes } from './display';
import { coarseLines } from './nearby';
import { mark } from './net';
import { GridPicker } from './picking';
import type { Standing } from './placing';
import { reliefLayer } from './relief';
import { clippable } from './section';
import { depthMaterial, restyleMaterial, surfaceMaterial, trimmedLines } from './surface_material';
import type { TrimTextures } from './trim_shader';

const isocurveSpacing = 6; // grid lines between isocurves that are not knot lines

/** Pictures of one surface: triangles, isocurves, knot lines and net, all over the buffers that the worker sends. */
export class SurfaceView {
  readonly group = new THREE.Group();
  /** Where it is worked on; the copies are in the other places of its part. */
  private readonly own = new THREE.Group();
  private readonly copies: THREE.Group[] = [];
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
  picture: Picture | null = null;
  /** Of the present picture. */
  picker: GridPicker | null = null;
  /** Control points are shown regardless of the display. */
  editing = false;

  private mask: TrimTextures | null = null;
  private readonly depth: THREE.Mesh;
  /** All of them where the surface itself is not drawn; else its sides alone, and the surface draws the others. */
  private allIsocurves = false;
  private readonly isocurves = lines();
  private readonly knotLines = lines();
  private readonly normals = lines();
  private readonly net = lines();
  private readonly points = new THREE.Points(
    new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ size: 7, sizeAttenuation: false, vertexColors: true, alphaMap: disc(), alphaTest: 0.5, depthTest: false }),
  );
  private frozen = '';
  private frozenCells = new Uint8Array(1);
  private painted: { cells: Uint8Array; erase: boolean } | null = null;
  private material: Float32Array | null = null;
  private topology = '';
  private netTopology = '';

  constructor() {
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), clippable(surfaceMaterial()));
    this.depth = new THREE.Mesh(new THREE.BufferGeometry(), clippable(depthMaterial(this.mesh.material)));
    this.depth.layers.set(reliefLayer);
    for (const { material } of [this.isocurves, this.knotLines]) trimmedLines(material, this.mesh.material);
    for (const part of [this.mesh, this.depth, this.isocurves, this.knotLines, this.normals, this.net, this.points]) part.frustumCulled = false;
    this.net.material.depthTest = false; // points and net lie on, and behind, what they control
    this.knotLines.renderOrder = 1;
    this.net.renderOrder = 2;
    this.points.renderOrder = 3;
    this.own.matrixAutoUpdate = false;
    this.own.add(this.mesh, this.depth, this.isocurves, this.knotLines, this.normals, this.net, this.points);
    this.group.add(this.own);
  }

  /** What is drawn in every place. */
  private get everywhere(): THREE.Object3D[] {
    return [this.mesh, this.depth, this.isocurves, this.knotLines];
  }

  /** Stands in these places; in `working` it has its net and normals, too. */
  stand(standings: readonly Standing[], working: Standing): void {
    const others = standings.filter((s) => s !== working);
    for (const gone of this.copies.splice(others.length)) this.group.remove(gone);
    while (this.copies.length < others.length) {
      const copy = new THREE.Group();
      copy.matrixAutoUpdate = false;
      copy.add(...this.everywhere.map((part) => part.clone())); // which share geometry and material
      this.copies.push(copy);
      this.group.add(copy);
    }
    [this.own, ...this.copies].forEach((at, k) => {
      const { matrix } = [working, ...others][k]!;
      if (at.matrix.equals(matrix)) return;
      at.matrix.copy(matrix);
      at.matrixWorldNeedsUpdate = true;
    });
    this.showCopies();
  }

  private showCopies(): void {
    const visible = this.everywhere.map((part) => part.visible);
    for (const copy of this.copies) copy.children.forEach((part, k) => (part.visible = visible[k]!));
  }

  show(picture: Picture, info: SurfaceInfo, display: Display, palette: Palette, selected: boolean): void {
    const netCounts = info.net;
    this.picture = picture;
    this.picker = new GridPicker(picture);
    const [m, n] = picture.counts;
    const geometry = this.mesh.geometry;
    setAttribute(geometry, 'position', picture.positions, 3);
    setAttribute(geometry, 'normal', picture.normals, 3);
    setAttribute(geometry, 'value', picture.values.length > 0 ? picture.values : new Float32Array(m * n), 1);
    geometry.boundingSphere = null;
    geometry.boundingBox = null;

    const topology = `${m} ${n} ${picture.lines_u.join()} ${picture.lines_v.join()} ${picture.coarse_u.join()} ${picture.coarse_v.join()}`;
    if (topology !== this.topology) {
      this.topology = topology;
      geometry.setIndex(new THREE.BufferAttribute(triangles(m, n), 1));
      this.depth.geometry.setIndex(new THREE.BufferAttribute(triangles(m, n, 2), 1));
      geometry.setAttribute('span', new THREE.BufferAttribute(spanCoordinates(picture), 2));
      this.frozen = '';
      this.painted = null;
      this.material = null;
      const knotsU = [...picture.lines_u];
      const knotsV = [...picture.lines_v];
      this.knotLines.geometry.setIndex(new THREE.BufferAttribute(gridLines(m, n, knotsU, knotsV), 1));
      geometry.setAttribute('isocurve', new THREE.BufferAttribute(gridCoordinates(between(m, every(picture, 0)), between(n, every(picture, 1))), 2));
      this.isocurves.geometry.setIndex(null);
    }
    for (const part of [this.depth, this.knotLines, this.isocurves]) {
      part.geometry.setAttribute('position', geometry.getAttribute('position'));
    }
    setAttribute(this.net.geometry, 'position', picture.net, 3);
    setAttribute(this.points.geometry, 'position', picture.net, 3);
    const netTopology = netCounts.join();
    if (netTopology !== this.netTopology) {
      this.netTopology = netTopology;
      const [a, b] = netCounts;
      const all = (count: number) => Array.from({ length: count }, (_, k) => k);
      this.net.geometry.setIndex(new THREE.BufferAttribute(gridLines(a, b, all(a), all(b)), 1));
    }
    this.placeMask();
    this.showFrozen(info);
    this.restyle(display, palette, selected);
  }

  /** Draws the triangles elsewhere, with these normals, until the next picture; the picture stays what it is. */
  drawAt(positions: Float32Array, normals: Float32Array): void {
    const { geometry } = this.mesh;
    setAttribute(geometry, 'position', positions, 3);
    setAttribute(geometry, 'normal', normals, 3);
    geometry.boundingSphere = geometry.boundingBox = null;
  }

  /** The visible part of the surface if it is drawn trimmed; null: all. The view owns it from now on. */
  set trim(mask: TrimTextures | null) {
    this.forgetMask();
    this.mask = mask;
    this.placeMask();
  }

  private placeMask(): void {
    if (!this.mask || !this.picture) return;
    const { s, t } = this.picture;
    const places = new Float32Array(2 * s.length * t.length);
    for (let k = 0, at = 0; k < s.length; ++k) {
      for (let l = 0; l < t.length; ++l, at += 2) {
        places[at] = s[k]!;
        places[at + 1] = t[l]!;
      }
    }
    setAttribute(this.mesh.geometry, 'uv', places, 2);
    for (const part of [this.depth, this.knotLines, this.isocurves]) part.geometry.setAttribute('uv', this.mesh.geometry.getAttribute('uv'));
  }

  /** Hatches what the session prevents from moving: the whole spans that frozen regions touch. */
  private showFrozen(info: SurfaceInfo): void {
    const regions = info.constraints.filter((c) => c.do === 'freeze').map((c) => c.region);
    const frozen = JSON.stringify(regions);
    if (frozen === this.frozen) return;
    this.frozen = frozen;
    const [s, t] = lineFractions(this.picture!);
    this.frozenCells = new Uint8Array((s.length - 1) * (t.length - 1));
    for (const region of regions) mark(this.frozenCells, region, s, t);
    this.showMarks();
  }

  /** Tints spans while they are painted; null ends that. */
  showPainted(cells: Uint8Array | null, erase: boolean): void {
    this.painted = cells && { cells, erase };
    this.showMarks();
  }

  /** Tints spans by how much their material differs, 0 to 1; null ends that. */
  showMaterial(amount: Float32Array | null): void {
    if (!amount && !this.material) return;
    this.material = amount;
    this.showMarks();
  }

  private showMarks(): void {
    const { lines_u, lines_v } = this.picture!;
    const [rows, columns] = [lines_u.length - 1, lines_v.length - 1];
    const data = new Uint8Array(4 * rows * columns);
    for (let k = 0; k < rows * columns; ++k) {
      data[4 * k] = this.frozenCells[k] ? 255 : 0;
      data[4 * k + 2] = 255 * (this.material?.[k] ?? 0);
      data[4 * k + 1] = this.painted?.cells[k] ? (this.painted.erase ? 128 : 255) : 0;
    }
    const { marks } = this.mesh.material.uniforms;
    (marks!.value as THREE.DataTexture | null)?.dispose();
    const texture = new THREE.DataTexture(data, columns, rows);
    texture.needsUpdate = true; // nearest: a span is marked or not
    marks!.value = texture;
  }

  restyle(display: Display, palette: Palette, selected: boolean): void {
    const { uniforms } = this.mesh.material;
    const mask = display.trimmed ? this.mask : null;
    uniforms.trimNodes!.value = mask?.nodes ?? null;
    uniforms.trimSegments!.value = mask?.segments ?? null;
    uniforms.trimmed!.value = mask !== null;
    const pale = display.colour !== null || display.stripes !== 'none';
    restyleMaterial(this.mesh.material, display, palette);
    uniforms.selected!.value = selected ? 1 : 0;
    this.mesh.visible = this.depth.visible = display.surface;
    this.isocurves.visible = display.isocurves;
    this.indexIsocurves(!display.surface);
    this.knotLines.visible = display.knotLines;
    this.net.visible = (display.net || this.editing) && selected;
    this.points.visible = (display.points || this.editing) && selected;
    this.normals.visible = display.normals;
    this.showCopies();
    this.isocurves.material.color.set(palette.isocurve);
    this.isocurves.material.opacity = palette.isocurveOpacity;
    // Lines on a pale surface are dark in either theme.
    const over = pale ? palettes.light : palette;
    this.knotLines.material.color.set(over.knotLine);
    this.knotLines.material.opacity = 0.9;
    this.net.material.color.set(over.net);
    this.net.material.opacity = 0.55;
    this.points.material.size = 1.4 * display.pointSize * Math.min(window.devicePixelRatio, 2);
    if (this.picture) {
      const colours = new Float32Array(this.picture.held.length * 3);
      const free = new THREE.Color(over.point);
      const held = new THREE.Color(over.held);
      this.picture.held.forEach((h, k) => (h ? held : free).toArray(colours, 3 * k));
      setAttribute(this.points.geometry, 'color', colours, 3);
      if (display.normals) this.showNormals(this.picture, over, display.flipped);
    }
  }

  private indexIsocurves(all: boolean): void {
    const { geometry } = this.isocurves;
    if (!this.picture || (geometry.index && all === this.allIsocurves)) return;
    this.allIsocurves = all;
    const { picture } = this;
    const [m, n] = picture.counts;
    geometry.setIndex(new THREE.BufferAttribute(all ? gridLines(m, n, every(picture, 0), every(picture, 1)) : gridLines(m, n, [0, m - 1], [0, n - 1]), 1));
  }

  private showNormals(picture: Picture, palette: Palette, flipped: boolean): void {
    const n = picture.counts[1];
    this.mesh.geometry.computeBoundingSphere();
    const length = (flipped ? -0.04 : 0.04) * (this.mesh.geometry.boundingSphere?.radius ?? 1);
    const ends: number[] = [];
    for (const k of every(picture, 0)) {
      for (const l of every(picture, 1)) {
        const at = 3 * (k * n + l);
        for (const distance of [0, length]) {
          for (let d = 0; d < 3; ++d) ends.push(picture.positions[at + d]! + distance * picture.normals[at + d]!);
        }
      }
    }
    setAttribute(this.normals.geometry, 'position', new Float32Array(ends), 3);
    this.normals.material.color.set(palette.knotLine);
  }

  private forgetMask(): void {
    this.mask?.nodes.dispose();
    this.mask?.segments.dispose();
  }

  dispose(): void {
    this.forgetMask();
    (this.mesh.material.uniforms.marks!.value as THREE.DataTexture | null)?.dispose();
    for (const part of [this.mesh, this.depth, this.isocurves, this.knotLines, this.normals, this.net, this.points]) {
      part.geometry.dispose();
      (part.material as THREE.Material).dispose();
    }
  }
}

/** Fractions of the domain where its knot lines lie, ends included. */
export function lineFractions({ s, t, lines_u, lines_v }: Picture): [number[], number[]] {
  return [[...lines_u].map((k) => s[k]!), [...lines_v].map((k) => t[k]!)];
}

/** The position of each grid point among the spans, as texture coordinates: v, then u. */
function spanCoordinates({ counts, lines_u, lines_v }: Picture): Float32Array {
  const along = (count: number, lines: Uint32Array) => between(count, [...lines]).map((x) => x / (lines.length - 1));
  return gridCoordinates(along(counts[1], lines_v), along(counts[0], lines_u), true);
}

/** For each of `count` grid lines its place among some of them: k at the k-th, linear between. */
function between(count: number, lines: number[]): Float32Array {
  const result = new Float32Array(count);
  for (let a = 0; a + 1 < lines.length; ++a) {
    const [from, to] = [lines[a]!, lines[a + 1]!];
    for (let k = from; k <= to; ++k) result[k] = a + (k - from) / (to - from);
  }
  return result;
}

/** Two numbers for each grid point, from those of its lines; the second direction runs fastest, or with `swapped` the first. */
function gridCoordinates(first: Float32Array, second: Float32Array, swapped = false): Float32Array {
  const result = new Float32Array(2 * first.length * second.length);
  const [outer, inner] = swapped ? [second, first] : [first, second];
  let at = 0;
  for (const a of outer) {
    for (const b of inner) {
      result[at++] = swapped ? b : a;
      result[at++] = swapped ? a : b;
    }
  }
  return result;
}

let discTexture: THREE.CanvasTexture | null = null;

/** Makes points round. */
export function disc(): THREE.CanvasTexture {
  if (discTexture) return discTexture;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 32;
  const context = canvas.getContext('2d')!;
  context.fillStyle = '#000';
  context.fillRect(0, 0, 32, 32);
  context.fillStyle = '#fff';
  context.beginPath();
  context.arc(16, 16, 15, 0, 2 * Math.PI);
  context.fill();
  return (discTexture = new THREE.CanvasTexture(canvas));
}

function lines(): THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial> {
  return new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ transparent: true }));
}

/** Keeps the attribute's memory while its size stays the same. */
function setAttribute(geometry: THREE.BufferGeometry, name: string, data: Float32Array, size: number): void {
  const old = geometry.getAttribute(name) as THREE.BufferAttribute | undefined;
  if (old && old.array.length === data.length) {
    (old.array as Float32Array).set(data);
    old.needsUpdate = true;
  } else {
    geometry.setAttribute(name, new THREE.BufferAttribute(data.slice(), size));
  }
}

/** About every sixth grid line of a direction, first and last included; lines of a window do not count. */
function every(picture: Picture, direction: 0 | 1): number[] {
  const lines = coarseLines(picture, direction);
  const pieces = Math.max(1, Math.round((lines.length - 1) / isocurveSpacing));
  return Array.from({ length: pieces + 1 }, (_, k) => lines[Math.round((k * (lines.length - 1)) / pieces)]!);
}

/** Two for each cell between every `step`-th lines of a grid of m × n points. */
function triangles(m: number, n: number, step = 1): Uint32Array {
  const index: number[] = [];
  for (let k = 0; k + 1 < m; k += step) {
    for (let l = 0; l + 1 < n; l += step) {
      const [a, b] = [k * n, Math.min(k + step, m - 1) * n];
      const r = Math.min(l + step, n - 1);
      index.push(a + l, b + l, b + r, a + l, b + r, a + r);
    }
  }
  return new Uint32Array(index);
}

function gridLines(m: number, n: number, rows: number[], columns: number[]): Uint32Array {
  const index: number[] = [];
  for (const k of rows) for (let l = 0; l + 1 < n; ++l) index.push(k * n + l, k * n + l + 1);
  for (const l of columns) for (let k = 0; k + 1 < m; ++k) index.push(k * n + l, (k + 1) * n + l);
  return new Uint32Array(index);
}
