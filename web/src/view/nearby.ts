import * as THREE from 'three';

import type { Picture, PictureWindow } from '../engine/session_types';
import { type Standing, still } from './placing';

/** A view that is shown: from scene to clip coordinates, and its height in pixels. */
export interface Eye {
  matrix: THREE.Matrix4;
  /** Pixels of a length at clip depth w = 1; at w they are that many divided by w. */
  scale: number;
}

/** The same view of what stands elsewhere. */
export const eyeOn = ({ matrix, scale }: Eye, at: Standing): Eye =>
  (at === still ? { matrix, scale } : { matrix: new THREE.Matrix4().multiplyMatrices(matrix, at.matrix), scale: scale * at.scale });

const wantedPixels = 0.5; // how far chords may be from the surface
const pictureChord = 1.25e-4; // of the size of all nets, at detail 96: how far they are without a window

export function eyeOf(camera: THREE.PerspectiveCamera | THREE.OrthographicCamera, height: number): Eye {
  camera.updateMatrixWorld();
  const matrix = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  return { matrix, scale: (height / 2) * camera.projectionMatrix.elements[5]! };
}

/** How far chords of pictures are from their surfaces at most, unless that takes too many points. */
export function pictureTolerance(pictures: readonly (Picture | null)[], detail: number): number {
  const box = new THREE.Box3();
  const p = new THREE.Vector3();
  for (const picture of pictures) {
    for (let k = 0; picture && k < picture.net.length; k += 3) box.expandByPoint(p.fromArray(picture.net, k));
  }
  return box.isEmpty() ? 0 : (pictureChord * box.getSize(p).length() * 96) / detail;
}

/**
 * The part of a surface that some view shows so large that chords would be half a pixel from it, with the tolerance that
 * keeps them within; null where the picture is fine enough. A cell of the picture counts as a whole, by its corners.
 */
export function wantedWindow(picture: Picture, eyes: readonly Eye[], tolerance: number): PictureWindow | null {
  const [rows, columns] = [coarseLines(picture, 0), coarseLines(picture, 1)];
  const lower: [number, number] = [1, 1];
  const upper: [number, number] = [0, 0];
  let largest = 0; // pixels of a length
  const places = new Float64Array(3 * rows.length * columns.length); // x, y, w
  for (const { matrix: { elements: e }, scale } of eyes) {
    let at = 0;
    let nearest = Infinity;
    for (const k of rows) {
      for (const l of columns) {
        const p = 3 * (k * picture.counts[1] + l);
        const [x, y, z] = [picture.positions[p]!, picture.positions[p + 1]!, picture.positions[p + 2]!];
        places[at++] = e[0]! * x + e[4]! * y + e[8]! * z + e[12]!;
        places[at++] = e[1]! * x + e[5]! * y + e[9]! * z + e[13]!;
        const w = e[3]! * x + e[7]! * y + e[11]! * z + e[15]!;
        places[at++] = w;
        if (w > 0) nearest = Math.min(nearest, w);
      }
    }
    if (tolerance * scale <= wantedPixels * nearest) continue;
    for (let i = 0; i + 1 < rows.length; ++i) {
      for (let j = 0; j + 1 < columns.length; ++j) {
        const depth = depthOfCell(places, 3 * (i * columns.length + j), 3 * columns.length);
        if (!(tolerance * scale > wantedPixels * depth)) continue;
        largest = Math.max(largest, scale / depth);
        lower[0] = Math.min(lower[0], picture.s[rows[i]!]!);
        upper[0] = Math.max(upper[0], picture.s[rows[i + 1]!]!);
        lower[1] = Math.min(lower[1], picture.t[columns[j]!]!);
        upper[1] = Math.max(upper[1], picture.t[columns[j + 1]!]!);
      }
    }
  }
  return largest > 0 ? { lower, upper, tolerance: wantedPixels / largest } : null;
}

/** Clip depth of the nearest corner in front of the eye of a cell that is in the picture; Infinity if it is not. */
function depthOfCell(places: Float64Array, corner: number, row: number): number {
  let depth = Infinity;
  let outside = 15; // on which of the four sides all corners are
  for (const at of [corner, corner + 3, corner + row, corner + row + 3]) {
    const [x, y, w] = [places[at]!, places[at + 1]!, places[at + 2]!];
    outside &= (x > w ? 1 : 0) | (x < -w ? 2 : 0) | (y > w ? 4 : 0) | (y < -w ? 8 : 0);
    if (w > 0) depth = Math.min(depth, w);
  }
  return outside ? Infinity : depth;
}

/** Whether a picture with this window needs no other for what is wanted. */
export function serves(window: PictureWindow | null, wanted: PictureWindow | null): boolean {
  if (!wanted || !window) return !wanted && !window;
  return window.tolerance <= wanted.tolerance && [0, 1].every((d) => window.lower[d]! <= wanted.lower[d]! && window.upper[d]! >= wanted.upper[d]!);
}

/** A window with some room around it, so that small motions of a view ask for no other. */
export function roomy({ lower, upper, tolerance }: PictureWindow): PictureWindow {
  const room = (d: 0 | 1) => (upper[d] - lower[d]) / 4;
  return {
    lower: [Math.max(0, lower[0] - room(0)), Math.max(0, lower[1] - room(1))],
    upper: [Math.min(1, upper[0] + room(0)), Math.min(1, upper[1] + room(1))],
    tolerance: tolerance / 2,
  };
}

/** The grid lines of a direction that a picture would have without a window. */
export function coarseLines(picture: Picture, direction: 0 | 1): readonly number[] | Uint32Array {
  const lines = direction === 0 ? picture.coarse_u : picture.coarse_v;
  return lines.length > 0 ? lines : Array.from({ length: picture.counts[direction] }, (_, k) => k);
}
