import type { SurfaceInfo } from './session_types';

/** A face of the file that is no surface of the session. `surface` and `form`: the entity on which it lies, "PLANE" and the like; empty if there is none. Triangles that the file itself holds have the form "TRIANGLES". */
export interface GreyFace {
  id: string;
  surface: string;
  form: string;
  triangles: number;
}

/** The surroundings of the surfaces: triangles of the other faces of the file, relative to the session's origin. */
export interface Context {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  /** In the order of the triangles, of which each has so many. */
  faces: GreyFace[];
  /** Faces that could not be triangulated, and why. */
  skipped: { id: string; reason: string }[];
  /** What of the file is not drawn, one line for each kind and reason; skipped faces are among it. */
  leftOut: string[];
}

/** One place where an assembly puts a part. */
export interface PartPlace {
  /** Products from the model down: "engine/valve/spring". */
  path: string;
  /** From the part's coordinates to the model's: three rows of four, one after the other. */
  matrix: number[];
}

/** Geometry with coordinates of its own. */
export interface Part {
  name: string;
  unit: string;
  /** Ids of its surfaces, those of grey faces too. */
  surfaces: string[];
  /** Ids of its faces. */
  faces: string[];
  /** Ids of its curves that stand for themselves. */
  curves: string[];
  /** At least one. */
  places: PartPlace[];
}

/** The parts of a file, and where they stand (bindings/wasm/studio_assembly.hpp). */
export interface Assembly {
  unit: string;
  parts: Part[];
  /** What could not be followed. */
  warnings: string[];
}

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

/** The loops of each face on a surface, s and t alternating: the parts enclosed by an odd number of loops are visible. Null: all. `tree`: the same for drawing, by `trimTree`. */
export type Trim = { faces: number[][][]; tree?: TrimTree } | null;

/** Whether the engine knows edges of a surface: those of faces on it, or the sides of one of a file on which no face lies. */
export const hasEdges = ({ faces, bare }: Pick<SurfaceInfo, 'faces' | 'bare'>): boolean => faces > 0 || bare;

/** An edge of a face: places along it, s and t in turn; on closed surfaces they may lie outside of 0 … 1. */
export interface FaceEdge {
  id: `#${string}`;
  course: number[];
  /** The faces at it, with the entities on which they lie: "PLANE" and the like. */
  meets: { face: string; surface: string; form: string }[];
  /** The same face is on both of its sides. */
  seam: boolean;
}
