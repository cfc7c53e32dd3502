import * as THREE from 'three';

/** What a surface without colours is made of, to the eye. */
export type Look = 'studio' | 'clay' | 'wax' | 'chrome';

export const lookNames: readonly (readonly [Look, string])[] = [['studio', 'Studio'], ['clay', 'Clay'], ['wax', 'Red wax'], ['chrome', 'Chrome']];

const pixels = 256;
type Rgb = [number, number, number];

const dot = (a: Rgb, b: Rgb): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (a: Rgb): Rgb => {
  const length = Math.hypot(...a);
  return [a[0] / length, a[1] / length, a[2] / length];
};
const mix = (a: Rgb, b: Rgb, x: number): Rgb => [a[0] + x * (b[0] - a[0]), a[1] + x * (b[1] - a[1]), a[2] + x * (b[2] - a[2])];
const clamp = (x: number): number => Math.min(1, Math.max(0, x));
const smooth = (from: number, to: number, x: number): number => {
  const t = clamp((x - from) / (to - from));
  return t * t * (3 - 2 * t);
};

// The viewer's frame: x to the right, y up, z towards the viewer. The key comes from the left at a grazing angle, so that a
// slope of a few degrees on what lies flat before the viewer changes its brightness most.
const key = unit([-0.84, 0.16, 0.38]);
const fill = unit([0.8, -0.1, 0.45]);
const half = unit([key[0], key[1], key[2] + 1]);

/** Key (wrapped round the edge of shadow and squared, so that no side is flat black), fill and sky. */
function diffuse(n: Rgb): number {
  const wrapped = Math.max(0, (dot(n, key) + 0.36) / 1.36);
  return 0.05 + 0.08 * (0.5 + 0.5 * n[1]) + 1.5 * wrapped * wrapped + 0.2 * Math.max(0, dot(n, fill)) ** 2;
}

const shine = (n: Rgb, power: number): number => Math.max(0, dot(n, half)) ** power;
const rim = (n: Rgb): number => (1 - n[2]) ** 3;

/** The surroundings that chrome reflects, by the direction of the ray: sky, a dark horizon, a floor, two lamps. */
function surroundings(r: Rgb): Rgb {
  const sky = mix([0.95, 0.97, 1], [0.2, 0.33, 0.5], smooth(0, 0.9, r[1]));
  const floor = mix([0.03, 0.03, 0.035], [0.6, 0.56, 0.5], smooth(0, 0.85, -r[1]));
  const lamp = 2.2 * smooth(0.8, 0.86, dot(r, unit([-0.6, 0.55, 0.55]))) + 0.8 * smooth(0.9, 0.94, dot(r, unit([0.85, 0.25, 0.4])));
  const colour = mix(floor, sky, smooth(-0.02, 0.03, r[1]));
  return [colour[0] + lamp, colour[1] + lamp, colour[2] + lamp];
}

/** Linear light towards the viewer from a point with normal n; the fourth is added white, the others multiply the colour of the surface. */
const shadings: Record<Look, (n: Rgb) => [number, number, number, number]> = {
  studio: (n) => {
    const d = diffuse(n);
    return [d * 1.01, d, d * 0.99, 0.22 * shine(n, 36) + 0.06 * rim(n)];
  },
  clay: (n) => {
    const d = diffuse(n);
    const [r, g, b] = mix([0.3, 0.12, 0.06], [0.72, 0.4, 0.24], clamp(d));
    return [r * d, g * d, b * d, 0.03 * shine(n, 10) + 0.03 * rim(n)];
  },
  wax: (n) => {
    const d = diffuse(n);
    // Light that enters comes out redder round the edge of shadow.
    const under = 0.22 * smooth(-0.6, 0.3, dot(n, key)) + 0.1;
    return [0.5 * d + 0.35 * under, 0.035 * d + 0.012 * under, 0.03 * d + 0.008 * under, 0.35 * shine(n, 60) + 0.1 * shine(n, 12) + 0.05 * rim(n)];
  },
  chrome: (n) => {
    const [r, g, b] = surroundings([2 * n[2] * n[0], 2 * n[2] * n[1], 2 * n[2] * n[2] - 1]);
    return [0.9 * r, 0.9 * g, 0.9 * b, 0];
  },
};

const baked = new Map<Look, THREE.DataTexture>();

/**
 * The light that a sphere of this look sends to the viewer, as a picture of the sphere: over the x and y of normals, or for
 * chrome of the vector half-way between the viewer and the reflected ray. Drawn when first used.
 */
export function lookTexture(look: Look): THREE.DataTexture {
  const known = baked.get(look);
  if (known) return known;
  const data = new Uint16Array(4 * pixels * pixels);
  for (let k = 0, at = 0; k < pixels; ++k) {
    for (let l = 0; l < pixels; ++l, at += 4) {
      const [x, y] = [(2 * l + 1) / pixels - 1, (2 * k + 1) / pixels - 1];
      const r = Math.hypot(x, y);
      const n: Rgb = r < 1 ? [x, y, Math.sqrt(1 - r * r)] : [x / r, y / r, 0];
      shadings[look](n).forEach((value, c) => (data[at + c] = THREE.DataUtils.toHalfFloat(value)));
    }
  }
  const texture = new THREE.DataTexture(data, pixels, pixels, THREE.RGBAFormat, THREE.HalfFloatType);
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  baked.set(look, texture);
  return texture;
}
