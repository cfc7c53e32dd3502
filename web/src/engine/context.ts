import type { Trims } from '@knead/generated';
import type { SurfaceInfo } from './session_types';

export type { Assembly, Context, FaceEdge, GreyFace, Part, PartPlace } from '@knead/generated';

/**
 * What trims leave of a surface, so that a point is decided exactly from a few line segments: a quadtree over the domain, whose
 * leaves have the segments of the loops in and beside them, and a reference point of which it is known whether it shows. A
 * point of the leaf shows as the reference does, turned over by every segment between the two.
 */
export interface TrimTree {
  /** Four numbers a node. Inside: number of the first of four children (lower left, lower right, upper left, upper right), −1. Leaf: first segment, how many, 1 where the reference shows. */
  nodes: Float32Array;
  /** Segments of the leaves, one after the other: from (s, t) to (s, t). */
  segments: Float32Array;
}

/** The loops of each face on a surface; null: all of it shows. `tree`: the same for drawing, by `trimTree`. */
export type Trim = (Trims & { tree?: TrimTree }) | null;

/** Whether the engine knows edges of a surface: those of faces on it, or the sides of one of a file on which no face lies. */
export const hasEdges = ({ faces, bare }: Pick<SurfaceInfo, 'faces' | 'bare'>): boolean => faces > 0 || bare;
