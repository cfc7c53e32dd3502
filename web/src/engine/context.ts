/** A face of the file that is no surface of the session. `surface` and `form`: the entity on which it lies, "PLANE" and the like; empty if there is none. */
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
  /** Of an assembly that puts parts elsewhere than they are drawn, or several times: how many there are, in how many places; else 0. */
  parts: number;
  places: number;
}

/** The loops of each face on a surface, s and t alternating: the parts enclosed by an odd number of loops are visible. Null: all. */
export type Trim = { faces: number[][][] } | null;

/** An edge of a face: places along it, s and t in turn; on closed surfaces they may lie outside of 0 … 1. */
export interface FaceEdge {
  id: `#${string}`;
  course: number[];
  /** The faces at it, with the entities on which they lie: "PLANE" and the like. */
  meets: { face: string; surface: string; form: string }[];
  /** The same face is on both of its sides. */
  seam: boolean;
}
