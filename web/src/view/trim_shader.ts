import * as THREE from 'three';

import type { Trim } from '../engine/context';
import { deepest, reference, trimTree } from '../engine/trim_tree';

const width = 1024; // texels of a row

/**
 * Faces reach so many pixels over their edges: those of two neighbours are polygons with the same corners in space, between
 * which they part by less than that.
 */
const overlap = 0.5;

/** The trim of one surface, for `trimGlsl`. */
export interface TrimTextures {
  nodes: THREE.DataTexture;
  segments: THREE.DataTexture;
}

/** Uniforms of `trimGlsl`; shared by all materials of a surface. */
export interface TrimUniforms {
  trimNodes: THREE.IUniform<THREE.Texture | null>;
  trimSegments: THREE.IUniform<THREE.Texture | null>;
  trimmed: THREE.IUniform<boolean>;
}

export const trimUniforms = (): TrimUniforms => ({ trimNodes: { value: null }, trimSegments: { value: null }, trimmed: { value: false } });

function texture(numbers: Float32Array): THREE.DataTexture {
  const rows = Math.max(1, Math.ceil(numbers.length / 4 / width));
  const padded = new Float32Array(4 * width * rows);
  padded.set(numbers);
  const result = new THREE.DataTexture(padded, width, rows, THREE.RGBAFormat, THREE.FloatType);
  result.needsUpdate = true; // nearest: texels are records
  return result;
}

export function trimTextures(trim: Trim): TrimTextures | null {
  const tree = trim?.tree ?? trimTree(trim);
  return tree && { nodes: texture(tree.nodes), segments: texture(tree.segments) };
}

/** `bool hidden(vec2 place)`: whether trims hide a place of the domain. To be called where all pixels of a triangle come by. */
export const trimGlsl = /* glsl */ `
  uniform highp sampler2D trimNodes, trimSegments;
  uniform bool trimmed;

  vec4 trimRecord(highp sampler2D from, int k) { return texelFetch(from, ivec2(k % ${width}, k / ${width}), 0); }
  float crossed(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

  bool hidden(vec2 place) {
    if (!trimmed) return false;
    vec2 right = dFdx(place), up = dFdy(place); // a pixel, in fractions of the domain
    float area = crossed(right, up);
    mat2 pixels = area == 0.0 ? mat2(0.0) : mat2(up.y, -right.y, -up.x, right.x) / area;
    vec2 corner = vec2(0.0);
    float size = 1.0;
    vec4 node = trimRecord(trimNodes, 0);
    for (int k = 0; k < ${deepest} && node.y < 0.0; ++k) {
      size *= 0.5;
      vec2 far = step(corner + size, place);
      corner += far * size;
      node = trimRecord(trimNodes, int(node.x) + int(far.x) + 2 * int(far.y));
    }
    bool shows = node.z > 0.5;
    vec2 here = corner + size * vec2(${reference[0]}, ${reference[1]});
    vec2 way = place - here;
    int first = int(node.x), count = int(node.y);
    for (int k = 0; k < count; ++k) {
      vec4 segment = trimRecord(trimSegments, first + k);
      vec2 a = segment.xy, along = segment.zw - a;
      bool apart = (crossed(way, a - here) >= 0.0) != (crossed(way, segment.zw - here) >= 0.0);
      if (apart && (crossed(along, here - a) >= 0.0) != (crossed(along, place - a) >= 0.0)) shows = !shows;
      if (area == 0.0) continue;
      // Pixels from the line, where its foot is on the segment, and from its start; the next one knows the end.
      float off = crossed(along, place - a), share = dot(place - a, along) / dot(along, along);
      bool beside = share >= 0.0 && share <= 1.0 && abs(off) < ${overlap} * length(vec2(crossed(along, right), crossed(along, up)));
      if (beside || length(pixels * (a - place)) < ${overlap}) return false;
    }
    return !shows;
  }`;
