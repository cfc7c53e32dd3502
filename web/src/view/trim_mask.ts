import * as THREE from 'three';

import type { Trim } from '../engine/context';

/** Pixels per direction of the domain: many masks together use no more memory than a few. */
const sizeFor = (masks: number) => (masks <= 8 ? 1024 : masks <= 32 ? 512 : 256);

/**
 * Faces reach half of this over their edges, pixels of the mask. Drawn to the edge exactly they would leave a hole wherever
 * the masks of two neighbours are rounded away from each other, or where a face is narrower than a pixel.
 */
const overlap = 0.6;

/** Of all surfaces; only trimmed ones have one. */
export function trimMasks(trims: Trim[]): (THREE.Texture | null)[] {
  const size = sizeFor(trims.filter(Boolean).length);
  return trims.map((trim) => trimMask(trim, size));
}

/** A picture of the visible part of a surface: opaque within its trims, over s to the right and t downwards. Null: all of it. */
function trimMask(trim: Trim, size: number): THREE.Texture | null {
  if (!trim) return null;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const context = canvas.getContext('2d')!;
  context.fillStyle = '#fff';
  context.strokeStyle = '#fff';
  context.lineWidth = overlap;
  for (const face of trim.faces) {
    context.beginPath();
    for (const loop of face) {
      for (let k = 0; k + 1 < loop.length; k += 2) context.lineTo(loop[k]! * size, loop[k + 1]! * size);
      context.closePath();
    }
    context.fill('evenodd');
    context.stroke();
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.flipY = false;
  texture.generateMipmaps = false;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  return texture;
}
